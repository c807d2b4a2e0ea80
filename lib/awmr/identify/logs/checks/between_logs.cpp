#include "awmr/identify/logs/checks/between_logs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/logs/choice/log_terms.h"
#include "awmr/identify/logs/problem/identifiability.h"
#include "awmr/model/log_term_names.h"

namespace awmr {
namespace {

// Significance level of a disagreement, for all quantities together. A larger value would report
// more differences that are only noise.
constexpr double kLevel = 0.001;

/// Estimates of one quantity from single logs.
struct ByLog {
  std::vector<std::string> files;
  std::vector<double> coordinates;
  std::vector<double> weights;  ///< 1/variance
};

/// Index of the quantity `name` in the fit. Empty if the fit does not identify this quantity.
std::optional<std::size_t> place_in(const LogFit& fit, const std::string& name) {
  const auto i = place_of(fit.quantities, name);
  return i && fit.refusal_reason[*i].empty() ? i : std::nullopt;
}

void add(const std::string& file, double coordinate, double variance, ByLog& by_log) {
  by_log.files.push_back(file);
  by_log.coordinates.push_back(coordinate);
  by_log.weights.push_back(1.0 / variance);
}

ByLog collect(const std::vector<std::string>& files, const std::vector<LogFit>& fits,
              const std::string& name) {
  ByLog found;
  for (std::size_t l = 0; l < fits.size(); ++l) {
    const auto place = fits[l].usable ? place_in(fits[l], name) : std::nullopt;
    if (!place) continue;
    const Eigen::Index i = eigen_index(*place);
    add(files[l], fits[l].coordinates[*place], fits[l].covariance(i, i), found);
  }
  return found;
}

/// Result of Cochran's Q test of the hypothesis that L logs agree on a quantity.
struct Heterogeneity {
  double p_value = 1.0;
  double std_error = 0.0;    ///< standard error of the mean over logs, which may differ
  double spread = 0.0;       ///< part of `std_error` that comes from the variance between logs
  double mean_square = 0.0;  ///< Q/(L - 1); about 1 if the logs agree
};

Heterogeneity heterogeneity(const ByLog& by_log) {
  double sum = 0.0;
  double squares = 0.0;
  double mean = 0.0;
  for (std::size_t l = 0; l < by_log.weights.size(); ++l) {
    sum += by_log.weights[l];
    squares += by_log.weights[l] * by_log.weights[l];
    mean += by_log.weights[l] * by_log.coordinates[l];
  }
  mean /= sum;
  double q = 0.0;
  for (std::size_t l = 0; l < by_log.weights.size(); ++l) {
    q += by_log.weights[l] * std::pow(by_log.coordinates[l] - mean, 2);
  }
  const double degrees = static_cast<double>(by_log.weights.size()) - 1.0;
  const double between = std::max(0.0, (q - degrees) / (sum - squares / sum));
  return {chi_squared_tail(q, degrees), std::sqrt((1.0 + between * squares / sum) / sum),
          std::sqrt(between * squares) / sum, q / degrees};
}

/// Raises the standard error of quantity `i` of the common fit to `std_error`, and sets the
/// interval by Student's t. `logs`: number of logs from which `std_error` was computed. A larger
/// standard error of the common fit stays, because it includes the scatter between parts of the
/// logs. Returns false if the interval was withdrawn before; it then stays withdrawn.
bool widen(std::size_t i, double std_error, std::size_t logs, LogFit& fit) {
  const Eigen::Index row = eigen_index(i);
  const double by = std::max(1.0, std_error / fit.error_of(i));
  fit.covariance.row(row) *= by;
  fit.covariance.col(row) *= by;
  const FreeQuantity& q = fit.quantities[i];
  const double x = fit.coordinates[i];
  const double error = fit.error_of(i);
  const double half = t_quantile_95(static_cast<double>(logs) - 1.0) * error;
  EstimatorParameter& parameter = fit.report.parameters[i];
  if (!parameter.ci95) return false;
  parameter.std_error = q.jacobian(x) * error;
  parameter.ci95 = Interval{q.value(x - half), q.value(x + half)};
  return true;
}

/// Selects the rows of a single log from the fraction `from` to the fraction `to` of its duration.
/// `log`: a vector with this one log. `which`: name of the part, for example "first half".
LogPart part_of(const std::vector<DrivingLog>& log, double from, double to,
                const std::string& which) {
  const std::vector<double>& t_s = log.front().t_s;
  const double duration_s = t_s.back() - t_s.front();
  // The end of the time interval is excluded. The last part therefore ends after the last row.
  const double end_s = to < 1.0 ? t_s.front() + to * duration_s : t_s.back() + 1.0;
  return {log,
          {t_s.front() + from * duration_s, end_s},
          fmt::format("the {} of {}", which, log.front().file)};
}

LogFit fit_part(const LogPart& part, LogFitOptions options) {
  options.only_s = part.only_s;
  return fit_logs(part.log, options);
}

/// Widens the interval of I'z if the logs disagree on m' only, and the reverse
/// (LogDisagreement::partner).
void widen_partners(std::vector<LogDisagreement>& disagreements, LogFit& fit) {
  const std::string mass(info(ParameterId::kMassNorm).name);
  const std::string inertia(info(ParameterId::kInertiaNorm).name);
  for (LogDisagreement& one : disagreements) {
    if (one.name != mass && one.name != inertia) continue;
    const std::string& partner = one.name == mass ? inertia : mass;
    const bool has_own = std::ranges::any_of(
        disagreements, [&](const LogDisagreement& other) { return other.name == partner; });
    const auto i = place_in(fit, partner);
    if (has_own || !i) continue;
    if (widen(*i, std::hypot(fit.error_of(*i), one.spread), one.files.size(), fit)) {
      one.partner = partner;
    }
  }
}

std::vector<LogDisagreement> disagreements_of(const std::vector<std::string>& files,
                                              const std::vector<LogFit>& fits, FamilyFit& common) {
  std::vector<LogDisagreement> disagreements;
  const double level = kLevel / static_cast<double>(common.fit.quantities.size());
  for (std::size_t i = 0; i < common.fit.quantities.size(); ++i) {
    const FreeQuantity& q = common.fit.quantities[i];
    if (q.kind == FreeQuantity::Kind::kBias || q.log != 0) continue;
    if (differs_by_log(common.fit, q)) continue;
    if (!common.fit.refusal_reason[i].empty()) continue;
    const ByLog by_log = collect(files, fits, q.name());
    if (by_log.files.size() < 2) continue;
    const Heterogeneity between = heterogeneity(by_log);
    if (!(between.p_value < level)) continue;
    const bool is_widened = widen(i, between.std_error, by_log.files.size(), common.fit);
    LogDisagreement one{.name = q.name(),
                        .p_value = between.p_value,
                        .files = by_log.files,
                        .values = {},
                        .spread = between.spread,
                        .is_widened = is_widened};
    for (const double x : by_log.coordinates) one.values.push_back(q.value(x));
    one.refuses = common.fit.error_of(i) > kUnknown * q.large_change;
    if (one.refuses) {
      common.fit.refusal_reason[i] =
          fmt::format("the logs give different values: {:.4g}", fmt::join(one.values, ", "));
    }
    disagreements.push_back(one);
  }
  widen_partners(disagreements, common.fit);
  return disagreements;
}

/// Returns the delay or command error that the common fit lacks and that differs most between the
/// logs, according to score tests on each log. Empty if the estimates of every term agree within
/// three standard errors (root mean square over the logs). These standard errors are those by the
/// noise model. The scatter between blocks of a log does not count, because all blocks of a log
/// have the same command error.
std::optional<FreeQuantity> strongest_missing_term(const std::vector<DrivingLog>& logs,
                                                   const LogFitOptions& options,
                                                   const LogFit& common) {
  constexpr double kWorthAFit = 9.0;
  std::map<std::string, std::pair<FreeQuantity, ByLog>> terms;
  for (const DrivingLog& log : logs) {
    for (const auto& [term, test] :
         test_further_terms({log}, of_single_log(common, log), options)) {
      auto& [quantity, by_log] = terms[term.name()];
      quantity = term;
      add(log.file, test.value, test.noise_error * test.noise_error, by_log);
    }
  }
  std::optional<FreeQuantity> strongest;
  double most = kWorthAFit;
  for (const auto& [name, found] : terms) {
    if (found.second.files.size() < 2) continue;
    const double mean_square = heterogeneity(found.second).mean_square;
    if (!(mean_square > most)) continue;
    most = mean_square;
    strongest = found.first;
  }
  return strongest;
}

/// Fits every log with strongest_missing_term() as an additional quantity. Returns the disagreement
/// if the logs give significantly different values of this quantity.
std::vector<LogDisagreement> disagreement_on_missing(const std::vector<DrivingLog>& logs,
                                                     const std::vector<std::string>& files,
                                                     LogFitOptions options, const LogFit& common) {
  const auto term = strongest_missing_term(logs, options, common);
  if (!term) return {};
  options.terms.push_back({*term, 0.0});
  std::vector<LogFit> fits;
  for (const DrivingLog& log : logs) fits.push_back(fit_logs({log}, options));
  const ByLog by_log = collect(files, fits, term->name());
  if (by_log.files.size() < 2) return {};
  const double p_value = heterogeneity(by_log).p_value;
  if (!(p_value < kLevel)) return {};
  return {{.name = term->name(),
           .p_value = p_value,
           .files = by_log.files,
           .values = by_log.coordinates,
           .withdraws = true}};
}

/// True if a disagreement of the logs on this term makes all intervals invalid. compare_logs()
/// lists these terms.
bool invalidates_all(std::string_view name) {
  constexpr std::string_view kOfCommands[] = {
      kSteeringTrimName,  kSteeringDeadBandName, kSteeringAsymmetryName,  kSteeringCurveName,
      kSteeringScaleName, kForceImbalanceName,   kDeadZoneDifferenceName, kForceSaturationName,
      kForceExponentName, kSupplySagName};
  const auto first = kExtraForceNames.begin() + static_cast<int>(ExtraForce::kSlopeX);
  return contains(kOfCommands, name) ||
         std::find(first, kExtraForceNames.end(), name) != kExtraForceNames.end();
}

LogComparison compare_parts(const std::vector<DrivingLog>& log, const LogFitOptions& options,
                            FamilyFit& common) {
  constexpr double kAgree = 0.05;
  constexpr double kMiss = 0.001;
  LogComparison found;
  const LogPart first = part_of(log, 0.0, 0.5, "first half");
  const LogPart second = part_of(log, 0.5, 1.0, "second half");
  LogFit by_first = fit_part(first, options);
  if (!by_first.usable) return found;
  const auto second_half = predict(second, by_first, options);
  const LogPart last = part_of(log, 0.8, 1.0, "last fifth");
  const auto last_fifth = predict(last, by_first, options);
  const auto agrees = [](const std::optional<HeldOut>& rows) {
    return rows && rows->p_value > kAgree;
  };
  if (agrees(second_half) && agrees(last_fifth)) return found;
  const std::vector<double> by_all = common.fit.coordinates;
  found.disagreements =
      disagreements_of({first.name, second.name}, {by_first, fit_part(second, options)}, common);
  for (LogDisagreement& one : found.disagreements) one.withdraws = invalidates_all(one.name);
  if (!found.disagreements.empty() || !last_fifth || !(last_fifth->p_value < kMiss)) return found;
  // A second test may acquit only a fit without model error.
  const auto p_value = common.fit.has_model_error()
                           ? std::nullopt
                           : likelihood_ratio_test(first, last, by_first, by_all, options);
  if (p_value && !(*p_value < kMiss)) return found;
  found.missed = last_fifth;
  if (p_value) found.missed->p_value = *p_value;
  return found;
}

}  // namespace

LogComparison compare_logs(const std::vector<DrivingLog>& logs, FamilyFit& common) {
  constexpr double kLongEnough_s = 20.0;  // half of a shorter log has too little information
  if (!common.fit.usable) return {};
  LogFitOptions options = from_optimum(common.options, common);
  options.noise = common.fit.noise;
  options.bootstrap = 0;
  // No limit of the work: these short searches decide whether intervals are valid.
  options.effort.reset();
  if (logs.size() == 1) {
    const std::vector<double>& t_s = logs.front().t_s;
    if (t_s.back() - t_s.front() < kLongEnough_s) return {};
    return compare_parts(logs, options, common);
  }
  options = without_log_terms(std::move(options));
  std::vector<DrivingLog> alike;
  std::vector<std::string> files;
  std::vector<LogFit> fits;
  for (const DrivingLog& one : logs) {
    alike.push_back(without_log_terms(one, common.fit));
    files.push_back(one.file);
    fits.push_back(fit_logs({alike.back()}, options));
  }
  LogComparison found{disagreement_on_missing(alike, files, options, common.fit), std::nullopt};
  for (LogDisagreement& one : disagreements_of(files, fits, common)) {
    one.withdraws = invalidates_all(one.name);
    found.disagreements.push_back(std::move(one));
  }
  return found;
}

}  // namespace awmr
