#include "awmr/identify/logs/checks/log_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/trials/steady.h"

namespace awmr {
namespace {

/// Steady speed of each wheel divided by its command, m/s, from the fitted resistances. Present
/// only if this ratio is the same at all speeds (first sign of find_speed_control()).
std::optional<double> fitted_ratio_mps(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                                       const FamilyFit& chosen) {
  constexpr double kOfExponent = 0.05;
  constexpr double kOfRatio = 0.1;
  const LogFit& fit = chosen.fit;
  const auto value = [&](ParameterId id) {
    const auto i = place_of(fit.quantities, id);
    const bool has_value = fit.usable && i && fit.refusal_reason[*i].empty();
    return has_value ? fit.quantities[*i].value(fit.coordinates[*i]) : 0.0;
  };
  const auto is_linear = [&](Family family, ParameterId beta) {
    return family == Family::kPower && std::abs(value(beta) - 1.0) < kOfExponent;
  };
  const double surge = value(ParameterId::kSurgeAlpha);
  const double ratio =
      value(ParameterId::kYawAlpha) / (surge * vehicle.half_track_m * vehicle.half_track_m);
  if (!(surge > 0.0) || std::ranges::none_of(logs, has_force_difference) ||
      !is_linear(chosen.surge, ParameterId::kSurgeBeta) ||
      !is_linear(chosen.yaw, ParameterId::kYawBeta) || !(std::abs(ratio - 1.0) < kOfRatio)) {
    return std::nullopt;
  }
  return vehicle.driven_wheels() / surge;
}

/// Speed of a wheel that rolls steadily, divided by its command.
struct SpeedRatio {
  double command;  ///< magnitude
  double ratio_mps;
};

/// Median of the ratios, if at least 80 % of the speeds differ from the median ratio times the
/// command by at most 5 %, or 5 % and the speed of 1 % of the full command. Empty in these cases,
/// because the speeds are then not shown to be proportional to the commands:
///   - There are fewer than six such ratios, or their median is not positive.
///   - Their commands differ by less than a factor of 3. (Over this factor, the ratios of a power
///     law with the exponent b1 = 0.9 differ by 12 %.)
std::optional<double> common_ratio_mps(std::vector<SpeedRatio> ratios) {
  constexpr double kEqual = 0.05;
  constexpr double kSmallCommand = 0.01;
  constexpr double kMostOf = 0.8;  // the others: short segments, in which the motion still changes
  constexpr double kRange = 3.0;
  constexpr double kFewest = 6.0;
  if (ratios.empty()) return std::nullopt;
  std::vector<double> all;
  for (const SpeedRatio& one : ratios) all.push_back(one.ratio_mps);
  const double middle = median(all);
  std::erase_if(ratios, [&](const SpeedRatio& one) {
    const double tolerance = kEqual + kSmallCommand / one.command;
    return !(std::abs(one.ratio_mps - middle) <= tolerance * std::abs(middle));
  });
  const auto equal = static_cast<double>(ratios.size());
  if (equal < std::max(kFewest, kMostOf * static_cast<double>(all.size()))) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(ratios, {}, &SpeedRatio::command);
  if (most.command < kRange * least.command || !(middle > 0.0)) return std::nullopt;
  return middle;
}

/// Ratio of the steady speeds of the wheels to their commands, if common_ratio_mps() finds one.
/// Uses only speeds with a standard error below 5 %. `only_turns`: only those in turns with
/// different commands left and right.
std::optional<double> measured_ratio_mps(const Vehicle& vehicle,
                                         const std::vector<DrivingLog>& logs, bool only_turns) {
  constexpr SteadyRule kRule{.settling_s = 0.5, .shortest_s = 0.5, .drift = 0.1};
  constexpr double kKnown = 0.05;
  std::vector<SpeedRatio> ratios;
  for (const DrivingLog& log : logs) {
    for (const SteadyWheel& wheel : steady_wheels(log, vehicle, kRule)) {
      if (!(wheel.std_error < kKnown * std::abs(wheel.speed_mps)) || wheel.command == 0.0) continue;
      if (only_turns && !wheel.turning) continue;
      ratios.push_back({std::abs(wheel.command), wheel.speed_mps / wheel.command});
    }
  }
  return common_ratio_mps(std::move(ratios));
}

}  // namespace

std::optional<SpeedControl> find_speed_control(const Vehicle& vehicle,
                                               const std::vector<DrivingLog>& logs,
                                               const FamilyFit& chosen) {
  // Largest errors of a right model, divided by the sensor noise. A speed controller adds dynamics
  // of its own, which leave larger errors.
  constexpr double kErrorOfDrag = 1.5;
  const bool is_adequate = !chosen.fit.has_model_error();
  const auto measured = measured_ratio_mps(vehicle, logs, is_adequate);
  const auto fitted = fitted_ratio_mps(vehicle, logs, chosen);
  if (!measured && !fitted) return std::nullopt;
  const bool is_motor_drag = is_adequate && fitted && chosen.fit.relative_error < kErrorOfDrag;
  return SpeedControl{measured ? *measured : *fitted, measured && !is_motor_drag};
}

Finding speed_control_finding(const SpeedControl& found, const std::string& file) {
  return {file, 0, Severity::kWarning, "speed-controlled",
          fmt::format("each wheel rolls at {:.3g} m/s per unit of its command, at all speeds. "
                      "Either motor drag is the only resistance, or force_left and force_right are "
                      "set-points of a speed controller, and a1, a3, m' and I'z describe that "
                      "controller{}. In that case log the commands that reach the motors",
                      found.speed_per_command_mps,
                      found.withdraws ? ", so the intervals are withdrawn" : "")};
}

}  // namespace awmr
