#include "awmr/validate/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/index.h"
#include "awmr/model/steady.h"
#include "awmr/validate/claims.h"

namespace awmr {
namespace {

std::string unit_of(TrialKind kind) {
  if (kind == TrialKind::kSurge) return "m/s";
  if (kind == TrialKind::kTurning) return "rad/s";
  return "s";
}

std::vector<Fault> trial_faults(const Model& model) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < model.record.trials.size(); ++i) {
    const TrialPoint& trial = model.record.trials[i];
    const std::string place = fmt::format("{}:/trials/{}", model.file, i);
    if (!(trial.input > 0.0) || !(trial.measured > 0.0)) {
      faults.push_back({ErrorCode::kOutOfRange, place,
                        fmt::format("input {} and measured {} must both be above 0; remove the "
                                    "row or identify again",
                                    trial.input, trial.measured)});
    }
  }
  return faults;
}

TrialResidual residual_of(const Plant<double>& plant, const TrialPoint& trial) {
  TrialResidual residual{.kind = trial.kind,
                         .file = trial.file,
                         .line = trial.line,
                         .unit = unit_of(trial.kind),
                         .measured = trial.measured,
                         .predicted = predicted_measurement(plant, trial),
                         .relative_error = {}};
  if (residual.predicted) {
    residual.relative_error = (*residual.predicted - trial.measured) / trial.measured;
  }
  return residual;
}

/// Absent if there is no trial of this kind, or if a trial has no prediction.
std::optional<double> rms_relative_error(const std::vector<TrialResidual>& trials, TrialKind kind) {
  double sum = 0.0;
  int count = 0;
  for (const TrialResidual& trial : trials) {
    if (trial.kind != kind) continue;
    if (!trial.relative_error) return std::nullopt;
    sum += *trial.relative_error * *trial.relative_error;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

void set_verdict(Validation& validation, double tolerance) {
  if (validation.trials.empty()) {
    validation.verdict =
        "not validated: the model contains no trials; identify it from trials, or give a log "
        "(--log)";
    return;
  }
  const auto unpredicted =
      std::count_if(validation.trials.begin(), validation.trials.end(),
                    [](const TrialResidual& trial) { return !trial.predicted.has_value(); });
  std::string figures;
  bool within = true;
  const auto add = [&](const char* kind, const std::optional<double>& rms) {
    if (!rms) return;
    within = within && *rms <= tolerance;
    figures += fmt::format("{}{} {:.1f} %", figures.empty() ? "" : ", ", kind, 100.0 * *rms);
  };
  add("surge", validation.surge_rms_relative_error);
  add("turning", validation.turning_rms_relative_error);
  add("coastdown", validation.coastdown_rms_relative_error);
  validation.passed = within && unpredicted == 0;
  validation.verdict =
      fmt::format("the model {} its own trials: RMS relative error {} (accepted: {:.1f} %)",
                  validation.passed ? "predicts" : "does not predict",
                  figures.empty() ? "cannot be given" : figures, 100.0 * tolerance);
  const auto stops =
      std::count_if(validation.trials.begin(), validation.trials.end(),
                    [](const TrialResidual& trial) { return trial.kind == TrialKind::kCoastdown; });
  if (stops == 1) validation.verdict += "; a single stop time determines m' but cannot check it";
  if (unpredicted > 0) {
    validation.verdict += fmt::format(
        "; {} row(s) have no finite prediction: with an exponent (surge.beta, yaw.beta) near 0 "
        "there is no steady rate, with surge.beta >= 1 no stop",
        unpredicted);
  }
}

/// Checks the claims that can be checked with this vehicle and model. C1 needs the parameters of
/// straight motion, C14 needs none. All claims except these two compare the three modes and need
/// every parameter, four driven wheels and steering. Errors (input): with gains, the model lacks a
/// parameter; the errors of batch_arithmetic().
Status add_claims(const Model& model, const std::optional<ModeGains>& gains,
                  const ValidateOptions& options, Validation& validation) {
  const auto whole = model.plant();
  const bool all_modes = model.vehicle.drive == Drive::kFourWheel;
  if (whole && all_modes) {
    AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
    validation.claims = check_claims(model, gains, arithmetic);
    if (options.open_cases) {
      add_open_cases(model, gains, arithmetic, validation.claims, options.progress);
    }
    return {};
  }
  if (!whole && gains) return tl::unexpected(whole.error());
  const auto straight = model.plant(Motion::kStraight);
  if (straight) validation.claims.push_back(check_straight_run(model, *straight));
  validation.claims.push_back(check_time_constants(gains));
  if (!model.vehicle.has_steering()) {
    validation.verdict +=
        "; claims C2 to C13 are left out, because they compare modes and this vehicle has one";
  } else if (!all_modes) {
    validation.verdict +=
        "; claims C2 to C13 are left out, because they compare the modes of four driven wheels";
  } else {
    validation.verdict +=
        fmt::format("; claims for which the model lacks parameters are left out ({})",
                    straight ? "C2" : "C1, C2");
  }
  return {};
}

/// Adds the result for logs or drives to Validation::passed and, as a sentence, to the verdict.
void take_into_verdict(Validation& validation, bool passed, const std::string& sentence) {
  const bool first = validation.trials.empty() && validation.logs.empty();
  validation.passed = first ? passed : validation.passed && passed;
  validation.verdict = first ? sentence : fmt::format("{}; {}", validation.verdict, sentence);
}

}  // namespace

void add_logs(Validation& validation, std::vector<LogValidation> logs, double tolerance) {
  if (logs.empty()) return;
  std::size_t predicted = 0;
  double horizon_s = 0.0;
  for (const LogValidation& log : logs) {
    predicted += log.passed ? 1 : 0;
    horizon_s = std::max(horizon_s, log.horizon_s);
  }
  const bool all = predicted == logs.size();
  const std::string sentence = fmt::format(
      "{} of {} logs are predicted over up to {:.4g} s with an NRMSE of at most {:g} in every "
      "channel",
      predicted, logs.size(), horizon_s, tolerance);
  take_into_verdict(validation, all, sentence);
  validation.logs = std::move(logs);
}

void add_drives(Validation& validation, std::vector<Acceptance> drives) {
  if (drives.empty()) return;
  const auto inside = std::count_if(drives.begin(), drives.end(),
                                    [](const Acceptance& drive) { return drive.inside; });
  take_into_verdict(validation, inside == eigen_index(drives.size()),
                    fmt::format("{} of {} drives of '{}' agree with the prediction", inside,
                                drives.size(), drives.front().scenario));
  validation.drives = std::move(drives);
}

std::optional<double> predicted_measurement(const Plant<double>& plant, const TrialPoint& trial) {
  // Surge force at straight wheels (d_r = 0): tau_speed = 4 F', F' the force of one wheel over
  // F_max. The dead zone F'0 of the motors removes 4 F'0.                  [paper (41)]
  if (trial.kind == TrialKind::kSurge) {
    return steady_rate(plant.surge, trial.input - driven_wheels(plant) * plant.wheel_dead_zone);
  }
  if (trial.kind == TrialKind::kTurning) return steady_rate(plant.yaw, trial.input);
  if (trial.kind == TrialKind::kCoastdown)
    return stop_time_s(plant.surge, plant.mass_norm, trial.input);
  return std::nullopt;
}

Result<Validation> validate(const Model& model, const std::optional<ModeGains>& gains,
                            const ValidateOptions& options) {
  if (!(options.tolerance > 0.0)) {
    return input_error(ErrorCode::kOutOfRange, "",
                       fmt::format("tolerance: has to be above 0, found {}", options.tolerance));
  }
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant_of_trials());
  std::vector<Fault> faults = trial_faults(model);
  if (!faults.empty()) return input_errors(std::move(faults));

  Validation validation;
  for (const TrialPoint& trial : model.record.trials) {
    validation.trials.push_back(residual_of(plant, trial));
  }
  validation.surge_rms_relative_error = rms_relative_error(validation.trials, TrialKind::kSurge);
  validation.turning_rms_relative_error =
      rms_relative_error(validation.trials, TrialKind::kTurning);
  validation.coastdown_rms_relative_error =
      rms_relative_error(validation.trials, TrialKind::kCoastdown);
  set_verdict(validation, options.tolerance);
  AWMR_RETURN_IF_ERROR(add_claims(model, gains, options, validation));
  return validation;
}

}  // namespace awmr
