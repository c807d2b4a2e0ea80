/// Ranks the trials to record next by the reduction of the model's uncertainty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/synthetic.h"
#include "awmr/model/model.h"

namespace awmr {

/// A quantity whose uncertainty is to be reduced.
struct SuggestTarget {
  std::string name;  ///< a parameter, or a closed-loop metric
  /// Value for a plant. Its variance is grad^T C grad, with the gradient by finite differences.
  std::function<double(const Plant<double>&)> value;
};

struct SuggestOptions {
  /// Target of the ranking: the name of a parameter or of one of `metrics`. Empty: A-optimality,
  /// the root of the sum of squared relative errors of all parameters (of an exponent the absolute
  /// error, of a family's term relative to the whole resistance at 1 m/s or 1 rad/s).
  std::string parameter = {};
  /// Sensor noise of future curves and logs. Use the robot's own values if they are known.
  SensorNoise sensors = {};
  /// Number of runs of one candidate, >= 1.
  int repeats = 3;
  /// Closed-loop metrics as targets, evaluated by the caller.
  std::vector<SuggestTarget> metrics = {};
};

/// A candidate trial.
struct SuggestedTrial {
  TrialKind kind = TrialKind::kSurge;
  std::string settings;                                 ///< text for the field sheet
  std::vector<std::pair<std::string, double>> numbers;  ///< the same, units in the names
  std::string parameter = {};                           ///< criterion of the ranking
  double std_error_before = 0.0;                        ///< of that criterion, in its unit, >= 0
  double std_error_after = 0.0;  ///< the same with the trial, in [0, std_error_before]
  double d_gain = 0.0;           ///< ln det C before - after, >= 0: D-optimality
};

/// A parameter without a value.
struct MissingParameter {
  ParameterId id{};
  std::string trial;  ///< description of the trial that measures it
};

/// Differential turns with straight wheels that measure the tyre scrub, on which the choice between
/// differential, steering and combined depends (compare --break-even).
struct ScrubTurn {
  double yaw_rate_degps = 0.0;  ///< target, > 0
  /// F' of each left and each right wheel, over F_max, for this turn with the smallest and with the
  /// largest scrub moment: those of the trials, else 0 and sliding tyres with mu = 0.8.
  SideForces<double> least, most;
};

/// A turn that discriminates between the 3-DOF model and the tyre model. In (41) steered wheels
/// turn the vehicle only by the thrust of the motors; rolling tyres turn it also with the motors
/// off.
struct CoastingTurn {
  double speed_mps = 0.0;     ///< at which the motors are switched off, > 0
  double steering_deg = 0.0;  ///< set after that, > 0
  /// Yaw rate of wheels that roll without slip at that speed and angle, deg/s, > 0. The 3-DOF model
  /// predicts 0.
  double rolling_yaw_rate_degps = 0.0;
};

struct Suggestion {
  std::string criterion;                  ///< description
  std::vector<MissingParameter> missing;  ///< parameters without a value, whose trials come first
  std::vector<SuggestedTrial> trials;     ///< best first
  std::vector<ScrubTurn> scrub_turns;     ///< empty: the reason is in `about_scrub`
  std::string about_scrub;  ///< purpose of the scrub turns, or why there are none; empty: no
                            ///< steering
  std::vector<std::string> assumptions;
  std::optional<CoastingTurn> coasting = {};  ///< absent: no steering, or no surge resistance
};

/// Ranks the candidates. Information is additive:
///   C_after = (C^-1 + J^T W J)^-1
/// with J the derivatives of the candidate's measurements by the parameters' coordinates
/// (model/transform.h) and W the inverse variances of their errors. A parameter without a value is
/// reported as missing, and candidates that measure it are not evaluated. Errors (input): the model
/// has all values but no covariance; an unknown parameter name, or one without a value.
Result<Suggestion> suggest(const Model& model, const SuggestOptions& options);

/// Content of suggest.json.
std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance);
/// Field sheet: settings, durations and quantities to record.
std::string field_sheet(const Suggestion& suggestion, std::size_t most);

/// The JSON Schema of suggest.json.
std::string suggest_schema();

}  // namespace awmr
