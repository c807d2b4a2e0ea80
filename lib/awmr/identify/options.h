/// What a caller of identify() can ask for.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "awmr/model/family.h"
#include "awmr/model/parameters.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Which estimator fills the main values.
enum class Method { kLogLinear, kNonlinear, kTrajectory };
/// Where the nonlinear fit puts the error.
/// kLogForce, a factor on the force, is the log-linear method's assumption.
enum class ErrorModel { kForce, kSpeed, kTime, kLogForce };
/// What a residual costs: squares, or a robust loss that an outlier cannot dominate.
enum class Loss { kSquared, kHuber, kCauchy, kTukey };

/// One family, or the one with the least AICc.
struct FamilyChoice {
  std::optional<Family> family = Family::kPower;  ///< none: by AICc
};

struct IdentifyOptions {
  /// Default: the trajectory fit where there are logs, else log-linear, the paper's; nonlinear
  /// where a family or a loss is asked for that log-linear least squares does not know.
  std::optional<Method> method = {};
  std::optional<ErrorModel> noise = {};  ///< default: time where it is given, else speed
  FamilyChoice surge_family = {};
  FamilyChoice yaw_family = {};
  Loss loss = Loss::kSquared;
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

}  // namespace awmr
