/// Trials and logs -> Model: fits, derived quantities, uncertainty, identifiability.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/trials/log.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Which estimator fills the main values.
enum class Method { kLogLinear, kNonlinear, kTrajectory };
/// Where the nonlinear fit puts the error.
/// kLogForce, a factor on the force, is the log-linear method's assumption.
enum class Noise { kForce, kSpeed, kTime, kLogForce };
/// What a residual costs: squares, or a robust loss that an outlier cannot dominate.
enum class Loss { kNone, kHuber, kCauchy, kTukey };

/// One family, or the one with the least AICc.
struct FamilyChoice {
  std::optional<Family> family = Family::kPower;  ///< none: by AICc
};

struct IdentifyOptions {
  /// Default: the trajectory fit where there are logs, else log-linear, the paper's; nonlinear
  /// where a family or a loss is asked for that log-linear least squares does not know.
  std::optional<Method> method = {};
  std::optional<Noise> noise = {};  ///< default: time where it is given, else speed
  FamilyChoice surge_family = {};
  FamilyChoice yaw_family = {};
  Loss loss = Loss::kNone;
  bool joint = false;  ///< a1, b1, m' together from surge rows and coast-down curves
  std::vector<ParameterId> asked = {};  ///< empty: those the given trials exist for
  bool fit_input_delay = false;         ///< logs: one delay of all commands
  std::vector<LogChannel> biases = {};  ///< logs: channels with an unknown constant offset
  std::uint64_t seed = 1;               ///< of the starts and of the bootstrap
  int starts = 6;               ///< random starts of a fit of logs that has no start of its own
  int bootstrap = 0;            ///< resamples of the block bootstrap of a fit of logs; 0: none
  bool cross_validate = false;  ///< logs: leave one out, predict it
  int threads = 0;              ///< 0: all; the result does not depend on it
  bool side_by_side = true;     ///< false: the asked estimator alone, without its rivals and tests
};

struct TrialData {
  std::optional<TrialSet<SurgeRow>> surge = {};
  std::optional<TrialSet<TurningRow>> turning = {};
  std::optional<TrialSet<StopTimeRow>> coastdown = {};
  std::vector<CoastCurve> curves = {};
  std::vector<DrivingLog> logs = {};
};

struct Identification {
  Model model;
  std::vector<ParameterId> refused;  ///< asked for, but not identifiable: exit code 1
};

/// Errors (input): values that no option can save, such as a loss asked of the log-linear method. A
/// parameter the data cannot identify is not an error: it has no value, a `not-identifiable`
/// finding, and is in `refused`.
Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings);

}  // namespace awmr
