#include "awmr/identify/coastdown/stop_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/coastdown/derived.h"
#include "awmr/identify/tables/noise_average.h"
#include "awmr/identify/tables/profile.h"

namespace awmr {
namespace {

/// Range of the relative standard deviation s of a stop time. The lower end keeps a family whose
/// stop times agree by chance from an unlimited likelihood.
constexpr Interval kStopTimeErrors{0.005, 1.0};

/// Smallest weight of a family: a fifth of the probability outside one end of a 95 % interval.
/// Smaller weights hardly change the interval.
constexpr double kMinWeight = 0.005;

/// Orthonormal columns that are orthogonal to the vector of ones (Helmert matrix), n x (n - 1).
Eigen::MatrixXd contrasts(Eigen::Index n) {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, n - 1);
  for (Eigen::Index k = 1; k < n; ++k) {
    const double scale = 1.0 / std::sqrt(static_cast<double>(k * (k + 1)));
    p.col(k - 1).head(k).setConstant(scale);
    p(k, k - 1) = -static_cast<double>(k) * scale;
  }
  return p;
}

/// Logarithm of the mean of exp(x).
double log_mean_exp(const std::vector<double>& x) {
  const double largest = *std::ranges::max_element(x);
  double sum = 0.0;
  for (const double value : x) sum += std::exp(value - largest);
  return largest + std::log(sum / static_cast<double>(x.size()));
}

/// v_i and B_i of stop_families.h for each run. Empty if the vehicle never stops under `law`.
std::optional<std::pair<Eigen::VectorXd, Eigen::MatrixXd>> masses_by_run(
    const SteadyFit& law, const std::vector<StopTimeRow>& stops) {
  Eigen::VectorXd values(rows_of(stops));
  Eigen::MatrixXd slopes(rows_of(stops), rows_of(law.free));
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto mass = mass_from_stop_time(law, {stops[i]});
    if (!mass || !std::isfinite(mass->log_mass_norm) || !mass->by_surge.allFinite()) {
      return std::nullopt;
    }
    values(eigen_index(i)) = mass->log_mass_norm;
    slopes.row(eigen_index(i)) = mass->by_surge.transpose();
  }
  return std::pair{std::move(values), std::move(slopes)};
}

/// Logarithm of the likelihood of the stop times, up to a constant that is that of all families.
/// Empty if the vehicle never stops under `law`.
std::optional<double> log_likelihood(const SteadyFit& law, const std::vector<StopTimeRow>& stops) {
  constexpr int kSteps = 60;
  const auto runs = masses_by_run(law, stops);
  if (!runs) return std::nullopt;
  if (stops.size() < 2) return 0.0;
  const Eigen::MatrixXd p = contrasts(rows_of(stops));
  const Eigen::MatrixXd slopes = p.transpose() * runs->second;
  // With P'B C B'P = V diag(w) V', S has the eigenvalues s^2 + w.
  const SymmetricEigen by_law = symmetric_eigen(slopes * law.covariance * slopes.transpose());
  const Eigen::ArrayXd x = (by_law.vectors.transpose() * (p.transpose() * runs->first)).array();
  std::vector<double> logarithms;
  for (int k = 0; k <= kSteps; ++k) {
    const double s = kStopTimeErrors.lo * std::pow(kStopTimeErrors.hi / kStopTimeErrors.lo,
                                                   static_cast<double>(k) / kSteps);
    const Eigen::ArrayXd variance = by_law.values.array().max(0.0) + s * s;
    logarithms.push_back(-0.5 * (variance.log() + x.square() / variance).sum());
  }
  return log_mean_exp(logarithms);
}

/// m' under another family, as a distribution in the coordinates of the chosen family: the
/// alternatives `own`, each with this m' in place of its own.
std::vector<Posterior::Alternative> under_family(const FamilyOfStops& family,
                                                 std::vector<Posterior::Alternative> own,
                                                 const MassEstimate& mass) {
  const SteadyFit& law = family.candidate->fit;
  for (Posterior::Alternative& other : own) {
    const Eigen::Index last = other.centre.size() - 1;
    other.weight *= family.weight;
    other.centre(last) = mass.log_mass_norm;
    other.covariance.row(last).setZero();
    other.covariance.col(last).setZero();
    other.covariance(last, last) = *mass.variance(law);
    other.dof(last) = mass.dof(law);
    if (!Posterior{{other}}.is_proper(last)) return {};
  }
  return own;
}

/// True if the initial speeds differ enough for their stop times to tell families apart.
bool has_different_speeds(const std::vector<StopTimeRow>& stops) {
  constexpr double kMinRatio = 1.2;
  if (stops.empty()) return false;
  const auto [slow, fast] = std::ranges::minmax(stops, {}, &StopTimeRow::initial_speed_mps);
  return fast.initial_speed_mps >= kMinRatio * slow.initial_speed_mps;
}

std::string in_words(Family family, const MassEstimate& mass, double probability) {
  return fmt::format(
      ". With the family {}, whose probability is {:.2g}, mass_norm is {:.3g}; the "
      "interval takes both families into account",
      name_of(family), probability, std::exp(mass.log_mass_norm));
}

/// Scales the weights so that the first `own`, those of the chosen family, add up to `share`, and
/// all to 1. Raises the first weight, that of the reported value, to kMinOwnWeight.
void rescale(const std::vector<double*>& weights, std::size_t own, double share) {
  double others = 0.0;
  for (std::size_t k = own; k < weights.size(); ++k) others += *weights[k];
  for (std::size_t k = 0; k < weights.size(); ++k) {
    *weights[k] *= k < own ? share : (1.0 - share) / others;
  }
  const double rest = 1.0 - *weights.front();
  *weights.front() = raised_own_weight(*weights.front(), rest);
  const double sum = *weights.front() + rest;
  for (double* weight : weights) *weight /= sum;
}

/// Applies rescale() to the alternatives and to the reports of `result`. `own`: number of
/// alternatives, and of reports, of the chosen family.
void rescale(std::size_t own, double share, MassResult& result) {
  std::vector<double*> weights;
  for (Posterior::Alternative& k : result.posterior.alternatives) weights.push_back(&k.weight);
  rescale(weights, own, share);
  weights.clear();
  if (!result.reports.front().weight) result.reports.front().weight = 1.0;
  for (EstimatorReport& report : result.reports) weights.push_back(&*report.weight);
  rescale(weights, own, share);
}

}  // namespace

std::vector<FamilyOfStops> families_of_stops(const SubjectFit& surge,
                                             const std::vector<StopTimeRow>& stops) {
  std::vector<FamilyOfStops> families;
  if (stops.empty()) return families;
  for (const FamilyCandidate& candidate : surge.compared) {
    const auto score = aicc(candidate.fit);
    // A term at its bound 0 leaves a family that is already in the list.
    const bool is_known = score && candidate.fit.has_covariance() && candidate.fit.at_bound.empty();
    const auto likelihood = is_known ? log_likelihood(candidate.fit, stops) : std::nullopt;
    if (likelihood && std::isfinite(*likelihood)) {
      families.push_back({&candidate, *score - 2.0 * *likelihood, 0.0});
    } else if (&candidate == &surge.compared.front()) {
      return {};  // the chosen family
    }
  }
  if (families.empty()) return families;
  const double least = std::ranges::min_element(families, {}, &FamilyOfStops::score)->score;
  double sum = 0.0;
  for (FamilyOfStops& family : families) {
    family.weight = std::exp(-0.5 * (family.score - least));
    sum += family.weight;
  }
  for (FamilyOfStops& family : families) family.weight /= sum;
  families.front().weight = std::max(families.front().weight, kMinWeight);
  const auto rest = std::next(families.begin());
  families.erase(std::remove_if(rest, families.end(),
                                [](const FamilyOfStops& k) { return k.weight < kMinWeight; }),
                 families.end());
  return families;
}

std::optional<FamilyOfCurves> family_of_stops(const SubjectFit& surge,
                                              const std::vector<StopTimeRow>& stops) {
  if (!has_different_speeds(stops)) return std::nullopt;
  const std::vector<FamilyOfStops> families = families_of_stops(surge, stops);
  if (families.empty()) return std::nullopt;
  const auto best = std::ranges::min_element(families, {}, &FamilyOfStops::score);
  const double decrease = families.front().score - best->score;
  if (!(decrease > 0.0)) return std::nullopt;
  return FamilyOfCurves{best->candidate->problem.family, decrease};
}

void average_over_families(const SubjectFit& surge, const std::vector<StopTimeRow>& stops,
                           MassResult& result) {
  const std::vector<FamilyOfStops> families = families_of_stops(surge, stops);
  std::vector<Posterior::Alternative>& alternatives = result.posterior.alternatives;
  if (families.size() < 2 || alternatives.empty()) return;
  const std::vector<Posterior::Alternative> own = alternatives;
  double likeliest = 0.0;
  for (std::size_t k = 1; k < families.size(); ++k) {
    const FamilyCandidate& family = *families[k].candidate;
    const auto mass = mass_from_stop_time(family.fit, stops);
    if (!mass) continue;
    const MassEstimate estimate = from_stop_time(*mass, stops.size());
    const auto others = under_family(families[k], own, estimate);
    if (others.empty()) continue;
    alternatives.insert(alternatives.end(), others.begin(), others.end());
    result.reports.push_back(
        report_of(estimate, family.fit, Estimator::kStopTime,
                  fmt::format("time; surge: {}, {}", name_of(family.problem.noise),
                              name_of(family.problem.family))));
    result.reports.back().rows_used = static_cast<int>(stops.size());
    result.reports.back().weight = families[k].weight;
    if (families[k].weight < likeliest) continue;
    likeliest = families[k].weight;
    result.other_family = in_words(family.problem.family, estimate, likeliest);
  }
  if (alternatives.size() > own.size()) {
    rescale(own.size(), families.front().weight, result);
  }
}

}  // namespace awmr
