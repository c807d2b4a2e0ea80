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

/// Estimator of the main values.
enum class Method {
  kLogLinear,   ///< tables: the paper's; power law and squared loss only
  kNonlinear,   ///< tables: errors of speed or time, other families, robust losses
  kTrajectory,  ///< logs: drives in place of single runs; tables give the parameters that logs lack
};
inline constexpr NameTable<Method, 3> kMethodNames{{{"log-linear", Method::kLogLinear},
                                                    {"nonlinear", Method::kNonlinear},
                                                    {"trajectory", Method::kTrajectory}}};

/// Quantity with the measurement error in the nonlinear fit. The other one was set exactly.
enum class ErrorModel {
  kForce,     ///< error of the force, e.g. a motor whose thrust drifts
  kSpeed,     ///< error of the speed or yaw rate, e.g. of a sensor
  kTime,      ///< error of the time for a known distance or angle
  kLogForce,  ///< relative error of the force: the assumption of the log-linear method
};
/// Error models that can be requested.
inline constexpr NameTable<ErrorModel, 3> kErrorModelNames{
    {{"force", ErrorModel::kForce}, {"speed", ErrorModel::kSpeed}, {"time", ErrorModel::kTime}}};
/// Name in /estimates.
constexpr std::string_view name_of(ErrorModel noise) {
  return noise == ErrorModel::kLogForce ? "log force" : name_in(kErrorModelNames, noise);
}

/// Loss of a residual: squares, or a robust loss that limits the effect of outliers.
enum class Loss {
  kSquared,  ///< default: optimal for normal errors
  kHuber,    ///< a few outliers
  kCauchy,   ///< many or large outliers
  kTukey,    ///< ignores gross outliers; needs a good initial guess
};
inline constexpr NameTable<Loss, 4> kLossNames{{{"squares", Loss::kSquared},
                                                {"huber", Loss::kHuber},
                                                {"cauchy", Loss::kCauchy},
                                                {"tukey", Loss::kTukey}}};
/// Name in /estimates: "Huber", "Cauchy", "Tukey".
inline std::string title_of(Loss loss) {
  std::string title(name_in(kLossNames, loss));
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

/// The selected resistance family. Absent: the family with the minimum AICc.
struct FamilyChoice {
  std::optional<Family> family = Family::kPower;
  /// True if the user selected the family. If false, logs are compared with every family, and one
  /// that is significantly better than the power law is taken.
  bool requested = false;
};

/// Whether a parameter can be requested by name. The terms of a family are requested by the family;
/// back-EMF belongs to no family.
inline bool can_be_requested(const ParameterInfo& parameter) {
  return !parameter.term || parameter.id == ParameterId::kBackEmf;
}

struct IdentifyOptions {
  /// Default: the trajectory fit if there are logs; else log-linear as in the paper, or nonlinear
  /// if the requested family or loss needs it.
  std::optional<Method> method = {};
  /// Default: time if every run was timed, else speed.
  std::optional<ErrorModel> noise = {};
  FamilyChoice surge_family = {};  ///< not power after a finding `power-law-inadequate`
  FamilyChoice yaw_family = {};
  Loss loss = Loss::kSquared;  ///< robust after a finding `outlier`, if the run cannot be repeated
  /// Fits a1, b1, m' jointly to surge rows and coast-down curves, so that the curves also improve
  /// a1 and b1. For curves as reliable as the rows.
  bool joint = false;
  std::vector<ParameterId> requested = {};  ///< empty: the parameters that the given trials measure
  /// `requested` contains all parameters; those that the vehicle does not have are left out.
  bool requested_all = false;
  bool fit_input_delay = false;         ///< logs: estimates one delay of all commands, s
  std::vector<LogChannel> biases = {};  ///< logs: channels with an unknown constant offset
  std::uint64_t seed = 1;               ///< of the multistart and of the bootstrap
  int starts = 6;     ///< logs: number of random initial guesses if no trial gives one; >= 0
  int bootstrap = 0;  ///< logs: number of resamples, about 1000 for correlated errors; 0: none
  /// Logs: time limit of the searches, s, for a result by a deadline. Fits that have not converged
  /// by then are refused. 0: no time limit; the number of steps is limited in any case.
  double time_limit_s = 0.0;
  bool cross_validate = false;  ///< logs: fits without each log in turn and predicts it; needs two
                                ///< logs
  int threads = 0;              ///< 0: all; the result does not depend on it
  bool side_by_side =
      true;  ///< false: only the requested estimator, without alternatives and tests
  bool keeps_outliers = false;  ///< tables: gross outliers are fitted with the other runs
  /// Logs: called with a description of each step as it begins. Does not affect the result.
  std::function<void(std::string_view)> doing = {};
  /// Logs: called with the reason before a step that may take more than 10 s. Does not affect the
  /// result.
  std::function<void(std::string_view)> notice = {};
};

}  // namespace awmr
