#include "awmr/identify/logs/speed_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/sample_quantile.h"
#include "awmr/trials/steady.h"

namespace awmr {
namespace {

/// Steady speed of each wheel divided by its command, m/s, from the fitted resistances. Present
/// only if this ratio is the same at all speeds (first sign of speed_control_findings()).
std::optional<double> fitted_speed_per_command(const Vehicle& vehicle,
                                               const std::vector<DrivingLog>& logs,
                                               const LogStage& stage) {
  constexpr double kOfExponent = 0.05;
  constexpr double kOfRatio = 0.1;
  const auto value = [&](ParameterId id) {
    const auto found = std::ranges::find(stage.main, id, &LogStage::Main::id);
    return found == stage.main.end() ? 0.0 : found->estimate.value.value_or(0.0);
  };
  const auto is_linear = [&](Family family, ParameterId beta) {
    return family == Family::kPower && std::abs(value(beta) - 1.0) < kOfExponent;
  };
  const double surge = value(ParameterId::kSurgeAlpha);
  const double ratio =
      value(ParameterId::kYawAlpha) / (surge * vehicle.half_track_m * vehicle.half_track_m);
  if (!(surge > 0.0) || std::ranges::none_of(logs, has_force_difference) ||
      !is_linear(stage.surge_family, ParameterId::kSurgeBeta) ||
      !is_linear(stage.yaw_family, ParameterId::kYawBeta) || !(std::abs(ratio - 1.0) < kOfRatio)) {
    return std::nullopt;
  }
  return vehicle.driven_wheels() / surge;
}

}  // namespace

std::optional<double> speed_per_set_point(const Vehicle& vehicle,
                                          const std::vector<DrivingLog>& logs) {
  constexpr SteadyRule kRule{.settling_s = 0.5, .shortest_s = 0.5, .drift = 0.1};
  constexpr double kKnown = 0.05;
  constexpr double kProportional = 0.05;
  constexpr double kRange = 3.0;
  constexpr std::size_t kFewest = 6;
  std::vector<double> commands;
  std::vector<double> speeds_per_command;
  for (const DrivingLog& log : logs) {
    for (const SteadyWheel& wheel : steady_wheels(log, vehicle, kRule)) {
      if (!(wheel.std_error < kKnown * std::abs(wheel.speed_mps)) || wheel.command == 0.0) continue;
      commands.push_back(std::abs(wheel.command));
      speeds_per_command.push_back(wheel.speed_mps / wheel.command);
    }
  }
  if (commands.size() < kFewest) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(commands);
  const double middle = median(speeds_per_command);
  const bool is_proportional = std::ranges::all_of(speeds_per_command, [&](double ratio) {
    return std::abs(ratio - middle) <= kProportional * std::abs(middle);
  });
  if (most < kRange * least || !is_proportional || !(middle > 0.0)) return std::nullopt;
  return middle;
}

std::vector<Finding> speed_control_findings(const Vehicle& vehicle,
                                            const std::vector<DrivingLog>& logs,
                                            const LogStage& stage,
                                            std::optional<double> set_point_mps) {
  const std::optional<double> slope_mps =
      set_point_mps ? set_point_mps : fitted_speed_per_command(vehicle, logs, stage);
  if (!slope_mps) return {};
  return {
      {logs.front().file, 0, Severity::kWarning, "speed-controlled",
       fmt::format("each wheel rolls at {:.3g} m/s per unit of its command, at all speeds. Either "
                   "motor drag is the only resistance, or force_left and force_right are "
                   "set-points of a speed controller, and a1, a3, m' and I'z describe that "
                   "controller. In that case log the commands that reach the motors",
                   *slope_mps)}};
}

}  // namespace awmr
