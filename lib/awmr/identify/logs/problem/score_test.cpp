#include "awmr/identify/logs/problem/score_test.h"

#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/logs/problem/information.h"

namespace awmr {
namespace {

/// Score test of one candidate. `h`: information of the quantities t of the fit and of all
/// candidates; `c`: index of the candidate in `h`; `by_others`: H_tt^-1 H_tc.
ScoreTest test_one(const Eigen::MatrixXd& h, const std::vector<Eigen::VectorXd>& scores,
                   const Eigen::VectorXd& by_others, Eigen::Index c) {
  const Eigen::Index n = by_others.size();
  const double information = h(c, c) - h.col(c).head(n).dot(by_others);
  ScoreTest test;
  if (!(information > 1e-12 * h(c, c)) || !(h(c, c) > 0.0)) return test;
  double sum = 0.0;
  double squares = 0.0;
  for (const Eigen::VectorXd& score : scores) {
    const double own = score(c) - by_others.dot(score.head(n));
    sum += own;
    squares += own * own;
  }
  test.value = -sum / information;
  test.noise_error = 1.0 / std::sqrt(information);
  test.std_error = std::max(test.noise_error, std::sqrt(squares) / information);
  test.gain = std::pow(test.value / test.std_error, 2);
  return test;
}

}  // namespace

LogProblem with_white_noise(LogProblem problem) {
  for (auto& [sensor, noise] : problem.model.noise) {
    if (noise.differenced > 0.0) continue;  // has no drift
    noise.white_std = noise.std();
    noise.drift_std = 0.0;
    noise.correlation_s = noise.frequency_radps = noise.damping = 0.0;
  }
  return problem;
}

Extended extended(LogProblem problem, SearchPoint point, const std::vector<FreeQuantity>& more,
                  const std::vector<double>& begin) {
  const std::vector<Interval> bounds = coordinate_bounds(more, begin, problem.model.vehicle);
  for (std::size_t i = 0; i < more.size(); ++i) {
    problem.model.quantities.push_back(more[i]);
    problem.initial.push_back(begin[i]);
    problem.bounds.push_back(bounds[i]);
    point.coordinates.push_back(begin[i]);
  }
  return {std::move(problem), std::move(point)};
}

std::vector<ScoreTest> score_test(const LogProblem& problem, const SearchPoint& point,
                                  const std::vector<FreeQuantity>& candidates) {
  std::vector<ScoreTest> tests(candidates.size());
  if (candidates.empty()) return tests;
  const Extended with = extended(with_white_noise(problem), point, candidates,
                                 std::vector<double>(candidates.size(), 0.0));
  const double block_s = block_length_s(problem.model.noise);
  const std::vector<WindowSums> sums = sums_at(with.problem, with.point, block_s);
  if (!all_finite(sums)) return tests;
  const Eigen::Index n = rows_of(problem.model.quantities);
  const Eigen::Index all = rows_of(with.problem.model.quantities);
  const Eigen::MatrixXd h = fit_evidence(sums, all).information;
  const std::vector<Eigen::VectorXd> scores = scores_of(with.problem.windows, sums, all).blocks;
  // H_tt, the information of the quantities of the fit, includes the weak prior of the search. This
  // keeps H_tt regular even if the data do not determine a quantity.
  Eigen::MatrixXd of_others = h.topLeftCorner(n, n);
  of_others.diagonal().array() += 1.0 / (kPriorStd * kPriorStd);
  const Eigen::MatrixXd by_others = solve_ldlt(of_others, h.topRightCorner(n, all - n));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    tests[i] = test_one(h, scores, by_others.col(eigen_index(i)), n + eigen_index(i));
  }
  return tests;
}

}  // namespace awmr
