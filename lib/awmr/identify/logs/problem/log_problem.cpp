#include "awmr/identify/logs/problem/log_problem.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/parallel.h"
#include "awmr/trials/log_start.h"

namespace awmr {

namespace {

double shortest_spacing_s(const std::vector<DrivingLog>& logs) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const DrivingLog& log : logs) shortest_s = std::min(shortest_s, log.median_step_s());
  return shortest_s;
}

}  // namespace

double step_s_at(const LogModel& model, const std::vector<double>& coordinates) {
  constexpr double kSwayStepsOfRow = 4.0;
  constexpr double kServoStepsOfRow = 8.0;
  constexpr double kStepWithJumps_s = 0.005;
  Plant<double> plant =
      plant_of(model.vehicle, parameters_at(model.held, model.quantities, coordinates));
  const double sway_s = 0.25 * plant.mass_norm / plant.sway_alpha;
  const double servo_s = 0.25 * plant.steering_time_constant_s;
  plant.sway_alpha = 0.0;
  plant.steering_time_constant_s = std::numeric_limits<double>::infinity();
  const bool jumps = has_force_excess(model.quantities);
  // This limit matters only if a guessed time constant is shorter than that of any vehicle.
  return std::max(kShortestReplayStep_s,
                  std::min({replay_step_s(plant), model.row_spacing_s,
                            jumps ? kStepWithJumps_s : model.row_spacing_s,
                            std::max(sway_s, model.row_spacing_s / kSwayStepsOfRow),
                            std::max(servo_s, model.row_spacing_s / kServoStepsOfRow)}));
}

double rough_step_s(const LogModel& model) {
  constexpr double kRougher = 2.0;
  return std::max(model.longest_step_s,
                  std::min(kRougher * model.longest_step_s, model.row_spacing_s));
}

LogProblem log_problem(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  LogProblem problem;
  problem.windows = fit_windows(logs, options.window_s, options.only_s);
  problem.model = {.vehicle = options.vehicle,
                   .held = options.initial_guess,
                   .quantities = free_quantities(options),
                   .initial = initial_components(logs),
                   .noise = sensor_noise(problem.windows),
                   .row_spacing_s = shortest_spacing_s(logs)};
  problem.initial = initial_coordinates(options);
  problem.model.longest_step_s = step_s_at(problem.model, problem.initial);
  problem.bounds = coordinate_bounds(problem.model.quantities, problem.initial, options.vehicle);
  problem.optional_coulomb = options.optional_coulomb;
  problem.loss = options.loss;
  problem.threads = options.threads;
  problem.deadline = options.deadline;
  problem.effort = options.effort;
  return problem;
}

void set_noise(const NoiseLevels& levels, LogProblem& problem) {
  for (auto& [sensor, noise] : problem.model.noise) {
    if (!has_channel(levels, sensor.channel)) continue;
    const int log = sensor.log != 0 ? sensor.log : problem.windows.front().rows.log->number;
    noise = sensor_in(levels, sensor.channel, log).second;
  }
}

int LogProblem::readings() const {
  std::size_t readings = 0;
  for (const FitWindow& window : windows) readings += window.samples().size();
  return static_cast<int>(readings);
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

double change_cost_of(const std::vector<WindowErrors>& errors) {
  double cost = 0.0;
  for (const WindowErrors& window : errors) cost += window.change_cost;
  return cost;
}

std::vector<double> change_times_of(const std::vector<WindowErrors>& errors) {
  std::vector<double> times;
  for (const WindowErrors& window : errors) append(times, window.change_times);
  return times;
}

bool all_finite(const std::vector<WindowErrors>& errors) {
  return std::ranges::all_of(errors, &WindowErrors::finite);
}
bool all_finite(const std::vector<WindowSums>& sums) {
  return std::ranges::all_of(sums, &WindowSums::finite);
}

bool is_long(const LogProblem& problem) { return problem.windows.size() >= 2 * kSampleWindows; }

std::vector<std::size_t> spread(std::size_t size, std::size_t count) {
  std::vector<std::size_t> indices;
  count = std::min(count, size);
  for (std::size_t i = 0; i < count; ++i) indices.push_back(i * size / count);
  return indices;
}

LogProblem with_windows(const LogProblem& problem, const std::vector<std::size_t>& windows) {
  LogProblem part = problem;
  part.windows.clear();
  std::set<LogSensor> measured;
  for (const std::size_t w : windows) {
    const FitWindow& window = part.windows.emplace_back(problem.windows[w]);
    const int log = window.rows.log->number;
    for (const Sample& sample : window.samples()) {
      measured.insert(sensor_in(problem.model.noise, sample.channel, log).first);
    }
  }
  std::erase_if(part.model.noise,
                [&](const auto& level) { return !measured.contains(level.first); });
  return part;
}

SearchPoint with_windows(const LogProblem& problem, const SearchPoint& point,
                         const std::vector<std::size_t>& windows) {
  const auto components = static_cast<std::ptrdiff_t>(problem.model.initial.size());
  SearchPoint part{point.coordinates, {}};
  for (const std::size_t w : windows) {
    const auto first = point.initial_states.begin() + static_cast<std::ptrdiff_t>(w) * components;
    std::copy(first, first + components, std::back_inserter(part.initial_states));
  }
  return part;
}

double fastest_of(const LogProblem& problem, LogChannel channel) {
  double largest = 0.0;
  const DrivingLog* last = nullptr;
  for (const FitWindow& window : problem.windows) {
    if (window.rows.log == last) continue;
    last = window.rows.log;
    largest = std::max(largest, largest_measured(*last, channel));
  }
  return largest > 0.0 ? largest : 1.0;
}

}  // namespace awmr
