#include "awmr/identify/logs/multistart.h"

#include <algorithm>
#include <limits>

#include "awmr/core/parallel.h"
#include "awmr/core/random.h"
#include "awmr/identify/logs/ceres_problem.h"

namespace awmr {
namespace {

/// At most half a minute's worth of windows, spread over all logs: enough to tell a good initial
/// guess from a bad one. Steps are long.
LogProblem rough_problem(const LogProblem& problem) {
  constexpr std::size_t kMaximumWindows = 3;
  LogProblem rough = problem;
  rough.model.longest_step_s = kRoughStep * problem.model.longest_step_s;
  rough.threads = 1;  // the searches run side by side
  rough.windows.clear();
  const std::size_t count = std::min(kMaximumWindows, problem.windows.size());
  for (std::size_t i = 0; i < count; ++i) {
    rough.windows.push_back(problem.windows[i * problem.windows.size() / count]);
  }
  return rough;
}

/// The initial guess with every guessed quantity drawn anew: a factor up to e^2 either way for a
/// logarithm, anywhere in [0.3, 1.3] for an exponent; a family's term stays. One random number per
/// quantity, drawn or not.
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

/// The initial guess, the other places given, then the random ones, as coordinates.
std::vector<std::vector<double>> places(const LogProblem& problem, const LogFitOptions& options) {
  std::vector<std::vector<double>> from{problem.initial};
  for (const ParameterValues<double>& values : options.also_from) {
    LogFitOptions other = options;
    other.initial_guess = values;
    from.push_back(initial_coordinates(problem.model.quantities, other));
  }
  if (options.guessed.empty()) return from;
  Random random(options.seed, 1);
  for (int i = 0; i < options.multistart; ++i) {
    from.push_back(drawn(problem, options.guessed, random));
  }
  return from;
}

}  // namespace

Multistart multistart(const LogProblem& problem, const LogFitOptions& options) {
  constexpr double kRough = 1e-4;
  constexpr std::size_t kReasonLength = 60;
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const std::vector<std::vector<double>> from = places(problem, options);
  if (from.size() == 1 && options.guessed.empty()) {
    return {problem.initial,
            {{values_at(quantities, problem.initial), 0.0, true, "from the other trials"}}};
  }
  const LogProblem rough = rough_problem(problem);
  Multistart result;
  double least = std::numeric_limits<double>::infinity();
  std::size_t chosen = 0;
  std::vector<Solved> ends(from.size());
  parallel_for(from.size(), problem.threads, [&](std::size_t i) {
    ends[i] = solve(rough, from_measured(rough, from[i]), kRough);
  });
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::vector<double>& coordinates = from[i];
    const Solved& solved = ends[i];
    result.starts.push_back({values_at(quantities, coordinates), solved.cost, false,
                             solved.stop_reason.substr(0, kReasonLength)});
    if (!solved.usable || !(solved.cost < least)) continue;
    least = solved.cost;
    result.coordinates = solved.point.coordinates;
    chosen = result.starts.size() - 1;
  }
  if (!result.coordinates.empty()) result.starts[chosen].chosen = true;
  return result;
}

}  // namespace awmr
