/// Ranks the trials to record next by the reduction of the model's uncertainty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/synthetic.h"
#include "awmr/model/model.h"

namespace awmr {

/// A number that should become surer.
struct SuggestTarget {
  std::string name;  ///< a parameter, or a closed-loop metric
  /// Its value at a plant. Its variance is grad^T C grad with the gradient by differences.
  std::function<double(const Plant<double>&)> value;
};

struct SuggestOptions {
  /// Target of the ranking: the name of a parameter or of one of `metrics`. Empty: A-optimal, the
  /// root sum of the squared relative errors of all parameters (an exponent's error as it is, a
  /// family's term relative to the whole resistance at 1 m/s or 1 rad/s).
  std::string parameter = {};
  /// Sensor noise of future curves and logs. Use the robot's own values if they are known.
  SensorNoise sensors = {};
  /// Runs of one candidate, >= 1: as many as there is time for in the field.
  int repeats = 3;
  /// Closed-loop figures, worked out by the caller, where a figure matters rather than a parameter.
  std::vector<SuggestTarget> metrics = {};
};

/// A trial that could be recorded.
struct SuggestedTrial {
  TrialKind kind = TrialKind::kSurge;
  std::string settings;                                 ///< text for the field sheet
  std::vector<std::pair<std::string, double>> numbers;  ///< the same, units in the names
  std::string parameter = {};                           ///< criterion of the ranking
  double std_error_before = 0.0;                        ///< of that, in its unit, >= 0
  double std_error_after = 0.0;  ///< of that, in its unit, in [0, std_error_before]
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
  double yaw_rate_degps = 0.0;  ///< to turn at, > 0
  /// F' of each left and each right wheel, over F_max, that turn so if the tyres take as little as they
  /// may, and if they take as much: as the trials have it, else nothing and sliding on a friction of 0.8.
  SideForces<double> least, most;
};

/// A turn that shows whether the 3-DOF model or the tyre model is right: in (41) the front wheels
/// turn the vehicle by the motors' thrust alone, wheels that roll turn it whether or not the motors
/// push.
struct CoastingTurn {
  double speed_mps = 0.0;     ///< to let go at, > 0
  double steering_deg = 0.0;  ///< to steer once the motors are off, > 0
  /// Of wheels that roll without slipping at that speed and angle, deg/s, > 0. The model has 0.
  double rolling_yaw_rate_degps = 0.0;
};

struct Suggestion {
  std::string criterion;                  ///< in words
  std::vector<MissingParameter> missing;  ///< no value at all: their trials come before any other
  std::vector<SuggestedTrial> trials;     ///< best first
  std::vector<ScrubTurn> scrub_turns;     ///< empty where `about_scrub` says why
  std::string about_scrub;  ///< their purpose, or why there are none; empty: no steering
  std::vector<std::string> assumptions;
  std::optional<CoastingTurn> coasting = {};  ///< absent: no steering, or no surge resistance yet
};

/// Information adds up:
///   C_after = (C^-1 + J^T W J)^-1
/// with J the derivatives of what the candidate would measure by the parameters' coordinates
/// (model/transform.h) and W the inverse variances of its errors. What the model has no value of
/// cannot be varied: it is reported as missing, and candidates that measure it are not evaluated.
/// Errors (input): the model has a value of everything but no covariance; an unknown parameter
/// name, or one without a value.
Result<Suggestion> suggest(const Model& model, const SuggestOptions& options);

/// The bytes of suggest.json.
std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance);
/// A sheet for the field: what to set, how long, what to write down.
std::string field_sheet(const Suggestion& suggestion, std::size_t most);

/// The JSON Schema of suggest.json.
std::string suggest_schema();

}  // namespace awmr
