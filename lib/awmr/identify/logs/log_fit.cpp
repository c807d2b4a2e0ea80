#include "awmr/identify/logs/log_fit.h"

#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/bootstrap.h"
#include "awmr/identify/logs/information.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/logs/multistart.h"
#include "awmr/identify/logs/noise_iteration.h"

namespace awmr {
namespace {

/// The last search ends where a step changes the cost by less than this share. The cost is about
/// half the number of samples, and a step of d standard errors changes it by d^2/2: with 100 000
/// samples, the last step is shorter than a hundredth of a standard error.
constexpr double kFine = 1e-9;

LogFit without_solution(std::string why, std::vector<SearchStart> starts) {
  LogFit fit;
  fit.report.stop_reason = std::move(why);
  fit.report.starts = std::move(starts);
  return fit;
}

/// A 95 % interval for each quantity; empty where no bootstrap was asked for.
std::vector<Interval> bootstrap_intervals(const LogProblem& problem,
                                          const std::vector<double>& coordinates,
                                          const std::vector<WindowResiduals>& residuals,
                                          const Eigen::MatrixXd& covariance,
                                          const LogFitOptions& options) {
  if (options.bootstrap <= 0) return {};
  const double block_s = block_length_s(problem.model.noise);
  const auto scores = block_scores(problem.windows, residuals, covariance.rows(), block_s);
  return block_bootstrap({problem.model.quantities, coordinates, covariance, scores},
                         {.resamples = options.bootstrap, .seed = options.seed});
}

}  // namespace

LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  const LogProblem guess = log_problem(logs, options);
  if (guess.windows.empty() || guess.initial.empty()) {
    return without_solution("nothing measured, or nothing asked for", {});
  }
  const Multistart search = multistart(guess, options);
  if (search.coordinates.empty()) {
    return without_solution("no start led anywhere: every one left the finite numbers",
                            search.starts);
  }

  const NoiseIteration settled =
      settle_noise(guess, from_measured(guess, search.coordinates), options.loss);
  const LogProblem& problem = settled.problem;
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const Solved solved = solve(problem, settled.point, kFine);
  const std::vector<double>& coordinates = solved.point.coordinates;
  const std::vector<WindowResiduals> residuals = evaluate_all(problem, solved.point, true);

  if (!all_finite(residuals)) {
    return without_solution("failed: the logs cannot be replayed where the search ended",
                            search.starts);
  }
  const Eigen::Index n = rows_of(quantities);
  const Identifiability found =
      without_stopped(identifiability(information(residuals, n), quantities), problem, coordinates);
  const std::vector<Interval> bootstrap95 =
      bootstrap_intervals(problem, coordinates, residuals, found.covariance, options);

  EstimatorReport report = log_report({problem, solved, residuals, found, bootstrap95});
  report.starts = search.starts;
  return {quantities,
          coordinates,
          found.covariance,
          found.why_not,
          problem.model.noise,
          akaike(problem.model.noise, n),
          report,
          solved.usable && solved.converged};
}

}  // namespace awmr
