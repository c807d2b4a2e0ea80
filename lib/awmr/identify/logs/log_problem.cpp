#include "awmr/identify/logs/log_problem.h"

#include <algorithm>
#include <utility>

#include "awmr/core/parallel.h"

namespace awmr {

LogProblem log_problem(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  LogProblem problem;
  problem.windows = fit_windows(logs);
  problem.model = {
      .vehicle = options.vehicle,
      .held = options.initial_guess,
      .quantities = free_quantities(options),
      .initial = initial_components(logs),
      .noise = sensor_noise(problem.windows),
      // A guess may be faster than any vehicle.
      .longest_step_s = std::max(kShortestReplayStep_s,
                                 replay_step_s(plant_of(options.vehicle, options.initial_guess)))};
  problem.initial = initial_coordinates(problem.model.quantities, options);
  problem.bounds = coordinate_bounds(problem.model.quantities, problem.initial, options.vehicle);
  problem.threads = options.threads;
  problem.deadline = options.deadline;
  problem.effort = options.effort;
  return problem;
}

SearchPoint from_measured(const LogProblem& problem, std::vector<double> coordinates) {
  return {std::move(coordinates), measured_initial_states(problem.windows, problem.model.initial)};
}

std::vector<WindowErrors> errors_at(const LogProblem& problem, const SearchPoint& point) {
  std::vector<WindowErrors> errors(problem.windows.size());
  const std::size_t k = problem.model.initial.size();
  parallel_for(problem.windows.size(), problem.threads, [&](std::size_t i) {
    errors[i] = errors_of(problem.model, problem.windows[i], point.coordinates.data(),
                          point.initial_states.data() + i * k);
  });
  return errors;
}

std::vector<WindowSums> sums_at(const LogProblem& problem, const SearchPoint& point,
                                double block_s) {
  std::vector<WindowSums> sums(problem.windows.size());
  const std::size_t k = problem.model.initial.size();
  parallel_for(problem.windows.size(), problem.threads, [&](std::size_t i) {
    sums[i] = sums_of(problem.model, problem.windows[i], point.coordinates.data(),
                      point.initial_states.data() + i * k, block_s);
  });
  return sums;
}

bool all_finite(const std::vector<WindowErrors>& errors) {
  return std::ranges::all_of(errors, &WindowErrors::finite);
}
bool all_finite(const std::vector<WindowSums>& sums) {
  return std::ranges::all_of(sums, &WindowSums::finite);
}

}  // namespace awmr
