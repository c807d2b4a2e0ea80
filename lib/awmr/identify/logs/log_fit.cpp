#include "awmr/identify/logs/log_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/random.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/identify/logs/choice/changes_between_rows.h"
#include "awmr/identify/logs/choice/delays.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/logs/problem/information.h"
#include "awmr/identify/logs/problem/log_problem.h"
#include "awmr/identify/logs/problem/multistart.h"
#include "awmr/identify/logs/problem/noise_iteration.h"
#include "awmr/identify/logs/problem/score_test.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// The final search ends when a step changes the cost by less than this (relative). The cost is
/// about half the number of samples, and a step of d standard errors changes it by d^2/2. With 100
/// 000 samples, the last step is therefore shorter than 0.01 standard errors.
constexpr double kFine = 1e-9;

/// Largest number of rough optima of the multistart from which the final search may start, best
/// first. The next one is tried only if the simulation of the logs diverges where the search ends.
constexpr std::size_t kTries = 3;

LogFit without_solution(std::string why, std::vector<SearchStart> starts) {
  LogFit fit;
  fit.report.stop_reason = std::move(why);
  fit.report.starts = std::move(starts);
  return fit;
}

/// For each candidate term, the decrease of -2 ln L that a score test predicts for a fit that also
/// estimates it. 0 for a term that the fit estimates already.
std::vector<double> candidate_gains(const LogProblem& problem, const SearchPoint& point,
                                    const std::vector<ParameterId>& candidate_terms) {
  std::vector<FreeQuantity> terms;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < candidate_terms.size(); ++i) {
    if (place_of(problem.model.quantities, candidate_terms[i])) continue;
    terms.push_back(free_parameter(candidate_terms[i]));
    places.push_back(i);
  }
  std::vector<double> gains(candidate_terms.size(), 0.0);
  const std::vector<ScoreTest> tests = score_test(problem, point, terms);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    // A term cannot be negative, so an estimate below 0 gives no gain.
    if (tests[i].value > 0.0) gains[places[i]] = tests[i].gain;
  }
  return gains;
}

/// Mean square of the errors, each divided by the standard deviation of its sensor in `guess`.
double relative_error_of(const LogProblem& guess, const ErrorsBySensor& errors) {
  double sum = 0.0;
  for (const auto& [sensor, parts] : errors) {
    const double std = sensor_in(guess.model.noise, sensor.channel, sensor.log).second.std();
    for (const ErrorSeries& part : parts) {
      for (const double error : part.error) sum += error * error / (std * std);
    }
  }
  return sum / guess.readings();
}

/// Solution of a log fit with n quantities, its covariance (n x n), and the scores of the blocks
/// into which the logs are divided (gradients of -ln L with respect to the n quantities).
struct BootstrapInput {
  const std::vector<FreeQuantity>& quantities;
  const std::vector<double>& coordinates;
  const Eigen::MatrixXd& covariance;
  const std::vector<Eigen::VectorXd>& scores;
};

Eigen::VectorXd mean_of(const std::vector<Eigen::VectorXd>& scores, Eigen::Index n) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  for (const Eigen::VectorXd& score : scores) mean += score / static_cast<double>(scores.size());
  return mean;
}

/// Sum of n scores drawn with replacement from the n scores, less n times their mean.
Eigen::VectorXd drawn_sum(const std::vector<Eigen::VectorXd>& scores, const Eigen::VectorXd& mean,
                          Random& random) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mean.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double place = random.uniform() * static_cast<double>(scores.size());
    sum += scores[static_cast<std::size_t>(place)] - mean;
  }
  return sum;
}

/// Factor by which to scale the draws so that their standard deviation becomes `std`. The mean of
/// the draws is 0. Returns 1 if all draws are 0.
double scale_to(double std, const std::vector<double>& draws) {
  double squares = 0.0;
  for (const double draw : draws) squares += draw * draw;
  return squares > 0.0 ? std / std::sqrt(squares / static_cast<double>(draws.size())) : 1.0;
}

/// Computes 95 % intervals by a block bootstrap. Each resample draws blocks with replacement and
/// makes one Gauss-Newton step from the solution. The steps are scaled to the standard errors of
/// the covariance, so the bootstrap determines only the shape of the intervals, not their width.
/// The ends are the 2.5 % and 97.5 % percentiles of each quantity's value. The changes by a few
/// resamples may all have the same sign; the interval then ends at the value. Empty for 0
/// resamples.
std::vector<Interval> block_bootstrap(const BootstrapInput& input, int resamples,
                                      std::uint64_t seed) {
  if (resamples <= 0) return {};
  const std::size_t n = input.quantities.size();
  std::vector<std::vector<double>> draws(n);  // draws[i]: change of coordinate i in each resample
  Random random(seed, 2);
  const Eigen::VectorXd mean = mean_of(input.scores, eigen_index(n));
  for (int b = 0; b < resamples; ++b) {
    const Eigen::VectorXd step = input.covariance * drawn_sum(input.scores, mean, random);
    for (std::size_t i = 0; i < n; ++i) draws[i].push_back(step(eigen_index(i)));
  }
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(draws[i].begin(), draws[i].end());
    const FreeQuantity& q = input.quantities[i];
    const double x = input.coordinates[i];
    const double std = std::sqrt(input.covariance(eigen_index(i), eigen_index(i)));
    const double scale = scale_to(std, draws[i]);
    const double lo = std::min(0.0, quantile_of_sorted(draws[i], 0.025));
    const double hi = std::max(0.0, quantile_of_sorted(draws[i], 0.975));
    intervals.push_back({q.value(x + scale * lo), q.value(x + scale * hi)});
  }
  return intervals;
}

/// LogFit::change_reach_s: the times are uniformly distributed, so that it is sqrt(3) times their
/// standard deviation.
double change_reach_s(const std::vector<FitWindow>& windows) {
  double reach_s = 0.0;
  for (const FitWindow& window : windows) {
    for (const UncertainChange& change : window.changes) {
      reach_s = std::max(reach_s, std::sqrt(3.0) * change.std_s);
    }
  }
  return reach_s;
}

/// The noise of the channels, with ChannelNoise::longest_filter_s at the solution: the time
/// constant of the motion at the largest measured speed or yaw rate, relaxation_time_s(), from 0.2
/// to 0.5 s. Model errors of a vehicle that reacts fast do not last longer. A channel whose filter
/// or smoothing is estimated keeps 0.5 s, because the filter correlates the noise.
NoiseLevels with_drift_limits(const LogProblem& problem, const std::vector<double>& coordinates) {
  constexpr double kShortest_s = 0.2;
  const LogModel& model = problem.model;
  const Plant<double> plant =
      plant_of(model.vehicle, parameters_at(model.held, model.quantities, coordinates));
  NoiseLevels levels = model.noise;
  const auto limit = [&](LogChannel channel, double time_constant_s) {
    if (has_kind(model.quantities, Kind::kSensorLag, channel) ||
        has_kind(model.quantities, Kind::kSmoothing, channel)) {
      return;
    }
    for (auto& [sensor, noise] : levels) {
      if (sensor.channel != channel) continue;
      noise.longest_filter_s =
          std::clamp(time_constant_s, kShortest_s, ChannelNoise{}.longest_filter_s);
    }
  };
  limit(LogChannel::kSpeed,
        relaxation_time_s(plant.surge, plant.mass_norm, fastest_of(problem, LogChannel::kSpeed)));
  limit(LogChannel::kYawRate, relaxation_time_s(plant.yaw, plant.inertia_norm,
                                                fastest_of(problem, LogChannel::kYawRate)));
  return levels;
}

/// Returns the result of a fit whose search ended at `solved`. `sums`: sums of all windows there,
/// all finite.
LogFit fit_at(const LogProblem& problem, const Solved& solved, const std::vector<WindowSums>& sums,
              const LogFitOptions& options) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const std::vector<double>& coordinates = solved.point.coordinates;
  const Eigen::Index n = rows_of(quantities);
  const Scores scores = scores_of(problem.windows, sums, n);
  const Identifiability found = without_stopped(
      identifiability(fit_evidence(sums, n).information, scores, quantities), problem, coordinates);
  const std::vector<Interval> bootstrap95 = block_bootstrap(
      {quantities, coordinates, found.covariance, scores.blocks}, options.bootstrap, options.seed);
  const std::vector<WindowErrors> errors = errors_at(problem, solved.point);
  return {.quantities = quantities,
          .coordinates = coordinates,
          .initial_states = solved.point.initial_states,
          .covariance = found.covariance,
          .refusal_reason = found.refusal_reason,
          .noise = with_drift_limits(problem, coordinates),
          .change_cost = change_cost_of(errors),
          .change_times = change_times_of(errors),
          .change_reach_s = change_reach_s(problem.windows),
          .errors = errors_by_sensor(problem, errors),
          .candidate_gain = candidate_gains(problem, solved.point, options.candidate_terms),
          .widened = found.widened(),
          .report = log_report({problem, solved, found, bootstrap95}),
          .usable = solved.usable && solved.converged};
}

/// Result of a fit that stopped early at `coordinates`, because of its errors.
LogFit given_up(const std::vector<FreeQuantity>& quantities, std::vector<double> coordinates,
                double relative_error) {
  LogFit fit = without_solution(
      "not refined, because its errors are too large compared with the sensor noise, or not small "
      "enough compared with those of the best fit so far",
      {});
  fit.quantities = quantities;
  fit.coordinates = std::move(coordinates);
  fit.relative_error = relative_error;
  fit.gave_up = true;
  return fit;
}

LogFit stopped_at(const NoiseIteration& at) {
  LogFit fit = without_solution("stopped, because commands change between rows", {});
  fit.quantities = at.problem.model.quantities;
  fit.coordinates = at.point.coordinates;
  fit.has_changes_between_rows = true;
  return fit;
}

/// Options of a search that stops after the first round if the relative error then exceeds
/// options.give_up_above.
NoiseRounds rounds_of(const LogProblem& problem, const LogFitOptions& options) {
  return {.give_up_above = 0.5 * options.give_up_above * problem.readings()};
}

/// Fits the coordinates and the noise of the logs, by a search that starts at these coordinates.
/// For long logs, the search first uses a sample of the windows, which saves time.
NoiseIteration settled_from(LogProblem problem, std::vector<double> coordinates,
                            const LogFitOptions& options) {
  problem.model.longest_step_s = step_s_at(problem.model, coordinates);
  NoiseRounds rounds = rounds_of(problem, options);
  if (!options.noise.empty()) {
    set_noise(options.noise, problem);
    rounds.is_near = true;
  } else if (is_long(problem)) {
    LogProblem some = with_windows(problem, spread(problem.windows.size(), kSampleWindows));
    some.model.noise = sensor_noise(some.windows, problem.model.noise);
    const NoiseRounds of_some = rounds_of(some, options);
    SearchPoint from = from_measured(some, std::move(coordinates));
    NoiseIteration near = settle_noise(std::move(some), std::move(from), of_some);
    if (near.gave_up) return near;
    set_noise(near.problem.model.noise, problem);
    coordinates = std::move(near.point.coordinates);
    rounds = {.is_near = true};
  }
  SearchPoint from = from_measured(problem, std::move(coordinates));
  return settle_noise(std::move(problem), std::move(from), rounds);
}

/// Fits the logs by a search that starts at these coordinates. Empty if the simulation of the logs
/// is not finite at the end of the search.
std::optional<LogFit> fit_from(const LogProblem& guess, const std::vector<double>& coordinates,
                               const LogFitOptions& options) {
  NoiseIteration settled = settled_from(guess, coordinates, options);
  bool is_between_rows = false;
  const auto tests = [&](const NoiseIteration& fit) {
    is_between_rows = options.tests_changes &&
                      has_changes_between_rows(fit.problem, fit.point, options.candidate_terms);
    return is_between_rows;
  };
  if (tests(settled)) return stopped_at(settled);
  if (settled.gave_up) {
    return given_up(settled.problem.model.quantities, settled.point.coordinates,
                    2.0 * settled.first_cost / settled.problem.readings());
  }
  if (options.finds_delays) {
    settled = find_delays_and_errors(std::move(settled), tests);
  }
  if (is_between_rows) return stopped_at(settled);
  settled.problem.ends_at_limit = false;  // Only a fit that has converged gives values.
  const Solved solved = solve(settled.problem, settled.point, kFine);
  const std::vector<WindowSums> sums =
      sums_at(settled.problem, solved.point, block_length_s(settled.problem.model.noise));
  if (!all_finite(sums)) return std::nullopt;
  LogFit fit = fit_at(settled.problem, solved, sums, options);
  fit.relative_error = relative_error_of(guess, fit.errors);
  return fit;
}

}  // namespace

LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  const LogProblem guess = log_problem(logs, options);
  if (guess.windows.empty() || guess.initial.empty()) {
    return without_solution("there are no measurements, or no parameter is free", {});
  }
  const int readings = guess.readings();
  if (readings <= static_cast<int>(guess.unknowns())) {
    return without_solution(
        fmt::format("{} readings are too few for {} unknowns (parameters, and the initial state of "
                    "every 10 s); log at a higher rate, or more channels",
                    readings, guess.unknowns()),
        {});
  }
  Multistart search = multistart(guess, options);
  if (search.ends.empty()) {
    return without_solution(
        "all initial guesses diverged (non-finite residuals); check the units and signs of the "
        "columns",
        search.starts);
  }
  if (options.best_so_far && is_far_worse(search, *options.best_so_far)) {
    return given_up(guess.model.quantities, search.ends.front(), search.relative_error);
  }
  std::optional<LogFit> fit;
  for (std::size_t i = 0; i < std::min(kTries, search.ends.size()) && !fit; ++i) {
    fit = fit_from(guess, search.ends[i], options);
  }
  if (!fit) {
    return without_solution(
        "failed: the simulation of the logs is not finite where the search ended; check the units "
        "and signs of the columns",
        search.starts);
  }
  fit->report.starts = std::move(search.starts);
  return *std::move(fit);
}

LogFit fit_roughly(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  const LogProblem rough = rough_problem(log_problem(logs, options));
  const Solved solved = solve(rough, from_measured(rough, rough.initial), kRough);
  LogFit fit;
  fit.quantities = rough.model.quantities;
  fit.coordinates = solved.point.coordinates;
  fit.initial_states = solved.point.initial_states;
  fit.relative_error = solved.usable ? 2.0 * solved.cost / rough.readings()
                                     : std::numeric_limits<double>::infinity();
  return fit;
}

LogFitOptions with_terms_of(const LogFit& fit, LogFitOptions options) {
  if (fit.quantities.empty()) return options;
  options.terms.clear();
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    if (q.kind == Kind::kParameter) continue;
    if (q.kind == Kind::kBias && q.log == 0) {
      if (!contains(options.biases, q.channel)) options.biases.push_back(q.channel);
    } else {
      options.terms.push_back({q, fit.coordinates[i]});
    }
  }
  return options;
}

ParameterValues<double> fitted_values(const LogFitOptions& options, const LogFit& fit) {
  return parameters_at(options.initial_guess, fit.quantities, fit.coordinates);
}

}  // namespace awmr
