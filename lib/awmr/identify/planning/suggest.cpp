#include "awmr/identify/planning/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/planning/candidates.h"
#include "awmr/model/transform.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// Assumed standard error for a parameter without one, in its coordinate of model/transform.h. For
/// a logarithm, 2 means a factor of e^2 = 7.4. The value is large, so that trials that measure the
/// parameter rank high.
constexpr double kUnknownStd = 2.0;

/// Covariance of the n uncertain parameters, in the coordinates z of model/transform.h. With the
/// covariance C_pq of the parameters p and q,
///   Cov(z_p, z_q) = C_pq / (dp/dz_p dq/dz_q).
struct Uncertainty {
  std::vector<ParameterId> parameters;
  Eigen::MatrixXd covariance;  ///< n x n, positive definite
};

/// The model's covariance, with additional rows for estimated parameters that have none (except
/// terms of a family).
Uncertainty uncertainty_of(const Model& model) {
  const std::vector<ParameterId>& known = model.covariance.parameters;
  std::vector<ParameterId> ids = known;
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (parameter.term || !estimate.value || estimate.source == Source::kGiven) continue;
    const bool listed = std::find(known.begin(), known.end(), parameter.id) != known.end();
    if (!listed) ids.push_back(parameter.id);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows_of(ids), rows_of(ids));
  for (std::size_t i = 0; i < known.size(); ++i) {
    for (std::size_t j = 0; j < known.size(); ++j) {
      covariance(eigen_index(i), eigen_index(j)) =
          model.covariance.matrix[i][j] /
          (jacobian(ids[i], *model[ids[i]].value) * jacobian(ids[j], *model[ids[j]].value));
    }
  }
  for (std::size_t i = known.size(); i < ids.size(); ++i) {
    covariance(eigen_index(i), eigen_index(i)) = kUnknownStd * kUnknownStd;
  }
  // Standard deviation of a small independent error that is added to each coordinate. The yaw
  // inertia I'z from a coast-down is the mass m' times a constant, so the covariance is singular;
  // the added errors make it invertible. A trial that measures I'z can then improve I'z without m'.
  constexpr double kIndependentStd = 1e-4;
  covariance.diagonal().array() += kIndependentStd * kIndependentStd;
  return {std::move(ids), std::move(covariance)};
}

/// Parameters of the vehicle without a value, each with the trial that measures it.
std::vector<MissingParameter> missing_of(const Model& model) {
  std::vector<MissingParameter> missing;
  for (const ParameterInfo& parameter : parameter_table()) {
    if (model[parameter.id].value || !has(model.vehicle, parameter.id)) continue;
    missing.push_back({parameter.id, std::string(trial_of(model.vehicle, parameter.id))});
  }
  return missing;
}

/// Plant of the model with the coordinate of one parameter changed by `step`.
Plant<double> moved(Model model, ParameterId id, double step) {
  double& value = *model[id].value;
  value = scale_of(id) == Scale::kLinear ? value + step : value * std::exp(step);
  return model.plant_as_known();
}

/// Computes the derivatives of the numbers `values_at(plant)` with respect to the coordinates of
/// the parameters `ids` (model/transform.h), by central differences: one row per number, one column
/// per parameter. The backward step is limited so that no term of a resistance becomes negative.
template <class Values>
Eigen::MatrixXd jacobian_of(const Model& model, const std::vector<ParameterId>& ids,
                            const Values& values_at) {
  constexpr double kStep = 1e-4;
  Eigen::MatrixXd result;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double back = info(ids[i]).term ? std::min(kStep, *model[ids[i]].value) : kStep;
    const std::vector<double> high = values_at(moved(model, ids[i], kStep));
    const std::vector<double> low = values_at(moved(model, ids[i], -back));
    if (i == 0) result.resize(rows_of(high), rows_of(ids));
    for (std::size_t row = 0; row < high.size(); ++row) {
      result(eigen_index(row), eigen_index(i)) = (high[row] - low[row]) / (kStep + back);
    }
  }
  return result;
}

/// Target of the ranking: m linear combinations of the n parameter coordinates. The standard error
/// of the target is the root of the sum of the variances of these combinations, times `scale`.
struct Target {
  Eigen::MatrixXd gradient;  ///< m x n: each row has the coefficients of one combination
  double scale = 1.0;        ///< converts the standard error to the unit of the target
  std::string name;          ///< SuggestedTrial::parameter
  std::string criterion;     ///< description of the target

  double std_error(const Eigen::MatrixXd& covariance) const {
    return scale * std::sqrt((gradient * covariance * gradient.transpose()).trace());
  }
};

/// Reference for the error of a resistance term, which may itself be 0: the whole resistance, with
/// all its terms, at 1 m/s or 1 rad/s. For a term of a single wheel (dead zone, back-EMF), this
/// resistance is divided by the number of driven wheels.
double whole_of(ParameterId id, const Plant<double>& plant) {
  if (id == ParameterId::kYawCoulomb || id == ParameterId::kYawQuadratic) return plant.yaw(1.0);
  const bool of_a_wheel = id == ParameterId::kWheelDeadZone || id == ParameterId::kBackEmf;
  return plant.surge(1.0) / (of_a_wheel ? driven_wheels(plant) : 1.0);
}

/// Target of A-optimality: all parameters with equal weights. Their errors are relative (parameters
/// whose coordinate is a logarithm), absolute (exponents) or relative to whole_of() (terms).
Target all_parameters(const std::vector<ParameterId>& ids, const Plant<double>& plant) {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Identity(rows_of(ids), rows_of(ids));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (info(ids[i]).term) gradient(eigen_index(i), eigen_index(i)) /= whole_of(ids[i], plant);
  }
  return {
      .gradient = std::move(gradient),
      .name = "all (relative)",
      .criterion = "A-optimal: root sum of the squared relative standard errors of all parameters"};
}

tl::unexpected<Error> unknown_target(const std::vector<ParameterId>& ids,
                                     const SuggestOptions& options) {
  std::string names;
  for (const ParameterId known : ids) names += fmt::format("{} ", info(known).name);
  for (const SuggestTarget& metric : options.metrics) names += metric.name + " ";
  return input_error(ErrorCode::kUnknownName, option_text("parameter"),
                     fmt::format("'{}' is not an uncertain parameter of this model or a metric; "
                                 "choose one of: {}",
                                 options.parameter, names));
}

Result<Target> target_of(const Model& model, const Plant<double>& plant,
                         const std::vector<ParameterId>& ids, const SuggestOptions& options) {
  if (options.parameter.empty()) return all_parameters(ids, plant);
  for (const SuggestTarget& metric : options.metrics) {
    if (metric.name != options.parameter) continue;
    return Target{
        .gradient = jacobian_of(
            model, ids, [&](const Plant<double>& p) { return std::vector{metric.value(p)}; }),
        .name = metric.name,
        .criterion = fmt::format("standard error of the closed loop's {}", metric.name)};
  }
  const auto id = parameter_by_name(options.parameter);
  if (id && !model[*id].value) {
    return input_error(ErrorCode::kNotIdentified,
                       fmt::format("{}:{}", model.file, info(*id).pointer),
                       fmt::format("{} has no value yet, so trials cannot be ranked by it; record "
                                   "{}",
                                   options.parameter, trial_of(model.vehicle, *id)));
  }
  const auto place = id ? std::find(ids.begin(), ids.end(), *id) : ids.end();
  if (place == ids.end()) return unknown_target(ids, options);
  Target target{.gradient = Eigen::MatrixXd::Zero(1, rows_of(ids)),
                .scale = jacobian(*id, *model[*id].value),
                .name = options.parameter,
                .criterion = fmt::format("standard error of {}", options.parameter)};
  target.gradient(0, place - ids.begin()) = 1.0;
  return target;
}

double log_determinant(const Eigen::MatrixXd& covariance) {
  return symmetric_eigen(covariance).values.array().max(1e-300).log().sum();
}

/// Computes C_after as suggest() in suggest.h describes. Here W = 1, because each measurement is
/// divided by its standard deviation.
SuggestedTrial evaluate(const CandidateTrial& candidate, const Model& model,
                        const Uncertainty& uncertainty, const Target& target) {
  const Eigen::MatrixXd j = jacobian_of(model, uncertainty.parameters, candidate.standardised);
  const Eigen::MatrixXd& before = uncertainty.covariance;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(before.rows(), before.rows());
  const Eigen::MatrixXd information = solve_ldlt(before, identity);
  const Eigen::MatrixXd after = solve_ldlt(information + j.transpose() * j, identity);
  SuggestedTrial trial = candidate.trial;
  trial.parameter = target.name;
  trial.std_error_before = target.std_error(before);
  trial.std_error_after = target.std_error(after);
  trial.d_gain = log_determinant(before) - log_determinant(after);
  return trial;
}

/// Sorts by the standard error of the target, smallest first; if equal, by d_gain, largest first.
void sort_by_promise(std::vector<SuggestedTrial>& trials) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const SuggestedTrial& a, const SuggestedTrial& b) {
                     if (a.std_error_after != b.std_error_after) {
                       return a.std_error_after < b.std_error_after;
                     }
                     return a.d_gain > b.d_gain;
                   });
}

}  // namespace

Result<Suggestion> suggest(const Model& model, const SuggestOptions& options) {
  const Uncertainty uncertainty = uncertainty_of(model);
  std::vector<MissingParameter> missing = missing_of(model);
  if (uncertainty.parameters.empty() && missing.empty()) {
    return input_error(ErrorCode::kNotIdentified, model.file + ":/covariance",
                       "no parameter has a standard error that a trial could reduce; identify the "
                       "model from trials first");
  }
  AWMR_ASSIGN_OR_RETURN(const Target target,
                        target_of(model, model.plant_as_known(), uncertainty.parameters, options));
  ScrubPlan scrub = scrub_plan(model);
  Suggestion suggestion{.criterion = target.criterion,
                        .missing = std::move(missing),
                        .trials = {},
                        .scrub_turns = scrub.turns,
                        .about_scrub = scrub.about,
                        .assumptions = assumptions_of(model, options),
                        .coasting = coasting_turn(model)};
  if (uncertainty.parameters.empty()) return suggestion;
  if (model.simulated_motion() == Motion::kPlanar) {
    AWMR_RETURN_IF_ERROR(check_replay(model.plant_as_known(), model.file));
  }
  for (const CandidateTrial& candidate : candidates_of(model, options)) {
    suggestion.trials.push_back(evaluate(candidate, model, uncertainty, target));
    const SuggestedTrial& trial = suggestion.trials.back();
    if (std::isfinite(trial.std_error_before) && std::isfinite(trial.std_error_after) &&
        std::isfinite(trial.d_gain)) {
      continue;
    }
    return input_error(ErrorCode::kOutOfRange, model.file,
                       fmt::format("the effect of trial '{}' on the standard errors is not "
                                   "finite at this model's values; check the exponents, the "
                                   "mass and the resistance in the model",
                                   trial.settings));
  }
  sort_by_promise(suggestion.trials);
  return suggestion;
}

}  // namespace awmr
