/// Options of identify().
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/model/family.h"
#include "awmr/model/parameters.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Which estimator fills the main values.
enum class Method {
  kLogLinear,   ///< tables: the paper's; power law and squared loss only
  kNonlinear,   ///< tables: where the error is on speed or time, another family or a robust loss
  kTrajectory,  ///< logs: where there are drives rather than runs; tables fill what they lack
};
inline constexpr NameTable<Method, 3> kMethodNames{{{"log-linear", Method::kLogLinear},
                                                    {"nonlinear", Method::kNonlinear},
                                                    {"trajectory", Method::kTrajectory}}};

/// Quantity with the error in the nonlinear fit: the measured one, not the one that was set
/// exactly.
enum class ErrorModel {
  kForce,     ///< the force was the uncertain one, e.g. a motor whose thrust drifts
  kSpeed,     ///< the rate was read off a sensor
  kTime,      ///< a known distance or angle was timed
  kLogForce,  ///< a factor on the force: the log-linear method's assumption
};
/// Parameters that can be requested.
inline constexpr NameTable<ErrorModel, 3> kErrorModelNames{
    {{"force", ErrorModel::kForce}, {"speed", ErrorModel::kSpeed}, {"time", ErrorModel::kTime}}};
/// As in /estimates.
constexpr std::string_view name_of(ErrorModel noise) {
  return noise == ErrorModel::kLogForce ? "log force" : name_in(kErrorModelNames, noise);
}

/// Loss of a residual: squares, or a robust loss that limits the effect of outliers.
enum class Loss {
  kSquared,  ///< default: the best where errors are normal
  kHuber,    ///< a few runs lie off the curve
  kCauchy,   ///< many do, or far off
  kTukey,    ///< gross mistakes, which then count for nothing; needs a good initial guess
};
inline constexpr NameTable<Loss, 4> kLossNames{{{"squares", Loss::kSquared},
                                                {"huber", Loss::kHuber},
                                                {"cauchy", Loss::kCauchy},
                                                {"tukey", Loss::kTukey}}};
/// As in /estimates: "Huber", "Cauchy", "Tukey".
inline std::string title_of(Loss loss) {
  std::string title(name_in(kLossNames, loss));
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

/// One family of resistance, where it is known or to be compared with others; none to take the one
/// with the minimum AICc, where the data are to say.
struct FamilyChoice {
  std::optional<Family> family = Family::kPower;
  /// True if the user selected the family. If false, logs are compared with every family, and one
  /// that is significantly better than the power law is taken.
  bool asked = false;
};

/// Whether a fit can be requested it by name: a term comes with its family, back-EMF is in none.
inline bool can_be_asked(const ParameterInfo& parameter) {
  return !parameter.term || parameter.id == ParameterId::kBackEmf;
}

struct IdentifyOptions {
  /// Default: the trajectory fit where there are logs, else log-linear, the paper's; nonlinear
  /// where a family or a loss is requested that log-linear least squares does not know.
  std::optional<Method> method = {};
  /// Default: time where every run was timed, else speed. Set it where another was uncertain.
  std::optional<ErrorModel> noise = {};
  FamilyChoice surge_family = {};  ///< other than power where `power-law-inadequate` is found
  FamilyChoice yaw_family = {};
  Loss loss = Loss::kSquared;  ///< robust where `outlier` is found and the run cannot be repeated
  /// a1, b1, m' together from surge rows and coast-down curves: the curve then sharpens a1 and b1
  /// too, where it is believed as much as the rows.
  bool joint = false;
  std::vector<ParameterId> asked = {};  ///< empty: those the given trials exist for
  bool asked_all =
      false;  ///< `asked` contains all parameters; those that the vehicle does not have are left out
  bool fit_input_delay = false;         ///< logs: one delay of all commands, s, where it is unknown
  std::vector<LogChannel> biases = {};  ///< logs: channels with an unknown constant offset
  std::uint64_t seed = 1;               ///< of the multistart and of the bootstrap
  int starts = 6;     ///< logs: random initial guesses where no trial gives one; >= 0
  int bootstrap = 0;  ///< logs: resamples, some 1000 where errors stay correlated; 0: none
  /// Logs: seconds after which every search stops where it is; what has not converged by then is
  /// refused. 0: none; the number of steps is bounded in any case. Where an answer is due.
  double time_limit_s = 0.0;
  bool cross_validate = false;  ///< logs: leave one out, predict it; where there are two or more
  int threads = 0;              ///< 0: all; the result does not depend on it
  bool side_by_side =
      true;  ///< false: the requested estimator alone, without its alternatives and tests
  bool keeps_outliers = false;  ///< tables: gross outliers are fitted with the other runs
  /// Logs: called with a description of each step as it begins. Does not affect the result.
  std::function<void(std::string_view)> doing = {};
  /// Logs: called with the reason before a step that may take more than 10 s. Does not affect the
  /// result.
  std::function<void(std::string_view)> notice = {};
};

}  // namespace awmr
