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

  const Eigen::Index n = rows_of(quantities);
  const Identifiability found =
      without_stopped(identifiability(information(residuals, n), quantities), problem, coordinates);
  std::vector<Interval> bootstrap95;
  if (options.bootstrap > 0) {
    const double block_s = block_length_s(problem.model.noise);
    const auto scores = block_scores(problem.windows, residuals, n, block_s);
    bootstrap95 = block_bootstrap({quantities, coordinates, found.covariance, scores},
                                  {.resamples = options.bootstrap, .seed = options.seed});
  }

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
