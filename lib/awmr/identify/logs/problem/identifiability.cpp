#include "awmr/identify/logs/problem/identifiability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/linear_algebra.h"

namespace awmr {
namespace {

/// Largest standard error of an identified quantity, in units of FreeQuantity::large_change.
///
/// The limit is lower for the sway resistance a_s: 1/a_s has to be at least 4 standard errors from
/// 0. Reason: the logs measure 1/a_s, because the lateral speed in turns is about v = m' r u/a_s
/// (m': mass, r: yaw rate, u: speed). The standard error of ln a_s is a_s times that of 1/a_s.
/// Noise that makes a_s too small thus also makes this standard error too small, and the limit of
/// the other quantities would accept such values too often.
double unknown_from(const FreeQuantity& q) {
  constexpr double kUnknownReciprocal = 0.25;
  return q.is(ParameterId::kSwayAlpha) ? kUnknownReciprocal : kUnknown;
}

/// States how uncertain a quantity is. `std`: its standard error, in large changes
/// (FreeQuantity::large_change). `unknown`: largest accepted `std`.
std::string uncertainty_text(double std, double unknown = kUnknown) {
  if (!std::isfinite(std) || std > 1e3) return "no measurement depends on it";
  return fmt::format("the standard error is {:.2g} times the accepted limit", std / unknown);
}

/// Refuses every quantity with a considerable part in a direction that the logs do not determine.
/// `direction`: unit vector in the space of the coordinates. `std`: standard error along it.
void refuse_direction(const Eigen::VectorXd& direction, double std,
                      const std::vector<FreeQuantity>& quantities,
                      std::vector<std::string>& refusal_reason) {
  // Smallest share of the direction's squared length for which a quantity is refused.
  constexpr double kPart = 0.1;
  std::vector<std::size_t> parts;
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (direction(i) * direction(i) < kPart) continue;
    parts.push_back(at(i));
    names.push_back(quantities[at(i)].name());
  }
  const std::string why = names.size() == 1
                              ? "these logs do not determine it: " + uncertainty_text(std)
                              : fmt::format("these logs determine only a combination of {}: {}",
                                            fmt::join(names, ", "), uncertainty_text(std));
  for (const std::size_t i : parts) refusal_reason[i] = why;
}

/// True if the search stopped at an end of the quantity's range that is not a plausible value.
/// Plausible are the end 0 of a delay, a lag or a term of a resistance family, and both ends of a
/// quantity that only describes the form of a force, such as the sharpness of a saturation
/// (FreeQuantity::is_form()).
bool stopped(const FreeQuantity& q, double coordinate, const Interval& bounds) {
  if (q.is_form()) return false;
  if (q.may_be_zero()) return coordinate >= bounds.hi;
  const bool term = q.kind == FreeQuantity::Kind::kParameter && info(q.id).term;
  if (term && coordinate == bounds.lo) return false;
  return coordinate <= bounds.lo || coordinate >= bounds.hi;
}

/// Variances of the coordinates by the scatter of the scores: the diagonal of V
/// (identifiability()), with C = `covariance`.
Eigen::VectorXd variances_by_scatter(const Eigen::MatrixXd& covariance,
                                     const std::vector<Eigen::VectorXd>& scores) {
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(covariance.rows());
  for (const Eigen::VectorXd& score : scores) variances += (covariance * score).cwiseAbs2();
  const double m = static_cast<double>(scores.size());
  return m / (m - 1.0) * variances;
}

/// Raises the factors of the standard errors according to `scores`, the scores of parts of the logs
/// (blocks of some seconds, or whole logs). Raises a factor only if the variance by their scatter
/// exceeds `allowed` times the variance by the noise model.
void note_scatter(const std::vector<Eigen::VectorXd>& scores, double allowed,
                  Identifiability& found) {
  if (scores.size() < 2) return;
  const Eigen::VectorXd scatter = variances_by_scatter(found.covariance, scores);
  for (Eigen::Index i = 0; i < scatter.size(); ++i) {
    const double ratio = scatter(i) / found.covariance(i, i);
    if (!(ratio > allowed) || !(std::sqrt(ratio) > found.factor[at(i)])) continue;
    found.factor[at(i)] = std::sqrt(ratio);
    found.degrees_of_freedom[at(i)] = static_cast<double>(scores.size() - 1);
  }
}

/// Raises standard errors to those by the scatter of the scores, see identifiability().
void widen(const Scores& scores, Identifiability& found) {
  // Practically infinite: Student's t then equals the normal distribution.
  constexpr double kManyDegrees = 1e6;
  constexpr std::size_t kEnoughLogs = 3;
  found.degrees_of_freedom.assign(at(found.covariance.rows()), kManyDegrees);
  found.factor.assign(at(found.covariance.rows()), 1.0);
  note_scatter(scores.blocks, 1.0, found);
  if (scores.logs.size() >= kEnoughLogs) {
    const double degrees = static_cast<double>(scores.logs.size() - 1);
    note_scatter(scores.logs, chi_squared_quantile(0.95, degrees) / degrees, found);
  }
  const Eigen::Map<const Eigen::VectorXd> factor(found.factor.data(), rows_of(found.factor));
  found.covariance = factor.asDiagonal() * found.covariance * factor.asDiagonal();
}

/// Refuses all quantities whose correlation with the quantity `stopped` exceeds kDependent in
/// magnitude. `stopped`: index of a quantity whose search ended at an end of its range.
void refuse_dependent(Eigen::Index stopped, const std::vector<FreeQuantity>& quantities,
                      Identifiability& found) {
  constexpr double kDependent = 0.3;  // smallest correlation for which a quantity is refused
  const Eigen::MatrixXd& c = found.covariance;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const double correlation = c(i, stopped) / std::sqrt(c(i, i) * c(stopped, stopped));
    if (i == stopped || !found.refusal_reason[at(i)].empty() ||
        !(std::abs(correlation) > kDependent))
      continue;
    found.refusal_reason[at(i)] = fmt::format(
        "it depends on {} (correlation {:.2f}), whose search ended at a limit of the accepted "
        "range",
        quantities[at(stopped)].name(), correlation);
  }
}

std::string why_stopped(const FreeQuantity& q, double coordinate) {
  std::string why =
      fmt::format("the search ended at {:.4g}, a limit of the accepted range", q.value(coordinate));
  if (q.is(ParameterId::kSurgeBeta)) why += "; widen surge_beta_range in the vehicle file";
  if (q.is(ParameterId::kYawBeta)) why += "; widen yaw_beta_range in the vehicle file";
  return why;
}

/// Refuses the coefficient of a resistance of which another term is refused, and the exponent of a
/// refused coefficient.
void refuse_rest_of_resistance(const std::vector<FreeQuantity>& quantities,
                               Identifiability& found) {
  constexpr std::pair<ParameterId, ParameterId> kDependents[] = {
      {ParameterId::kSurgeAlpha, ParameterId::kSurgeCoulomb},
      {ParameterId::kSurgeAlpha, ParameterId::kSurgeQuadratic},
      {ParameterId::kSurgeAlpha, ParameterId::kWheelDeadZone},
      {ParameterId::kYawAlpha, ParameterId::kYawCoulomb},
      {ParameterId::kYawAlpha, ParameterId::kYawQuadratic},
      {ParameterId::kSurgeBeta, ParameterId::kSurgeAlpha},
      {ParameterId::kYawBeta, ParameterId::kYawAlpha}};
  for (const auto& [dependent, cause] : kDependents) {
    const auto place = place_of(quantities, dependent);
    const auto cause_place = place_of(quantities, cause);
    if (!place || !cause_place) continue;
    std::string& why = found.refusal_reason[*place];
    const std::string& why_cause = found.refusal_reason[*cause_place];
    if (!why.empty() || why_cause.empty()) continue;
    const bool is_exponent =
        dependent == ParameterId::kSurgeBeta || dependent == ParameterId::kYawBeta;
    why = fmt::format("{} is not determined, and {}", info(cause).name,
                      is_exponent ? "the exponent has no meaning without it"
                                  : "the resistance needs it: " + why_cause);
  }
}

/// Refuses the Coulomb friction or quadratic coefficient of a resistance whose coefficient alpha is
/// refused, if it is below two standard errors. A friction that held the vehicle at rest is known
/// only from below, and its interval around a small value would be wrong.
void refuse_insignificant_rest(const std::vector<FreeQuantity>& quantities,
                               const std::vector<double>& coordinates, Identifiability& found) {
  constexpr double kErrors = 2.0;
  constexpr std::pair<ParameterId, ParameterId> kTerms[] = {
      {ParameterId::kSurgeCoulomb, ParameterId::kSurgeAlpha},
      {ParameterId::kSurgeQuadratic, ParameterId::kSurgeAlpha},
      {ParameterId::kYawCoulomb, ParameterId::kYawAlpha},
      {ParameterId::kYawQuadratic, ParameterId::kYawAlpha}};
  for (const auto& [term, alpha] : kTerms) {
    const auto place = place_of(quantities, term);
    const auto alpha_place = place_of(quantities, alpha);
    if (!place || !alpha_place || found.refusal_reason[*alpha_place].empty()) continue;
    const FreeQuantity& q = quantities[*place];
    const Eigen::Index i = eigen_index(*place);
    const double error = q.jacobian(coordinates[*place]) * std::sqrt(found.covariance(i, i));
    std::string& why = found.refusal_reason[*place];
    if (!why.empty() || q.value(coordinates[*place]) > kErrors * error) continue;
    why = fmt::format("{} is not determined, and without it this value is not significant",
                      info(alpha).name);
  }
}

}  // namespace

Identifiability identifiability(const Eigen::MatrixXd& information, const Scores& scores,
                                const std::vector<FreeQuantity>& quantities) {
  // Information of the search's weak prior, which has a standard deviation of kPriorStd large
  // changes.
  constexpr double kPrior = 1.0 / (kPriorStd * kPriorStd);
  constexpr double kNull = 1e-12;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::Index n = rows_of(quantities);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale(i) = quantities[at(i)].large_change;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  const Eigen::VectorXd& values = eigen.values;
  const double largest = values(n - 1);
  Identifiability found;
  found.condition_number = values(0) > 0.0 ? std::sqrt(largest / values(0)) : kInfinity;
  found.refusal_reason.resize(at(n));
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index d = 0; d < n; ++d) {
    const double shown = values(d) > kNull * largest ? values(d) : 0.0;
    const Eigen::VectorXd direction = eigen.vectors.col(d);
    inverse += direction * direction.transpose() / (shown + kPrior);
    const double std = 1.0 / std::sqrt(shown);
    if (std < kUnknown) {
      ++found.rank;
    } else {
      refuse_direction(direction, std, quantities, found.refusal_reason);
    }
  }
  found.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  widen(scores, found);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double std = std::sqrt(found.covariance(i, i)) / scale(i);
    std::string& refusal_reason = found.refusal_reason[at(i)];
    const double unknown = unknown_from(quantities[at(i)]);
    if (refusal_reason.empty() && std > unknown) {
      refusal_reason = "these logs do not determine it: " + uncertainty_text(std, unknown);
    }
  }
  return found;
}

Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!stopped(quantities[i], coordinates[i], problem.bounds[i])) continue;
    found.refusal_reason[i] = why_stopped(quantities[i], coordinates[i]);
    refuse_dependent(eigen_index(i), quantities, found);
  }
  refuse_insignificant_rest(quantities, coordinates, found);
  refuse_rest_of_resistance(quantities, found);
  return found;
}

}  // namespace awmr
