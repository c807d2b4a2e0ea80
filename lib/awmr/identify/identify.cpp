#include "awmr/identify/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/identify/admissible.h"
#include "awmr/identify/assumed_sway.h"
#include "awmr/identify/coastdown/stop_families.h"
#include "awmr/identify/main_values.h"
#include "awmr/identify/refusals.h"
#include "awmr/identify/tables/scrub.h"
#include "awmr/identify/tables/turn_sides.h"
#include "awmr/identify/trials_as_used.h"
#include "awmr/identify/uncertainty/akaike.h"
#include "awmr/model/log_term_names.h"
#include "awmr/model/plausibility.h"

namespace awmr {
namespace {

bool asks_for_other_family(const IdentifyOptions& options) {
  return options.surge_family.family != Family::kPower ||
         options.yaw_family.family != Family::kPower;
}

/// Error if back-EMF (loss of motor force with the speed) is given or requested and there is a
/// surge or turning table: steady runs determine only the sum of back-EMF and resistance.
Status check_back_emf(const Vehicle& vehicle, const TrialData& data,
                      const IdentifyOptions& options) {
  const bool is_requested = contains(options.requested, ParameterId::kBackEmf);
  if (!is_requested && !(vehicle.back_emf_s_per_m.value_or(0.0) > 0.0)) return {};
  if (!data.surge && !data.turning) return {};
  return input_error(
      ErrorCode::kNotIdentified, data.surge ? data.surge->file : data.turning->file,
      fmt::format(
          "steady runs cannot separate back-EMF ({}) from resistance; identify this vehicle "
          "from logs ({}) with driven and coasting sections, and leave out the surge and "
          "turning tables",
          is_requested
              ? option_text(fmt::format("fit {}", info(ParameterId::kBackEmf).name))
              : fmt::format("back_emf_s_per_m {:g} in the vehicle file", *vehicle.back_emf_s_per_m),
          option_text("log")));
}

/// Checks that the requested method can fit the data with the other options.
Status check_method(const TrialData& data, const IdentifyOptions& options) {
  const bool other_family = asks_for_other_family(options);
  if (options.method == Method::kLogLinear && (other_family || options.loss != Loss::kSquared)) {
    return input_error(ErrorCode::kConflict, option_text("method"),
                       fmt::format("log-linear supports only the power law and the squared loss; "
                                   "with {} use the method nonlinear",
                                   option_text(other_family ? "family" : "loss")));
  }
  if (options.method == Method::kTrajectory && data.logs.empty()) {
    return input_error(ErrorCode::kMissing, option_text("method"),
                       fmt::format("the method trajectory needs a driving log; give one with {}",
                                   option_text("log")));
  }
  return {};
}

Status check_options(const Vehicle& vehicle, const TrialData& data,
                     const IdentifyOptions& options) {
  for (const ParameterId id : options.requested) {
    if (has(vehicle, id) || options.requested_all) continue;
    return input_error(
        ErrorCode::kUnsupported, option_text("fit"),
        fmt::format("a vehicle with drive \"{}\" has no steering, so it has no {}; request "
                    "other parameters",
                    name_in(kDriveNames, vehicle.drive), info(id).name));
  }
  AWMR_RETURN_IF_ERROR(check_back_emf(vehicle, data, options));
  if (data.surge && vehicle.driven_wheels() != 4 &&
      options.surge_family.family == Family::kDeadZone) {
    return input_error(
        ErrorCode::kUnsupported, option_text("family"),
        fmt::format("dead-zone needs four driven wheels, but this vehicle's drive is "
                    "\"{}\"; choose another family",
                    name_in(kDriveNames, vehicle.drive)));
  }
  const bool fits_only_logs = !data.surge && !data.logs.empty();
  if (options.surge_family.family == Family::kDeadZoneCoulomb && !fits_only_logs) {
    return input_error(
        ErrorCode::kUnsupported, option_text("family"),
        fmt::format("dead-zone-coulomb needs driving logs and no surge runs: at steady speed, only "
                    "the sum of Coulomb friction and dead zones has an effect. Give {} without {}, "
                    "or choose dead-zone or coulomb-power",
                    option_text("log"), option_text("surge")));
  }
  AWMR_RETURN_IF_ERROR(check_method(data, options));
  if (!options.terms.empty() && data.logs.empty()) {
    return input_error(ErrorCode::kMissing, option_text("fit"),
                       fmt::format("{} needs a driving log; give one with {}",
                                   options.terms.front(), option_text("log")));
  }
  if (options.joint && (!data.surge || data.curves.empty())) {
    return input_error(ErrorCode::kMissing, option_text("joint"),
                       "needs surge runs and a coast-down curve; give both, or remove this option");
  }
  return {};
}

/// Method of the table fits: log-linear unless another family or a robust loss is requested.
Method method_of_tables(const IdentifyOptions& options) {
  const bool log_linear_does = !asks_for_other_family(options) && options.loss == Loss::kSquared;
  return log_linear_does ? Method::kLogLinear : Method::kNonlinear;
}

Method method_of(const TrialData& data, const IdentifyOptions& options) {
  return options.method.value_or(data.logs.empty() ? method_of_tables(options)
                                                   : Method::kTrajectory);
}

/// Error model of the table fits if the options give none. For a family other than the power law or
/// a robust loss: a relative error of the force, as in log-linear least squares. Otherwise absent.
std::optional<ErrorModel> noise_of_tables(const IdentifyOptions& options) {
  if (method_of_tables(options) == Method::kLogLinear) return std::nullopt;
  return ErrorModel::kLogForce;
}

/// Options of a table fit. The method `trajectory` fits logs only, so method_of_tables() then
/// chooses the method for the tables.
SubjectOptions subject_options(const IdentifyOptions& options, Method method,
                               const FamilyChoice& family) {
  const bool asks_for_noise = options.noise || options.method == Method::kNonlinear;
  const Method of_tables = method == Method::kTrajectory ? method_of_tables(options) : method;
  return {.method = of_tables,
          .noise = asks_for_noise ? options.noise : noise_of_tables(options),
          .knows_noise = options.noise && of_tables == Method::kNonlinear,
          .family = family,
          .loss = options.loss,
          .side_by_side = options.side_by_side,
          .keeps_outliers = options.keeps_outliers};
}

template <class Step>
void record(Step& step, Model& model) {
  std::move(step.reports.begin(), step.reports.end(), std::back_inserter(model.record.reports));
  std::move(step.findings.begin(), step.findings.end(), std::back_inserter(model.record.findings));
}

/// The finding `family-by-coastdown`. `is_used`: true if the fit uses the family of the curves.
Finding family_by_coastdown(const std::string& file, Family by_runs, const FamilyOfCurves& found,
                            bool is_used) {
  const std::string_view family = name_of(found.family);
  return {file, 0, is_used ? Severity::kNote : Severity::kWarning, "family-by-coastdown",
          fmt::format("the surge runs do not decide between the resistance families {} and {}, but "
                      "the coast-downs do: with {} the AICc of both together is lower by {}{}",
                      name_of(by_runs), family, family, aic_decrease_text(found.decrease),
                      is_used ? ", so it is used"
                              : fmt::format(". The values that follow from these runs get no "
                                            "intervals; use {}",
                                            option_text(fmt::format("family surge={}", family))))};
}

/// The family of the coast-downs: of the curves, else of the stop times. With stop times, a power
/// law that is only a default is rejected if another family is better by kTablesPlainlyBetter;
/// between these limits, the interval of m' covers both (average_over_families()).
std::optional<FamilyOfCurves> family_of_coastdowns(const SubjectFit& surge, const TrialData& data,
                                                   bool is_used) {
  if (!data.curves.empty()) return family_of_curves(surge, data.curves);
  if (!data.coastdown || surge.is_inadequate) return std::nullopt;
  const auto found = family_of_stops(surge, data.coastdown->rows);
  if (!found || (!is_used && found->decrease < kTablesPlainlyBetter)) return std::nullopt;
  return found;
}

/// Fits the surge law. If the runs do not decide between families of resistance, the coast-downs
/// do (family_of_coastdowns()). Their family is used if the user did not select one by name;
/// without a selection, the power law stays and is reported as inadequate. With curves, runs that
/// reject the power law are compared among the other families; `family-by-coastdown` then replaces
/// `power-law-inadequate`, because both data together give the better family.
SubjectFit fit_surge(const Subject& subject, SubjectOptions options, const TrialData& data) {
  SubjectFit fit = fit_subject(subject, options);
  if (!fit.chosen || (options.family.requested && options.family.family)) return fit;
  const bool is_used = !options.family.family;
  const bool rejects_power = fit.is_inadequate && !data.curves.empty();
  SubjectOptions any_family = options;
  any_family.family.family = std::nullopt;
  any_family.method = Method::kNonlinear;  // the log-linear fit has only the power law
  const SubjectFit compared = rejects_power ? fit_subject(subject, any_family) : fit;
  const auto found = family_of_coastdowns(compared, data, is_used);
  if (!found) return fit;
  const std::string& file = data.curves.empty() ? data.coastdown->file : data.curves.front().file;
  const Finding finding = family_by_coastdown(file, compared.problem.family, *found, is_used);
  if (rejects_power) {
    std::erase_if(fit.findings, [](const Finding& f) { return f.code == "power-law-inadequate"; });
  }
  if (is_used) {
    options.family.family = found->family;
    fit = fit_subject(subject, options);
  }
  fit.is_inadequate = fit.is_inadequate || !is_used;
  fit.findings.push_back(finding);
  return fit;
}

/// Sets the surge or yaw law in the model, if the runs determine it. `contradiction`: finding that
/// the runs do not agree with any such law, so that its parameters get no intervals.
SubjectFit identify_law(const Subject& subject, SubjectFit fit,
                        std::optional<Finding> contradiction, MainValues& values) {
  if (contradiction) {
    fit.is_inadequate = true;
    fit.findings.push_back(*std::move(contradiction));
  }
  if (fit.chosen) set_law(subject, fit, values);
  record(fit, values.model);
  return fit;
}

/// Fits surge and yaw laws to the tables. Returns the surge fit, which the coast-downs need.
SubjectFit identify_laws(const Vehicle& vehicle, const TrialData& data,
                         const IdentifyOptions& options, MainValues& values, Reasons& reasons) {
  const Method method = method_of(data, options);
  SubjectFit surge;
  if (data.surge) {
    const Subject subject = surge_subject(vehicle, *data.surge);
    surge = identify_law(
        subject, fit_surge(subject, subject_options(options, method, options.surge_family), data),
        std::nullopt, values);
    reasons.surge = surge.refusal_reason;
  }
  if (data.turning) {
    const double dead_zone = *values.model[ParameterId::kWheelDeadZone].value;
    const Subject yaw = yaw_subject(vehicle, *data.turning, dead_zone);
    reasons.turning =
        identify_law(
            yaw, fit_subject(yaw, subject_options(options, method, options.fitted_yaw_family())),
            compare_sides(yaw, *data.turning), values)
            .refusal_reason;
  }
  return surge;
}

void identify_mass(const Vehicle& vehicle, const TrialData& data, const IdentifyOptions& options,
                   const SubjectFit& surge, MainValues& values, Reasons& reasons) {
  if ((!data.coastdown || data.coastdown->rows.empty()) && data.curves.empty()) return;
  MassResult mass = estimate_mass(surge.chosen ? &surge : nullptr, data.coastdown, data.curves,
                                  vehicle, options.surge_family, options.joint);
  record(mass, values.model);
  set_mass(mass, surge, values);
  reasons.mass = mass.reason;
  reasons.curve_alone = mass.alone.has_value();
}

/// Removes `scale-mismatch` of each channel whose scale the log fit estimates (`sensor-scale`),
/// because the fit estimates it more precisely. Keeps it if it also proposes a mapping of the
/// heading, whose scale no fit estimates.
void drop_rough_scales(const EstimatorReport& fit, std::vector<Finding>& findings) {
  for (const EstimatorParameter& parameter : fit.parameters) {
    if (!parameter.name.starts_with(kSensorScalePrefix) || !parameter.std_error) continue;
    const std::string column = parameter.name.substr(kSensorScalePrefix.size());
    std::erase_if(findings, [&](const Finding& finding) {
      const auto maps = [&](const std::string& name) {
        return finding.message.find(name + "=") != std::string::npos;
      };
      return finding.code == "scale-mismatch" && maps(column) && !maps("heading_deg");
    });
  }
}

Result<void> identify_from_logs(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options,
                                const std::vector<ParameterId>& requested, MainValues& values,
                                Reasons& reasons) {
  if (data.logs.empty()) return {};
  AWMR_ASSIGN_OR_RETURN(LogStage logs,
                        run_log_stage(vehicle, data.logs, options, requested, values.model,
                                      method_of(data, options) == Method::kTrajectory));
  drop_rough_scales(logs.reports[logs.chosen_report], values.model.record.findings);
  record(logs, values.model);
  set_logs(logs, values);
  reasons.logs = std::move(logs.reasons);
  return {};
}

bool is_fitted_to_logs(const Model& model, ParameterId id) {
  return model[id].method == name_in(kEstimatorNames, Estimator::kTrajectory);
}

/// True if the yaw resistance comes only from differential turns although the vehicle has steering.
bool is_by_sides_alone(const TrialData& data, const Model& model) {
  return model.vehicle.has_steering() && data.turning && !data.turning->rows.empty() &&
         data.turning->rows.front().sides && !is_fitted_to_logs(model, ParameterId::kYawAlpha);
}

/// Highest yaw rate of the logs, rad/s, as the 99 % quantile, because the maximum could be a spike.
std::optional<double> fastest_logged_turn_radps(const std::vector<DrivingLog>& logs) {
  constexpr double kShare = 0.99;
  std::vector<double> rates;
  for (const DrivingLog& log : logs) {
    const auto& rate = log[LogChannel::kYawRate];
    for (std::size_t row = 0; rate && row < log.rows(); ++row) {
      if (rate->fresh[row] && std::isfinite(rate->value[row])) {
        rates.push_back(std::abs(rate->value[row]));
      }
    }
  }
  if (rates.empty()) return std::nullopt;
  const double rate_radps = quantile(std::move(rates), kShare);
  return rate_radps > 0.0 ? std::optional(rate_radps) : std::nullopt;
}

}  // namespace

Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings) {
  AWMR_RETURN_IF_ERROR(check_options(vehicle, data, options));
  const std::vector<ParameterId> requested = requested_parameters(vehicle, data, options);
  Identification result;
  Model& model = result.model;
  model.vehicle = vehicle;
  model.record.findings = std::move(findings);
  MainValues values{model};
  Reasons reasons;
  set_given(vehicle, model);
  check_inertia(vehicle, model.record.findings);
  const std::vector<Finding> implausible = plausibility_findings(vehicle, Severity::kWarning);
  append(model.record.findings, implausible);

  const SubjectFit surge = identify_laws(vehicle, data, options, values, reasons);
  identify_mass(vehicle, data, options, surge, values, reasons);
  AWMR_RETURN_IF_ERROR(identify_from_logs(vehicle, data, options, requested, values, reasons));
  assume_sway(data, values);

  model.covariance = values.covariance.covariance();
  model.yaw_by_sides_alone = is_by_sides_alone(data, model);
  if (data.turning) measure_scrub(*data.turning, model);
  if (is_fitted_to_logs(model, ParameterId::kYawAlpha)) {
    model.record.logged_yaw_rate_radps = fastest_logged_turn_radps(data.logs);
  }
  reasons.inadmissible = take_out_inadmissible(model);
  model.record.trials = trials_as_used(data, model);
  result.has_refused_terms = std::ranges::any_of(model.record.findings, [](const Finding& finding) {
    return finding.code == "not-identifiable" && finding.severity == Severity::kError;
  });
  result.refused = refuse_what_is_missing(data, reasons, requested, options, model);
  return result;
}

Result<Identification> identify(const Trials& trials, const IdentifyOptions& options) {
  return identify(trials.vehicle, trials.data, options, trials.findings);
}

}  // namespace awmr
