/// The model against the trials it came from, and the paper's claims against the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/logs.h"

namespace awmr {

/// One trial row against the model.
struct TrialResidual {
  TrialKind kind = TrialKind::kSurge;
  std::string file;
  int line = 0;
  std::string unit;
  double measured = 0.0;
  /// Absent where the model has no such figure, see predicted_measurement().
  std::optional<double> predicted;
  std::optional<double> relative_error;  ///< (predicted - measured)/measured
};

/// A setting that the paper leaves open, and what becomes of a claim there.
struct ClaimCase {
  AllocationForm allocation = AllocationForm::kExact;
  Interval wheel_force;      ///< F' of one wheel
  double mass_factor = 1.0;  ///< of m' and I'z, > 0
  CombinedSplit split = CombinedSplit::kRedistribute;
  bool reproduced = false;
};

/// A claim about every mode, in one of them.
struct ClaimInMode {
  YawMode mode{};
  bool reproduced = false;
  std::vector<ClaimCase> cases = {};
};

struct Claim {
  std::string id;         ///< "C1"
  std::string statement;  ///< what the paper says
  bool reproduced = false;
  std::string figure;     ///< the numbers found
  std::string tolerance;  ///< what counts as reproduced
  std::string why;
  std::vector<ClaimInMode> modes = {};  ///< of a claim that says the same of every mode
  /// Over all that is open, where that was asked for (ValidateOptions::open_cases).
  std::vector<ClaimCase> cases = {};
  std::string decided_by = {};  ///< the settings of the cases that it hangs on, in words
};

struct Validation {
  std::vector<TrialResidual> trials;
  /// Root mean square of the relative errors of a kind; absent where the model has no such trial.
  std::optional<double> surge_rms_relative_error;
  std::optional<double> turning_rms_relative_error;
  std::optional<double> coastdown_rms_relative_error;
  std::vector<LogValidation> logs;
  std::vector<Acceptance> drives;  ///< of logs of a scenario under the controller
  std::vector<Claim> claims;
  /// Every kind of trial, and every log, is predicted within its tolerance, every drive of a
  /// scenario is as foretold; and there is one of them.
  bool passed = false;
  std::string verdict;  ///< one sentence
};

struct ValidateOptions {
  double tolerance = 0.15;  ///< largest accepted RMS relative error of a trial kind, > 0
  /// Also judge every claim over what the paper leaves open (see open_cases.h), some seconds.
  bool open_cases = false;
  Progress progress = {};  ///< by those cases, from the thread that called validate()
};

/// What the model says a trial should have measured:
///   surge      the steady speed u, m/s, at tau_speed
///   turning    the steady yaw rate r, rad/s, at tau_turn
///   coastdown  the time t_a, s, from motors off to rest
/// steady_rate() and stop_time_s() of model/steady.h have the equations.
/// Absent where the law gives none: a finite steady speed with b near 0, a stop time with b1 >= 1;
/// and for a kind of trial that is none of these.
std::optional<double> predicted_measurement(const Plant<double>& plant, const TrialPoint& trial);

/// The claims never decide `passed`: a claim that is not reproduced is a finding about the paper.
/// Without gains, only the claims that need none are run, and those only that what is known of the
/// model allows; the verdict names the others.
/// Errors (input): the model lacks a parameter that its trials are measurements of, with gains any;
/// a trial in it is of no known kind or not positive; the tolerance is not positive.
Result<Validation> validate(const Model& model, const std::optional<Gains<double>>& gains,
                            const ValidateOptions& options);

/// Adds the logs' figures and takes them into the verdict.
void add_logs(Validation& validation, std::vector<LogValidation> logs, double tolerance);

/// Adds the drives of a scenario and takes them into the verdict.
void add_drives(Validation& validation, std::vector<Acceptance> drives);

/// The bytes of validation.json.
std::string validation_text(const Validation& validation, const Provenance& provenance);

/// How each log is predicted, channel by channel, for a terminal; empty without logs.
std::string logs_table(const Validation& validation);
/// The residuals and the claims as a table for a terminal.
std::string validation_table(const Validation& validation);

/// Every claim with verdict, figure, tolerance and why, for a terminal.
std::string claims_table(const std::vector<Claim>& claims);
/// The same as a Markdown table, for the documentation. made_by: the command that makes it again.
std::string claims_markdown(const std::vector<Claim>& claims, std::string_view made_by);

/// The JSON Schema of validation.json.
std::string validation_schema();

}  // namespace awmr
