#include "model_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/log_term_names.h"
#include "awmr/model/ratio_names.h"

namespace awmr {
namespace {

/// The kinds of trial that /trials of model.json lists: tables, but no logs.
constexpr NameTable<TrialKind, 3> kTableNames{
    {kTrialKindNames[0], kTrialKindNames[1], kTrialKindNames[2]}};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Maximum relative difference of the covariances m(i,j) and m(j,i), which can differ by rounding.
constexpr double kSymmetryTolerance = 1e-9;

/// True for the name of a parameter, or of another quantity that a fit estimates.
bool is_estimated_name(std::string_view name) {
  return parameter_by_name(name) || name.starts_with(kInputDelayName) ||
         name == kSteeringDelayName || name == kSteeringTrimName || name == kSteeringDeadBandName ||
         name == kSteeringAsymmetryName || name == kSteeringCurveName ||
         name == kSteeringScaleName || name == kServoRateName || name == kForceImbalanceName ||
         name == kDeadZoneDifferenceName || name == kForceExponentName || name == kForceRiseName ||
         name == kForceFallName || name == kForceSaturationName ||
         name == kSaturationSharpnessName || name == kSupplySagName || name == kRunOnName ||
         name.starts_with(kForceScaleName) || name.starts_with(kResistanceScalePrefix) ||
         name == kSwayOffsetName || name == kSwayAngleName || name == kSpeedOffsetName ||
         name == kPositionAheadName || name == kPositionLeftName || name == kCompassSinName ||
         name == kCompassCosName || name == kCompassSin2Name || name == kCompassCos2Name ||
         name == kMotorLagName || name == kMassOverSurgeName || name == kCoulombOverSurgeName ||
         name == kQuadraticOverSurgeName || contains(kExtraForceNames, name) ||
         name.starts_with(kBiasPrefix) || name.starts_with(kSensorDelayPrefix) ||
         name.starts_with(kAveragingPrefix) || name.starts_with(kSensorLagPrefix) ||
         name.starts_with(kLagDampingPrefix) || name.starts_with(kSmoothingPrefix) ||
         name.starts_with(kSensorScalePrefix) || name.starts_with(kSlipPrefix) ||
         name.starts_with(kSlipRatioPrefix);
}

int count(JsonObject& json, std::string_view key) {
  return static_cast<int>(json.integer(key, 0, std::numeric_limits<int>::max()));
}

/// Reads the nested arrays of a matrix and reports each fault with the place of its element.
std::vector<std::vector<double>> matrix_from_json(JsonObject& json, const Json& matrix,
                                                  std::size_t size) {
  std::vector<std::vector<double>> rows;
  const auto is_row = [&](const Json& row) {
    return row.is_array() && row.size() == size &&
           std::all_of(row.begin(), row.end(), [](const Json& x) { return x.is_number(); });
  };
  if (!matrix.is_array() || matrix.size() != size ||
      !std::all_of(matrix.begin(), matrix.end(), is_row)) {
    json.fault(ErrorCode::kWrongType, "matrix",
               fmt::format("the matrix must be {0} rows of {0} numbers, one per entry of "
                           "parameters; identify again",
                           size));
    return rows;
  }
  for (const Json& row : matrix) rows.push_back(row.get<std::vector<double>>());
  return rows;
}

/// False if the correlations of the covariance `m` contradict each other: the matrix of
/// correlations has an eigenvalue below 0.
bool are_correlations(const std::vector<std::vector<double>>& m) {
  constexpr double kRounding = 1e-6;
  const auto n = static_cast<Eigen::Index>(m.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double scale = std::sqrt(m[i][i]) * std::sqrt(m[j][j]);
      correlation(eigen_index(i), eigen_index(j)) = scale > 0.0 ? m[i][j] / scale : m[i][j];
    }
  }
  if (n == 0 || !correlation.allFinite()) return n == 0;
  // The eigenvalue solver reads only the lower triangle, so only this is filled.
  return symmetric_eigenvalues(correlation).minCoeff() > -kRounding;
}

/// Checks that a covariance is symmetric, with variances >= 0 on its diagonal and consistent
/// correlations.
void check_covariance(JsonObject& json, const std::vector<std::vector<double>>& m) {
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (!(m[i][i] >= 0.0)) {
      json.fault(
          ErrorCode::kOutOfRange, "matrix",
          fmt::format("the variance [{0}][{0}] is {1}, but a variance is not negative; identify "
                      "again",
                      i, m[i][i]));
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double scale = std::max(std::abs(m[i][j]), std::abs(m[j][i]));
      if (std::abs(m[i][j] - m[j][i]) > kSymmetryTolerance * scale) {
        json.fault(ErrorCode::kContradiction, "matrix",
                   fmt::format("the matrix must be symmetric, but [{0}][{1}] is {2} and "
                               "[{1}][{0}] is {3}; identify again",
                               i, j, m[i][j], m[j][i]));
      }
    }
  }
  const bool variances = std::ranges::all_of(
      m, [&](const std::vector<double>& row) { return row[at(&row - m.data())] >= 0.0; });
  if (variances && !are_correlations(m)) {
    json.fault(ErrorCode::kContradiction, "matrix",
               "the matrix is not positive semi-definite: its correlations contradict each other; "
               "identify again");
  }
}

EstimatorParameter parameter_from_json(JsonObject& json) {
  EstimatorParameter parameter;
  parameter.name = json.string("name");
  if (!parameter.name.empty() && !is_estimated_name(parameter.name)) {
    json.fault(ErrorCode::kUnknownName, "name",
               fmt::format("no parameter is called '{}'; identify again", parameter.name));
  }
  parameter.value = json.nullable_number("value").value_or(kNaN);
  parameter.std_error = json.nullable_number("std_error", kNonNegative);
  parameter.ci95 = json.nullable_interval("ci95");
  if (json.has("profile95")) parameter.profile95 = json.nullable_interval("profile95");
  return parameter;
}

/// Writes the items of a report that only some estimators compute. Missing items get no key.
void put_details(Json& json, const EstimatorReport& report) {
  if (!report.family.empty()) json["family"] = report.family;
  if (report.weight) json["weight"] = *report.weight;
  if (report.aicc) json["aicc"] = number_or_null(report.aicc);
  for (const Diagnostic& diagnostic : report.diagnostics) {
    json["diagnostics"].push_back({{"name", diagnostic.name},
                                   {"statistic", number_or_null(diagnostic.statistic)},
                                   {"p_value", number_or_null(diagnostic.p_value)},
                                   {"meaning", diagnostic.meaning}});
  }
  for (const LeaveOneOut& without : report.leave_one_out) {
    json["leave_one_out"].push_back(
        {{"file", without.file}, {"line", without.line}, {"values", without.values}});
  }
  for (const SearchStart& start : report.starts) {
    json["starts"].push_back({{"values", start.values},
                              {"cost", number_or_null(start.cost)},
                              {"chosen", start.chosen},
                              {"stop_reason", start.stop_reason}});
  }
}

void read_details(JsonObject& json, EstimatorReport& report) {
  report.family = json.optional_string("family").value_or("");
  report.weight = json.optional_number("weight", {.min = 0.0, .max = 1.0, .min_excluded = true});
  if (json.has("aicc")) report.aicc = json.nullable_number("aicc");
  report.diagnostics = json.optional_objects("diagnostics", [](JsonObject& entry) {
    return Diagnostic{entry.string("name"), entry.nullable_number("statistic").value_or(kNaN),
                      entry.nullable_number("p_value").value_or(kNaN), entry.string("meaning")};
  });
  report.leave_one_out = json.optional_objects("leave_one_out", [](JsonObject& entry) {
    return LeaveOneOut{entry.string("file"), count(entry, "line"), entry.numbers("values")};
  });
  report.starts = json.optional_objects("starts", [](JsonObject& entry) {
    return SearchStart{entry.numbers("values"), entry.nullable_number("cost").value_or(kInfinity),
                       entry.boolean("chosen"), entry.string("stop_reason")};
  });
}

Json finding_to_json(const Finding& finding) {
  Json json;
  json["file"] = finding.file;
  json["line"] = finding.line;
  json["severity"] = name_in(kSeverityNames, finding.severity);
  json["code"] = finding.code;
  json["message"] = spell_options(finding.message, "--");
  return json;
}

}  // namespace

Json number_or_null(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

Json interval_or_null(const std::optional<Interval>& interval) {
  if (!interval || !std::isfinite(interval->lo) || !std::isfinite(interval->hi)) return nullptr;
  return Json::array({interval->lo, interval->hi});
}

Json report_to_json(const EstimatorReport& report) {
  Json json;
  json["subject"] = name_in(kFitSubjectNames, report.subject);
  json["estimator"] = name_in(kEstimatorNames, report.estimator);
  json["noise"] = report.noise;
  json["parameters"] = Json::array();
  for (const EstimatorParameter& parameter : report.parameters) {
    Json entry;
    entry["name"] = parameter.name;
    entry["value"] = number_or_null(parameter.value);
    entry["std_error"] = number_or_null(parameter.std_error);
    entry["ci95"] = interval_or_null(parameter.ci95);
    if (parameter.profile95) entry["profile95"] = interval_or_null(parameter.profile95);
    json["parameters"].push_back(std::move(entry));
  }
  json["residual_std"] = number_or_null(report.residual_std);
  json["rows_used"] = report.rows_used;
  json["degrees_of_freedom"] = report.degrees_of_freedom;
  json["rank"] = report.rank;
  json["condition_number"] = number_or_null(report.condition_number);
  json["stop_reason"] = report.stop_reason;
  put_details(json, report);
  return json;
}

EstimatorReport report_from_json(JsonObject& json) {
  EstimatorReport report;
  report.subject = json.choice("subject", kFitSubjectNames);
  report.estimator = json.choice("estimator", kEstimatorNames);
  report.noise = json.string("noise");
  report.parameters = json.objects("parameters", parameter_from_json);
  // residual_std is null for a fit without degrees of freedom: it has no spread of residuals.
  // condition_number is null for a rank-deficient fit: it is infinite.
  report.residual_std = json.nullable_number("residual_std", kNonNegative).value_or(kNaN);
  report.rows_used = count(json, "rows_used");
  report.degrees_of_freedom = count(json, "degrees_of_freedom");
  report.rank = count(json, "rank");
  report.condition_number =
      json.nullable_number("condition_number", kNonNegative).value_or(kInfinity);
  report.stop_reason = json.string("stop_reason");
  read_details(json, report);
  return report;
}

Json covariance_to_json(const Covariance& covariance) {
  Json json;
  json["parameters"] = Json::array();
  for (const ParameterId id : covariance.parameters) json["parameters"].push_back(info(id).name);
  json["matrix"] = covariance.matrix;
  return json;
}

Covariance covariance_from_json(JsonObject& json) {
  Covariance covariance;
  const std::vector<std::string> names = json.strings("parameters");
  for (const std::string& name : names) {
    const auto id = parameter_by_name(name);
    if (!id) {
      json.fault(ErrorCode::kUnknownName, "parameters",
                 fmt::format("no parameter is called '{}'; identify again", name));
    } else if (std::count(names.begin(), names.end(), name) > 1) {
      json.fault(ErrorCode::kGivenTwice, "parameters",
                 fmt::format("'{}' is listed twice; remove one", name));
    } else {
      covariance.parameters.push_back(*id);
    }
  }
  if (const Json* matrix = json.rows("matrix")) {
    covariance.matrix = matrix_from_json(json, *matrix, names.size());
    check_covariance(json, covariance.matrix);
  }
  return covariance;
}

Json findings_to_json(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) list.push_back(finding_to_json(finding));
  return list;
}

void describe_findings(JsonObject& json) { json.objects("findings", finding_from_json); }

std::vector<Finding> read_findings(JsonObject& json) {
  return json.optional_objects("findings", finding_from_json);
}

std::string with_findings(const std::string& document, const std::vector<Finding>& findings) {
  std::vector<Finding> named = findings;
  for (Finding& finding : named) {
    finding.file = std::filesystem::path(finding.file).filename().string();
  }
  Json json = Json::parse(document);
  json.erase("findings");
  json["findings"] = findings_to_json(named);
  return to_text(json);
}

Finding finding_from_json(JsonObject& json) {
  Finding finding;
  finding.file = json.string("file");
  finding.line = count(json, "line");
  finding.severity = json.choice("severity", kSeverityNames);
  finding.code = json.string("code");
  finding.message = json.string("message");
  return finding;
}

Json trial_to_json(const TrialPoint& trial) {
  Json json;
  json["kind"] = name_in(kTrialKindNames, trial.kind);
  json["file"] = trial.file;
  json["line"] = trial.line;
  json["input"] = trial.input;
  json["measured"] = trial.measured;
  json["predicted"] = number_or_null(trial.predicted);
  return json;
}

TrialPoint trial_from_json(JsonObject& json) {
  TrialPoint trial;
  trial.kind = json.choice("kind", kTableNames);
  trial.file = json.string("file");
  trial.line = count(json, "line");
  trial.input = json.number("input");
  trial.measured = json.number("measured");
  trial.predicted = json.nullable_number("predicted");
  return trial;
}

void explain_missing_estimates(const std::string& file, const Vehicle& vehicle,
                               std::vector<Fault>& faults) {
  const auto& table = parameter_table();
  for (Fault& fault : faults) {
    if (fault.code != ErrorCode::kMissing) continue;
    const auto missing = std::ranges::find_if(table, [&](const ParameterInfo& one) {
      const std::string place = file + ":" + std::string(one.pointer);
      return place == fault.place || place.starts_with(fault.place + "/");
    });
    if (missing == table.end()) continue;
    const bool is_null =
        missing->id == ParameterId::kSteeringTimeConstant && !vehicle.has_steering();
    fault.message = fmt::format(
        "{} ({}) is missing. {}", missing->symbol, missing->meaning,
        is_null
            ? "The vehicle has no steering, so give {\"value\": null, \"std_error\": null, "
              "\"ci95\": null, \"unit\": \"s\", \"source\": \"given\", \"method\": \"no "
              "steering\"} for time_constant_s"
            : fmt::format("`awmr identify` writes it, from {}", trial_of(vehicle, missing->id)));
  }
}

}  // namespace awmr
