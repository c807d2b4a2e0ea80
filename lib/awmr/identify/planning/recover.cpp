// The runs of `awmr recover`: each simulates trials with the model's values and identifies a model
// from them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/parallel.h"
#include "awmr/core/units.h"
#include "awmr/identify/assumed_sway.h"
#include "awmr/identify/planning/recover_part.h"
#include "awmr/identify/planning/recover_table.h"
#include "awmr/model/family.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// Quantity that has the measurement error according to the estimator under test. Log-linear
/// estimator: the logarithm of the force. Nonlinear estimator (used for every family other than the
/// power law): the requested quantity.
ErrorModel error_of(const IdentifyOptions& options, Family family) {
  if (options.method != Method::kNonlinear && family == Family::kPower) {
    return ErrorModel::kLogForce;
  }
  return options.noise.value_or(ErrorModel::kTime);
}

/// Error model with this name in /estimates; empty for other names.
std::optional<ErrorModel> error_model_named(std::string_view name) {
  for (const auto& [option, model] : kRecoverErrorNames) {
    if (name_of(model) == name) return model;
  }
  return std::nullopt;
}

/// Error to simulate in the rows of a table: the residual standard deviation of one of the model's
/// fits of the surge or yaw resistance. If the user requested an error model, takes the fit with
/// this error model. Otherwise takes the fit with the error model of the estimator under test, or
/// else the first fit of the model's family. Errors (input): the model has no such fit.
Result<RowError> row_error(const Model& model, FitSubject subject, const RecoverOptions& options) {
  const bool is_surge = subject == FitSubject::kSurge;
  const Family family = is_surge ? model.surge_family : model.yaw_family;
  const ErrorModel preferred = options.error.value_or(error_of(options.identify, family));
  bool has_fit = false;
  std::vector<RowError> available;
  for (const EstimatorReport& report : model.record.reports) {
    const std::string_view fitted = report.family.empty() ? name_of(Family::kPower) : report.family;
    const std::optional<ErrorModel> error = error_model_named(report.noise);
    if (report.subject != subject || fitted != name_of(family) || !error) continue;
    has_fit = true;
    if (!std::isfinite(report.residual_std)) continue;
    if (*error == preferred) return RowError{preferred, report.residual_std};
    available.push_back({*error, report.residual_std});
  }
  if (!available.empty() && !options.error) return available.front();
  const char* const resistance = is_surge ? "surge" : "yaw";
  if (has_fit && available.empty()) {
    return input_error(
        ErrorCode::kTooFewData, model.file + ":/estimates",
        fmt::format("the {} resistance was fitted to as many runs as it has parameters, so the "
                    "scatter of the runs is unknown; record more runs, or use {}",
                    resistance, option_text("plan log")));
  }
  std::vector<std::string_view> names;
  for (const RowError& one : available) names.push_back(name_in(kRecoverErrorNames, one.model));
  return input_error(
      ErrorCode::kMissing, model.file + ":/estimates",
      fmt::format("there is no fit of the {} resistance{}, whose residuals the simulated trials "
                  "need; {}",
                  resistance,
                  options.error ? fmt::format(" with errors on {}", name_of(preferred)) : "",
                  names.empty() ? "identify from tables, or use " + option_text("plan log")
                                : fmt::format("choose one of {} with {}", fmt::join(names, ", "),
                                              option_text("error"))));
}

/// Returns the left and right wheel forces that make a yaw moment (divided by F_max, m) without
/// steering. The two forces are equal and opposite. If the left wheels cannot push back so
/// strongly, the left force is the lower limit of the wheel force, or 0 if that limit is positive.
///   tau_turn = 2 d (F'R - F'L)                                                        [paper (41)]
SideForces<double> sides_for(const Vehicle& vehicle, double tau_turn_m) {
  const double difference = tau_turn_m / (2.0 * vehicle.half_track_m);
  const double left = std::max(-0.5 * difference, std::min(0.0, vehicle.wheel_force.lo));
  return {left, left + difference};
}

TablePlan plan_of(const Model& model) {
  TablePlan plan;
  double most_tau_turn_m = 0.0;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kSurge) plan.surge_tau_speed.push_back(trial.input);
    if (trial.kind == TrialKind::kCoastdown) plan.stop_from_mps.push_back(trial.input);
    if (trial.kind == TrialKind::kTurning) {
      most_tau_turn_m = std::max(most_tau_turn_m, trial.input);
    }
  }
  if (!model.vehicle.has_steering()) {
    for (const TrialPoint& trial : model.record.trials) {
      if (trial.kind != TrialKind::kTurning) continue;
      plan.turning_sides.push_back(sides_for(model.vehicle, trial.input));
    }
    return plan;
  }
  // tau_turn = 2 l_f F' sin d_r                                                        [paper (62)]
  // All simulated turns have the same wheel force F'. With it, the largest yaw moment tau_turn
  // needs the largest steering angle d_r.
  const double stop_rad = radians(model.vehicle.steering_max_deg);
  plan.turning_wheel_force =
      most_tau_turn_m / (2.0 * model.vehicle.front_axle_m * std::sin(stop_rad));
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kTurning) continue;
    plan.turning_steering_rad.push_back(
        std::asin(trial.input / (2.0 * model.vehicle.front_axle_m * plan.turning_wheel_force)));
  }
  return plan;
}

/// Initial speed of a coast-down, m/s: the highest speed of the model's surge trials, but at least
/// 0.5.
double top_speed_mps(const Model& model) {
  double top = 0.5;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kSurge) top = std::max(top, trial.measured);
  }
  return top;
}

/// Measurement errors of the rows of the simulated tables. Errors (input): those of row_error().
Result<RowNoise> noise_of(const Model& model, const TablePlan& plan,
                          const RecoverOptions& options) {
  constexpr double kStopWatch_s = 0.02;
  RowNoise noise{.surge = {}, .turning = {}, .stop_time_s = kStopWatch_s};
  if (options.plan == RecoverPlan::kLog) return noise;
  if (!plan.surge_tau_speed.empty()) {
    AWMR_ASSIGN_OR_RETURN(noise.surge, row_error(model, FitSubject::kSurge, options));
  }
  if (!plan.turning_steering_rad.empty() || !plan.turning_sides.empty()) {
    AWMR_ASSIGN_OR_RETURN(noise.turning, row_error(model, FitSubject::kYaw, options));
  }
  return noise;
}

struct Experiment {
  Plant<double> truth{};
  Vehicle vehicle;
  TablePlan tables;
  RowNoise noise;
  double coast_from_mps = 0.0;
};

/// Simulates the trials of run `index`. Their errors depend only on the seed and the index.
TrialData simulated_trials(const Experiment& experiment, const RecoverOptions& options,
                           std::uint64_t index) {
  Random random(options.seed, index);
  const SensorNoise& sensors = options.sensors;
  if (options.plan == RecoverPlan::kLog) {
    DrivePlan drive = options.drive;
    drive.drive = options.seed + index;
    TrialData data;
    data.logs.push_back(simulate_log(experiment.truth, experiment.vehicle, drive, sensors, random));
    return data;
  }
  TablePlan tables = experiment.tables;
  const bool curve = options.plan == RecoverPlan::kCurve;
  if (curve) tables.stop_from_mps.clear();
  TrialData data = simulate_tables(experiment.truth, tables, experiment.noise, random);
  if (curve) {
    data.curves.push_back(simulate_coastdown(experiment.truth, experiment.coast_from_mps,
                                             options.curve_s, options.curve_rate_hz,
                                             sensors.speed_mps, sensors.correlation_s, random));
  }
  return data;
}

struct OneRun {
  RecoverRun found;
  std::string why;             ///< reason of the first refusal
  std::optional<Error> error;  ///< set if the identification failed
};

/// Estimate of a parameter with its interval; empty if the parameter was given or has no interval.
std::optional<RecoverEstimate> interval_of(const Estimate& estimate) {
  if (!estimate.value || !estimate.ci95 || estimate.source == Source::kGiven) return std::nullopt;
  // An interval with an infinite end counts as no interval, as in model.json.
  const auto fits = [](double number) { return std::abs(number) <= kLargestEstimate; };
  if (!fits(*estimate.value) || !fits(estimate.std_error.value_or(0.0)) ||
      !std::isfinite(estimate.ci95->lo) || !std::isfinite(estimate.ci95->hi)) {
    return std::nullopt;
  }
  return RecoverEstimate{*estimate.value, estimate.std_error, *estimate.ci95};
}

OneRun identified_again(Vehicle vehicle, const TrialData& data, IdentifyOptions options,
                        const std::vector<RecoverTruth>& truths) {
  // The simulated vehicle has exactly this inertia, so that the error of the box formula, which is
  // in the interval of I'z, does not occur.
  if (data.logs.empty()) vehicle.yaw_inertia_kgm2 = vehicle.inertia_kgm2();
  options.threads = 1;
  options.side_by_side = false;
  OneRun run;
  run.found.estimates.resize(truths.size());
  const auto identified = identify(vehicle, data, options, {});
  if (!identified) {
    run.found.refused = true;
    run.error = identified.error();
    return run;
  }
  run.found.refused = !identified->refused.empty();
  for (const Finding& finding : identified->model.record.findings) {
    if (finding.severity == Severity::kError && run.why.empty()) run.why = finding.message;
  }
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const Estimate& estimate = identified->model[truths[i].id];
    // An assumed sway resistance is skipped, because it is not an estimate from the trials.
    if (estimate.method != kAssumedSwayMethod) run.found.estimates[i] = interval_of(estimate);
  }
  return run;
}

/// Executes the runs of the part `shard`, in order: simulates the trials of a run and identifies
/// them. `progress` is called on this thread with the number of completed runs.
std::vector<OneRun> simulated_runs(const Experiment& experiment, const RecoverOptions& options,
                                   const Shard& shard, const std::vector<RecoverTruth>& truths,
                                   const std::function<void(int)>& progress) {
  const int count = shard.share_of(options.runs);
  std::vector<OneRun> runs(at(count));
  std::atomic<int> done = 0;
  int reported = 0;
  LoopControl control;
  if (progress) control.progress = [&] { progress(reported = done); };
  parallel_for(
      runs.size(), options.threads,
      [&](std::size_t i) {
        const int index = shard.item(static_cast<int>(i));
        runs[i] =
            identified_again(experiment.vehicle, simulated_trials(experiment, options, at(index)),
                             options.identify, truths);
        runs[i].found.index = index;
        ++done;
      },
      control);
  if (progress && reported < count) progress(count);
  return runs;
}

/// Parameters whose estimates are evaluated, with their true values: the requested parameters that
/// have a value in the model. If none is requested, all parameters that have a value.
std::vector<RecoverTruth> truths_of(const Model& model, const std::vector<ParameterId>& requested) {
  std::vector<RecoverTruth> truths;
  for (const ParameterInfo& parameter : parameter_table()) {
    const bool is_requested = contains(requested, parameter.id);
    const std::optional<double>& value = model[parameter.id].value;
    if (value && (requested.empty() || is_requested)) truths.push_back({parameter.id, *value});
  }
  return truths;
}

/// Quantities that the model identified from its trials: neither given nor assumed.
std::vector<ParameterId> identified_in(const Model& model) {
  std::vector<ParameterId> identified;
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (!estimate.value || estimate.source == Source::kGiven) continue;
    if (estimate.method != kAssumedSwayMethod) identified.push_back(parameter.id);
  }
  return identified;
}

/// Stores the runs in the part. Also stores the first run with a refused parameter, with the
/// reason, and, if every run failed, the error of the first run.
void put_runs(std::vector<OneRun> runs, RecoverPart& part) {
  if (std::ranges::all_of(runs, [](const OneRun& run) { return run.error.has_value(); })) {
    part.error = runs.front().error;
  }
  for (OneRun& run : runs) {
    if (!run.why.empty() && !part.refusal) part.refusal = {run.found.index, run.why};
    part.runs.push_back(std::move(run.found));
  }
}

std::string noise_in_words(const RowNoise& rows, const RecoverOptions& options) {
  const SensorNoise& s = options.sensors;
  if (options.plan == RecoverPlan::kLog) {
    return fmt::format(
        "speed {:g} m/s, yaw rate {:.3g} rad/s, heading {:.3g} rad, position {:g} m at {:g} Hz, "
        "correlated over {:g} s",
        s.speed_mps, s.yaw_rate_radps, s.heading_rad, s.position_m, s.position_rate_hz,
        s.correlation_s);
  }
  return fmt::format("surge {:.3g} on {}, turning {:.3g} on {}; stop time {:g} s; curve {:g} m/s",
                     rows.surge.deviation, name_of(rows.surge.model), rows.turning.deviation,
                     name_of(rows.turning.model), rows.stop_time_s, s.speed_mps);
}

Status check_drive(const DrivePlan& drive) {
  constexpr double kMin = 20.0;
  constexpr double kMax = 1e6;
  const double rows = drive.duration_s * drive.rate_hz;
  if (drive.rate_hz > 0.0 && rows >= kMin && rows <= kMax) return {};
  return input_error(
      ErrorCode::kOutOfRange, option_text("duration"),
      fmt::format("{:g} s at {:g} Hz make {:.3g} rows; a simulated log needs {:g} to "
                  "{:g} rows",
                  drive.duration_s, drive.rate_hz, rows, kMin, kMax));
}

/// Adapts the options to the model. If the model has only parameters of straight motion, a
/// simulated log drives straight, and the fit estimates only the surge law (a1, b1) and the mass
/// m'. If the model's back-EMF was fitted, the fit to a simulated log estimates all fitted
/// parameters of the model. Parameters that the user requested take precedence.
RecoverOptions options_for(const Model& model, RecoverOptions options) {
  const bool log = options.plan == RecoverPlan::kLog;
  if (log && options.identify.requested.empty() && !is_absent_term(model, ParameterId::kBackEmf) &&
      model[ParameterId::kBackEmf].source != Source::kGiven) {
    for (const ParameterInfo& parameter : parameter_table()) {
      if (!can_be_requested(parameter) || !has(model.vehicle, parameter.id)) continue;
      if (model[parameter.id].source != Source::kGiven) {
        options.identify.requested.push_back(parameter.id);
      }
    }
  }
  if (model.simulated_motion() == Motion::kPlanar) return options;
  options.drive.straight = true;
  if (options.plan == RecoverPlan::kLog && options.identify.requested.empty()) {
    options.identify.requested = {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                                  ParameterId::kMassNorm};
  }
  return options;
}

/// Plant that the runs simulate. Errors (input): the model lacks a parameter that a trial needs.
Result<Plant<double>> truth_of(const Model& model, RecoverPlan plan) {
  if (plan == RecoverPlan::kLog) return model.plant(model.simulated_motion());
  if (plan == RecoverPlan::kCurve) AWMR_RETURN_IF_ERROR(model.plant(Motion::kStraight));
  return model.plant_of_trials();
}

Status check_plan(const Model& model, const Plant<double>& truth, const RecoverOptions& options) {
  if (options.runs < 2) {
    return input_error(ErrorCode::kOutOfRange, option_text("runs"), "at least 2 runs are needed");
  }
  if (options.plan == RecoverPlan::kLog) {
    AWMR_RETURN_IF_ERROR(check_drive(options.drive));
    return check_replay(truth, model.file);
  }
  if (!model.record.trials.empty()) return {};
  return input_error(
      ErrorCode::kMissing, model.file + ":/trials",
      "the model has no table rows to simulate again; use " + option_text("plan log"));
}

}  // namespace

Result<RecoverPart> recover_part(const Model& model, const RecoverOptions& given,
                                 const Shard& shard, const std::function<void(int)>& progress) {
  const RecoverOptions options = options_for(model, given);
  AWMR_ASSIGN_OR_RETURN(const Plant<double> truth, truth_of(model, options.plan));
  AWMR_RETURN_IF_ERROR(check_plan(model, truth, options));
  if (auto fault = shard_fault(shard, options.runs, "runs")) return input_errors({*fault});
  const TablePlan tables = plan_of(model);
  AWMR_ASSIGN_OR_RETURN(const RowNoise noise, noise_of(model, tables, options));
  const Experiment experiment{.truth = truth,
                              .vehicle = model.vehicle,
                              .tables = tables,
                              .noise = noise,
                              .coast_from_mps = top_speed_mps(model)};
  RecoverPart part{.all_runs = options.runs,
                   .noise_text = noise_in_words(experiment.noise, options),
                   .requested = given.identify.requested,
                   .truths = truths_of(model, given.identify.requested),
                   .runs = {},
                   .refusal = {},
                   .error = {}};
  if (given.identify.requested.empty() && options.plan != RecoverPlan::kLog) {
    part.identified = identified_in(model);
  }
  put_runs(simulated_runs(experiment, options, shard, part.truths, progress), part);
  return part;
}

}  // namespace awmr
