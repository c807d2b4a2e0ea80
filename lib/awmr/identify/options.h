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

/// Estimator that sets the values in the model.
enum class Method {
  kLogLinear,   ///< tables: the paper's least squares of logarithms; power law, squared loss only
  kNonlinear,   ///< tables: least squares of force, speed or time; all families and losses
  kTrajectory,  ///< driving logs; tables set only the parameters that the logs do not determine
};
inline constexpr NameTable<Method, 3> kMethodNames{{{"log-linear", Method::kLogLinear},
                                                    {"nonlinear", Method::kNonlinear},
                                                    {"trajectory", Method::kTrajectory}}};

/// Quantity that has the measurement error in the nonlinear fit. The fit assumes that all other
/// quantities are exact.
enum class ErrorModel {
  kForce,     ///< error of the force, e.g. a motor whose thrust drifts
  kSpeed,     ///< error of the speed or yaw rate, e.g. of a sensor
  kTime,      ///< error of the time that a known distance or angle takes
  kLogForce,  ///< relative error of the force: the assumption of the log-linear method
};
/// Values of --noise.
inline constexpr NameTable<ErrorModel, 3> kErrorModelNames{
    {{"force", ErrorModel::kForce}, {"speed", ErrorModel::kSpeed}, {"time", ErrorModel::kTime}}};
/// Name of an error model in /estimates of model.json.
constexpr std::string_view name_of(ErrorModel noise) {
  return noise == ErrorModel::kLogForce ? "log force" : name_in(kErrorModelNames, noise);
}

/// Loss function of the residuals: squared, or a robust loss that limits the effect of outliers.
enum class Loss {
  kSquared,  ///< default: optimal for normal errors
  kHuber,    ///< for a few outliers
  kCauchy,   ///< for many or large outliers
  kTukey,    ///< ignores gross outliers; needs a good initial guess
};
inline constexpr NameTable<Loss, 4> kLossNames{{{"squares", Loss::kSquared},
                                                {"huber", Loss::kHuber},
                                                {"cauchy", Loss::kCauchy},
                                                {"tukey", Loss::kTukey}}};
/// Name of a robust loss in /estimates of model.json: "Huber", "Cauchy", "Tukey".
inline std::string title_of(Loss loss) {
  std::string title(name_in(kLossNames, loss));
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

/// Resistance family (form of the resistance law) to fit.
struct FamilyChoice {
  /// Absent: the family with the smallest AICc (tables) or AIC (logs).
  std::optional<Family> family = Family::kPower;
  /// True if the user selected the family. If false, `family` is only a default. The fit then tries
  /// other families on logs that suggest a missing term, and a significantly better family replaces
  /// the power law.
  bool requested = false;
};

/// True if --fit accepts the parameter. Terms of a resistance family are requested by --family
/// instead. Back-EMF is a term that belongs to no family, so --fit accepts it.
inline bool can_be_requested(const ParameterInfo& parameter) {
  return !parameter.term || parameter.id == ParameterId::kBackEmf;
}

/// Names of the quantities that --fit accepts for logs in addition to parameters and biases, such
/// as "motor.time_constant_s" or "delay.speed_mps". The /estimates of model.json use the same
/// names.
std::vector<std::string> requestable_terms();

/// Names in /estimates of quantities that --fit does not accept, because a fit estimates them only
/// if the logs indicate them.
std::vector<std::string> automatic_terms();

struct IdentifyOptions {
  /// Estimator that sets the values in the model. If absent: trajectory if there are logs; else
  /// nonlinear if another family or a robust loss is requested; else log-linear.
  std::optional<Method> method = {};
  /// Error model of the nonlinear table fit. If it is absent, the error model follows from
  /// `method`. Nonlinear: an error of the time if every run was timed, else an error of the speed.
  /// Any other method: a relative error of the force.
  std::optional<ErrorModel> noise = {};
  FamilyChoice surge_family = {};
  FamilyChoice yaw_family = {};
  /// yaw_family as it is fitted: without a dead zone, which belongs to the motors. In tables, it is
  /// identified from the surge runs and subtracted from the forces of the turning runs.
  FamilyChoice fitted_yaw_family() const {
    FamilyChoice choice = yaw_family;
    if (choice.family) choice.family = without_dead_zone(*choice.family);
    return choice;
  }
  Loss loss = Loss::kSquared;
  /// Fits the surge law (coefficient a1, exponent b1) and the mass m' together to the surge rows
  /// and the coast-down curves, so that the curves also improve a1 and b1.
  bool joint = false;
  /// Parameters to identify. Empty: the parameters that the given trials measure.
  std::vector<ParameterId> requested = {};
  /// True if the user requested all parameters. Parameters that the vehicle lacks (the servo's time
  /// constant without steering) are then ignored. If false, a request for a parameter that the
  /// vehicle lacks is an input error.
  bool requested_all = false;
  /// Logs: names of further quantities to fit, from requestable_terms().
  std::vector<std::string> terms = {};
  std::vector<LogChannel> biases = {};  ///< logs: channels whose constant offset is fitted
  std::uint64_t seed = 1;               ///< seed of the multistart and of the bootstrap
  /// Logs: number of random initial guesses, >= 0, in addition to the one from the logs. Not used
  /// if tables or the vehicle file give the initial value of every fitted parameter.
  int starts = 6;
  int bootstrap = 0;  ///< logs: number of bootstrap resamples, e.g. 1000; 0: no bootstrap
  /// Logs: time limit of all searches together, s; 0: none. A fit that has not converged by then is
  /// refused. The number of integration steps has its own limit, also for 0.
  double time_limit_s = 0.0;
  /// Number of threads; 0: one per core. The result does not depend on it.
  int threads = 0;
  /// Tables: if false, only the requested estimator is used, without fits for comparison and
  /// without residual tests.
  bool side_by_side = true;
  bool keeps_outliers = false;  ///< tables: true keeps gross outliers (gross_outlier.h) in the fit
  /// Logs: called when a step of the fit begins, with a description of the step. For display only.
  std::function<void(std::string_view)> doing = {};
  /// Logs: called before a step that may take more than 10 s, with the reason. For display only.
  std::function<void(std::string_view)> notice = {};
};

}  // namespace awmr
