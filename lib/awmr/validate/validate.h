/// Validation of a model: on its own trials, on logs and drives, and on the paper's claims.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/logs.h"
#include "awmr/validate/tyre_fit.h"

namespace awmr {

/// Measured and predicted value of one trial, a row of a table.
struct TrialResidual {
  TrialKind kind = TrialKind::kSurge;
  std::string file;
  int line = 0;
  std::string unit;
  double measured = 0.0;
  /// Predicted value, in `unit`; absent if the model gives none (predicted_measurement()).
  std::optional<double> predicted;
  std::optional<double> relative_error;  ///< (predicted - measured)/measured
};

/// A combination of the settings that the paper leaves open (open_cases()), and whether it
/// reproduces a claim.
struct ClaimCase {
  AllocationForm allocation = AllocationForm::kExact;
  Interval wheel_force;      ///< limits of F', the force of one wheel divided by F_max
  double mass_factor = 1.0;  ///< factor on m' and I'z, > 0
  CombinedSplit split = CombinedSplit::kRedistribute;
  bool reproduced = false;
};

/// Result of a claim for one of the modes.
struct ClaimInMode {
  YawMode mode{};
  bool reproduced = false;
  std::vector<ClaimCase> cases = {};
};

/// A claim of the paper, with the verdict from simulation.
struct Claim {
  std::string id;         ///< number of the claim: "C1"
  std::string statement;  ///< statement of the paper
  bool reproduced = false;
  std::string figure;     ///< simulated numbers, as text
  std::string tolerance;  ///< criterion for "reproduced"
  std::string why;        ///< reason for the verdict, as text
  /// Verdict for each mode; empty if the claim has no verdict for a single mode.
  std::vector<ClaimInMode> modes = {};
  /// Verdict by combination of open settings, if requested (ValidateOptions::open_cases).
  std::vector<ClaimCase> cases = {};
  std::string decided_by = {};  ///< settings that decide the verdict (decisive_settings())
};

/// Result of validate(), add_logs() and add_drives().
struct Validation {
  std::vector<TrialResidual> trials;
  /// RMS of the relative errors of the surge, turning and coast-down trials. Absent if the model
  /// has no trial of the kind, or cannot predict one of them.
  std::optional<double> surge_rms_relative_error;
  std::optional<double> turning_rms_relative_error;
  std::optional<double> coastdown_rms_relative_error;
  std::vector<LogValidation> logs;
  std::optional<TyreFit> tyres;    ///< tyres fitted to the logs; absent if not requested or refused
  std::vector<Acceptance> drives;  ///< results for drives of a scenario under the controller
  std::vector<Claim> claims;
  /// Verdict of the validation. True if every kind of trial and every log is predicted within its
  /// tolerance, and every drive of a scenario agrees with the prediction. False without trials,
  /// logs and drives.
  bool passed = false;
  std::string verdict;  ///< `passed` and its reasons in one sentence
};

struct ValidateOptions {
  double tolerance = 0.15;  ///< largest accepted RMS relative error of a trial kind, > 0
  /// True: also evaluates every claim over the settings that the paper leaves open (open_cases()),
  /// which takes some seconds.
  bool open_cases = false;
  Progress progress = {};  ///< called for each finished case, on the thread of validate()
};

/// Predicts the measurement of a trial:
///   surge      the steady speed u, m/s, at tau_speed
///   turning    the steady yaw rate r, rad/s, at tau_turn
///   coastdown  the time t_a, s, from motors off to rest
/// steady_rate() and stop_time_s() of model/steady.h have the equations. Absent if the resistance
/// law gives no finite value: an exponent b near 0 gives no steady speed, b1 >= 1 no stop time.
/// Also absent for other kinds of trial.
std::optional<double> predicted_measurement(const Plant<double>& plant, const TrialPoint& trial);

/// Predicts the model's trials and checks the paper's claims. Claims do not affect `passed`,
/// because a claim that is not reproduced is a result about the paper, not about the model. If no
/// gains are given, validate() checks only the claims C1, C2 and C14. It leaves out claims that
/// need parameters which the model lacks, or four driven wheels and steering which the vehicle
/// lacks; the verdict names them. Errors (input): the model lacks a parameter that its trials
/// measure or, with gains, any parameter; the input or the measurement of a trial is not above 0;
/// the tolerance is not above 0; the errors of batch_arithmetic().
Result<Validation> validate(const Model& model, const std::optional<ModeGains>& gains,
                            const ValidateOptions& options);

/// Adds the results for logs and includes them in `passed` and in the verdict. `tolerance`: the
/// largest accepted NRMSE, for the text of the verdict.
void add_logs(Validation& validation, std::vector<LogValidation> logs, double tolerance);

/// Adds the results for drives of a scenario and includes them in `passed` and in the verdict.
void add_drives(Validation& validation, std::vector<Acceptance> drives);

/// Text of validation.json.
std::string validation_text(const Validation& validation, const Provenance& provenance);

/// Prediction errors of each log by channel, as text for a terminal; empty without logs.
std::string logs_table(const Validation& validation);
/// Table for a terminal: measured and predicted values of the trials, errors of the logs, verdict,
/// and claims.
std::string validation_table(const Validation& validation);

/// Text for a terminal: every claim with verdict, simulated numbers, criterion and reason.
std::string claims_table(const std::vector<Claim>& claims);
/// The claims as a Markdown table for the documentation. `made_by`: the command that made it.
std::string claims_markdown(const std::vector<Claim>& claims, std::string_view made_by);

/// The JSON Schema of validation.json.
std::string validation_schema();

}  // namespace awmr
