/// Ranking of the trials to record next (`awmr suggest`) by the reduction of the model's
/// uncertainty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/synthetic.h"
#include "awmr/model/model.h"

namespace awmr {

/// A closed-loop metric whose uncertainty is to be reduced.
struct SuggestTarget {
  std::string name;  ///< name of the metric
  /// Computes the metric for a plant. The variance of the metric is grad^T C grad. C is the
  /// covariance of the parameters' coordinates (their values or logarithms). grad is the gradient
  /// of the metric with respect to these coordinates, computed by finite differences.
  std::function<double(const Plant<double>&)> value;
};

/// Options of suggest().
struct SuggestOptions {
  /// Target of the ranking: the name of a parameter or of one of `metrics`. Empty: all parameters
  /// (A-optimality), that is, the root of the sum of their squared relative standard errors. In
  /// this sum, the error of an exponent is not divided by the exponent. The error of a further term
  /// of the resistance (Coulomb, quadratic, dead zone) is divided by the whole resistance at 1 m/s
  /// or 1 rad/s.
  std::string parameter = {};
  /// Sensor noise of future curves and logs. Use the robot's own values if they are known.
  SensorNoise sensors = {};
  /// Number of runs of each candidate, >= 1.
  int repeats = 3;
  /// Closed-loop metrics that can be targets.
  std::vector<SuggestTarget> metrics = {};
};

/// A trial with its effect on the target of the ranking.
struct SuggestedTrial {
  TrialKind kind = TrialKind::kSurge;
  std::string settings;                                 ///< text for the field sheet
  std::vector<std::pair<std::string, double>> numbers;  ///< settings: name with unit, and value
  std::string parameter = {};                           ///< name of the target
  double std_error_before = 0.0;  ///< standard error of the target now, in its unit, >= 0
  double std_error_after = 0.0;   ///< standard error of the target with this trial, >= 0
  /// Decrease of ln det C by the trial, >= 0 (D-optimality), with the covariance C of all
  /// parameters.
  double d_gain = 0.0;
};

/// A parameter without a value.
struct MissingParameter {
  ParameterId id{};
  std::string trial;  ///< description of the trial that measures the parameter
};

/// A differential turn with straight wheels, to measure the tyre scrub: the yaw moment that it
/// takes to drag the tyres sideways. The choice between the differential, steering and combined
/// modes depends on the scrub (compare --break-even).
struct ScrubTurn {
  double yaw_rate_degps = 0.0;  ///< yaw rate to reach, > 0
  /// Wheel forces F' (over F_max) for this yaw rate: `least` for the smallest possible scrub
  /// moment, `most` for the largest. If the scrub was measured, these moments are the ends of its
  /// 95 % interval. If it was not measured, the smallest moment is the largest yaw moment at which
  /// the vehicle did not turn (0 if none is known), and the largest moment is that of sliding tyres
  /// (friction 0.8). If the wheel forces do not suffice for the largest moment, `most` has the
  /// limits of the wheel force.
  SideForces<double> least, most;
};

/// A turn with the motors off, which decides between the 3-DOF model and the four-wheel tyre model.
/// In the 3-DOF model, steered wheels turn the vehicle only by the thrust of the motors. A vehicle
/// on real, rolling tyres turns with the motors off as well.
struct CoastingTurn {
  double speed_mps = 0.0;     ///< speed at which the motors are switched off, > 0
  double steering_deg = 0.0;  ///< steering angle set at that time, > 0: to the left
  /// Yaw rate, deg/s, if the wheels roll without slip at this speed and angle, > 0. The 3-DOF model
  /// predicts 0.
  double rolling_yaw_rate_degps = 0.0;
};

/// Result of suggest().
struct Suggestion {
  std::string criterion;                  ///< description of the ranking's target
  std::vector<MissingParameter> missing;  ///< parameters without a value, whose trials come first
  std::vector<SuggestedTrial> trials;     ///< best first
  std::vector<ScrubTurn> scrub_turns;     ///< empty: `about_scrub` has the reason
  /// Purpose of the scrub turns, or why there are none. Empty for a vehicle without steering.
  std::string about_scrub;
  std::vector<std::string> assumptions;       ///< assumed measurement errors, as text
  std::optional<CoastingTurn> coasting = {};  ///< absent without steering or surge resistance
};

/// Ranks the candidate trials by the standard error that the target would have after the trial. A
/// trial changes the covariance C of the parameters' coordinates (model/transform.h) to
///   C_after = (C^-1 + J^T W J)^-1
/// J: derivatives of the trial's measurements with respect to the coordinates. W: inverse variances
/// of the measurements' errors. Parameters without a value go to `missing`, and trials that measure
/// them are not ranked. Errors (input): every parameter of the model was given, so that no trial
/// can improve it; the target is unknown or has no value; the effect of a trial is not finite; a
/// time constant that is too short to simulate (check_replay()).
Result<Suggestion> suggest(const Model& model, const SuggestOptions& options);

/// Content of suggest.json.
std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance);
/// Field sheet for printing: settings, durations and quantities to record, for at most `most`
/// trials.
std::string field_sheet(const Suggestion& suggestion, std::size_t most);

/// The JSON Schema of suggest.json.
std::string suggest_schema();

}  // namespace awmr
