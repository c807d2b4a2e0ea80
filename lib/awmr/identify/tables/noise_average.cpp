#include "awmr/identify/tables/noise_average.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"

namespace awmr {
namespace {

/// |d e/d ln w| of one run; see noise_average.h.
double residual_by_log_rate(ErrorModel noise, const SteadyFit& fit, const SteadyPoint& point) {
  const Resistance<double> law = fit.law();
  const double w = point.rate;
  // w g'(w) of g = c + alpha w^beta + q w^2
  const double rise = law.alpha * law.beta * std::pow(w, law.beta) + 2.0 * law.quadratic * w * w;
  switch (noise) {
    case ErrorModel::kForce:
      return rise;
    case ErrorModel::kSpeed:
      return w;
    case ErrorModel::kTime:
      return *point.elapsed_s;
    case ErrorModel::kLogForce:
      return rise / (law.at(w) + fit[TransformedParameter::kDeadZone]);
  }
  return w;
}

/// Logarithm of the probability of one error model, up to a constant: ln p_k in noise_average.h.
double log_evidence(const std::vector<SteadyPoint>& points, ErrorModel noise,
                    const SteadyFit& fit) {
  double sum = -static_cast<double>(points.size()) * std::log(fit.residual_std) +
               0.5 * symmetric_eigenvalues(fit.covariance).array().log().sum();
  for (const SteadyPoint& point : points) {
    sum += std::log(residual_by_log_rate(noise, fit, point));
  }
  return sum;
}

bool has_evidence(const SteadyFit& fit) {
  return fit.usable && fit.has_covariance() && fit.residual_std > 0.0;
}

/// Sets the weights from their unnormalised logarithms. Raises the weight of the first alternative,
/// the chosen fit, to kMinOwnWeight. Removes alternatives with weight 0.
void normalise(std::vector<NoiseAlternative>& alternatives, const std::vector<double>& logarithms) {
  const double largest = *std::max_element(logarithms.begin(), logarithms.end());
  double others = 0.0;
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    alternatives[k].weight = std::exp(logarithms[k] - largest);
    if (k > 0) others += alternatives[k].weight;
  }
  const double own = raised_own_weight(alternatives.front().weight, others);
  alternatives.front().weight = own;
  for (NoiseAlternative& alternative : alternatives) alternative.weight /= own + others;
  std::erase_if(alternatives, [](const NoiseAlternative& a) { return !(a.weight > 0.0); });
}

}  // namespace

std::vector<NoiseAlternative> noise_alternatives(const Subject& subject,
                                                 const SubjectOptions& options,
                                                 const SteadyProblem& problem,
                                                 const SteadyFit& chosen,
                                                 const std::vector<FamilyCandidate>& candidates) {
  std::vector<NoiseAlternative> alternatives{{problem.noise, chosen, 1.0}};
  if (options.knows_noise || options.loss != Loss::kSquared || !has_evidence(chosen)) {
    return alternatives;
  }
  const bool is_expected = problem.noise == ErrorModel::kTime && only_timed(subject.points);
  const double own = log_evidence(subject.points, problem.noise, chosen) +
                     (is_expected ? std::log(kTimedOdds) : 0.0);
  if (!std::isfinite(own)) return alternatives;
  std::vector<double> logarithms{own};
  for (const ErrorModel noise :
       {ErrorModel::kLogForce, ErrorModel::kForce, ErrorModel::kSpeed, ErrorModel::kTime}) {
    if (noise == problem.noise) continue;
    if (noise == ErrorModel::kTime && !all_timed(subject.points)) continue;
    SteadyProblem other = problem;
    other.noise = noise;
    const FamilyCandidate* fitted = candidate_of(candidates, problem.family, noise);
    SteadyFit fit = fitted ? fitted->fit : fit_steady(other, chosen.theta);
    if (!has_evidence(fit) || fit.free != chosen.free) continue;
    const double evidence = log_evidence(subject.points, noise, fit);
    if (!std::isfinite(evidence)) continue;
    logarithms.push_back(evidence);
    alternatives.push_back({noise, std::move(fit), 0.0});
  }
  normalise(alternatives, logarithms);
  return alternatives;
}

Posterior posterior_of(const std::vector<NoiseAlternative>& alternatives) {
  Posterior posterior;
  for (const NoiseAlternative& k : alternatives) {
    if (!k.fit.has_covariance()) return {};
    const Eigen::Index n = rows_of(k.fit.free);
    Eigen::VectorXd centre(n);
    for (Eigen::Index i = 0; i < n; ++i) centre(i) = k.fit[k.fit.free[at(i)]];
    posterior.alternatives.push_back(
        {k.weight, std::move(centre), k.fit.covariance,
         Eigen::VectorXd::Constant(n, static_cast<double>(k.fit.degrees_of_freedom))});
  }
  return posterior;
}

}  // namespace awmr
