#include "awmr/identify/logs/problem/multistart.h"

#include <algorithm>
#include <iterator>

#include "awmr/core/parallel.h"
#include "awmr/core/random.h"

namespace awmr {
namespace {

/// Draws a random initial guess of the parameters in `guessed`. Multiplies those with a logarithmic
/// coordinate by a factor in [e^-2, e^2], about 1/7 to 7. Draws exponents from [0.3, 1.3] and
/// limits them to their range. Terms that only some resistance families have do not change.
///
/// Every quantity uses one random number, even if it is not in `guessed`. The guess of a quantity
/// then does not depend on which others are in `guessed`.
std::vector<double> drawn(const LogProblem& problem, const std::vector<ParameterId>& guessed,
                          Random& random) {
  std::vector<double> coordinates = problem.initial;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const FreeQuantity& q = problem.model.quantities[i];
    const double u = random.uniform();
    const bool draw =
        std::any_of(guessed.begin(), guessed.end(), [&](ParameterId id) { return q.is(id); });
    if (!draw) continue;
    if (q.scale == Scale::kLogarithmic) {
      coordinates[i] += 4.0 * u - 2.0;
    } else if (!info(q.id).term) {
      coordinates[i] = std::clamp(0.3 + u, problem.bounds[i].lo, problem.bounds[i].hi);
    }
  }
  return coordinates;
}

/// Coordinates at which searches start: the initial guess, options.also_from, random guesses.
std::vector<std::vector<double>> places(const LogProblem& problem, const LogFitOptions& options) {
  std::vector<std::vector<double>> from{problem.initial};
  for (const ParameterValues<double>& values : options.also_from) {
    LogFitOptions other = options;
    other.initial_guess = values;
    from.push_back(initial_coordinates(other));
  }
  if (options.guessed.empty()) return from;
  Random random(options.seed, 1);
  for (int i = 0; i < options.multistart; ++i) {
    from.push_back(drawn(problem, options.guessed, random));
  }
  return from;
}

/// One per quantity: its value at the given coordinate.
std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates) {
  std::vector<double> values;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values.push_back(quantities[i].value(coordinates[i]));
  }
  return values;
}

}  // namespace

bool is_far_worse(const Multistart& search, const BestSoFar& best) {
  constexpr double kFar = 100.0;
  constexpr double kMuchLess = 0.7;
  constexpr double kLittle = 5.0;
  const double of_model = std::max(0.0, best.relative_error - 1.0);
  if (best.has_large_drift && search.relative_error > 1.0 + kMuchLess * of_model) return true;
  const double gain = search.readings * (1.0 - search.relative_error / best.relative_error);
  if (best.needs_large_gain && search.readings > 0 && gain < kLittle) return true;
  return search.readings * (search.relative_error - best.relative_error) >
         kFar * std::max(1.0, best.relative_error);
}

LogProblem rough_problem(const LogProblem& problem) {
  constexpr std::size_t kParts = 12;
  constexpr double kPart_s = 2.5;
  // At low rates, parts of kPart_s would have hardly more readings than unknowns (the initial state
  // of each part), so that the errors of every model would be as small as those of the right one.
  constexpr double kRowsOfPart = 50.0;
  LogProblem rough = problem;
  rough.model.longest_step_s = rough_step_s(problem.model);
  rough.threads = 1;  // one thread each, because the searches themselves run in parallel
  rough.ends_at_limit = false;
  std::vector<FitWindow> parts;
  for (const std::size_t i : spread(problem.windows.size(), kParts)) {
    const FitWindow& window = problem.windows[i];
    const double part_s = std::max(kPart_s, kRowsOfPart * window.rows.log->median_step_s());
    std::ranges::move(parts_of(window, part_s), std::back_inserter(parts));
  }
  rough.windows.clear();
  for (const std::size_t i : spread(parts.size(), kParts)) rough.windows.push_back(parts[i]);
  return rough;
}

Multistart multistart(const LogProblem& problem, const LogFitOptions& options) {
  constexpr std::size_t kReasonLength = 60;
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const std::vector<std::vector<double>> from = places(problem, options);
  if (from.size() == 1 && options.guessed.empty()) {
    return {{problem.initial},
            {{values_at(quantities, problem.initial), 0.0, true, "initial guess"}}};
  }
  const LogProblem rough = rough_problem(problem);
  std::vector<Solved> solved(from.size());
  parallel_for(from.size(), problem.threads, [&](std::size_t i) {
    solved[i] = solve(rough, from_measured(rough, from[i]), kRough);
  });
  Multistart result;
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < from.size(); ++i) {
    result.starts.push_back({values_at(quantities, from[i]), solved[i].cost, false,
                             solved[i].stop_reason.substr(0, kReasonLength)});
    if (solved[i].usable) usable.push_back(i);
  }
  std::ranges::stable_sort(usable, {}, [&](std::size_t i) { return solved[i].cost; });
  for (const std::size_t i : usable) result.ends.push_back(solved[i].point.coordinates);
  if (!usable.empty()) {
    result.starts[usable.front()].chosen = true;
    result.readings = rough.readings();
    result.relative_error = 2.0 * solved[usable.front()].cost / result.readings;
  }
  return result;
}

}  // namespace awmr
