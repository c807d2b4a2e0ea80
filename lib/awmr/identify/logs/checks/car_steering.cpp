#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/identify/logs/checks/log_checks.h"

namespace awmr {
namespace {

/// Sums of the regression r = k u tan(d_r) over rows, with the standard deviation of its errors.
struct CarRegression {
  double rates = 0.0;     ///< sum of r^2
  double products = 0.0;  ///< sum of r u tan(d_r)
  double squares = 0.0;   ///< sum of (u tan(d_r))^2
  double rows = 0.0;

  double curvature_factor() const { return products / squares; }
  double error() const {
    return std::sqrt(std::max(0.0, rates - products * products / squares) / rows);
  }
  double size() const { return std::sqrt(rates / rows); }
};

/// Adds the rows of a log with a measured yaw rate. `lag_s`: time constant of the steering; 0 if
/// the steering follows its command at once.
void add_rows(const DrivingLog& log, double lag_s, CarRegression& sums) {
  const std::vector<double>& commands = log.driving_steering_rad();
  const std::vector<double>& speed = log[LogChannel::kSpeed]->value;
  const Measured& rate = *log[LogChannel::kYawRate];
  double steering = commands.front();
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double step_s = i > 0 ? log.t_s[i] - log.t_s[i - 1] : 0.0;
    const double share = lag_s > 0.0 ? 1.0 - std::exp(-step_s / lag_s) : 1.0;
    steering += share * (commands[i] - steering);
    if (!rate.fresh[i]) continue;
    const double rolling = speed[i] * std::tan(steering);
    sums.rates += rate.value[i] * rate.value[i];
    sums.products += rate.value[i] * rolling;
    sums.squares += rolling * rolling;
    sums.rows += 1.0;
  }
}

/// Regression over all rows, with the lag that fits best.
struct BestCar {
  CarRegression sums;
  double lag_s = 0.0;
};

/// Empty if no log has a motion with a steering angle.
std::optional<BestCar> best_car(const std::vector<DrivingLog>& logs) {
  std::optional<BestCar> best;
  for (const double lag_s : {0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.45}) {
    CarRegression sums;
    for (const DrivingLog& log : logs) add_rows(log, lag_s, sums);
    if (!(sums.squares > 0.0)) return std::nullopt;
    if (!best || sums.error() < best->sums.error()) best = BestCar{sums, lag_s};
  }
  return best;
}

/// Standard deviation of the errors of the yaw rate of a fit, rad/s; 0 if it is not measured.
double yaw_rate_error(const LogFit& fit) {
  SquareSum sum;
  for (const auto& [sensor, errors] : fit.errors) {
    if (sensor.channel == LogChannel::kYawRate) sum.add(errors);
  }
  return sum.count > 0.0 ? std::sqrt(sum.squares / sum.count) : 0.0;
}

}  // namespace

std::optional<Finding> car_steering_finding(const Vehicle& vehicle,
                                            const std::vector<DrivingLog>& logs,
                                            const LogFit& fit) {
  constexpr double kMuchBetter = 0.7;        // error of the car over that of the fit
  constexpr double kExplained = 0.4;         // error of the car over the yaw rate itself
  constexpr Interval kWheelbases{0.4, 1.5};  // over the length of the vehicle
  const auto has_both = [](const DrivingLog& log) {
    return log[LogChannel::kSpeed] && log[LogChannel::kYawRate];
  };
  if (!vehicle.has_steering() || !std::ranges::all_of(logs, has_both)) return std::nullopt;
  const auto car = best_car(logs);
  if (!car) return std::nullopt;
  const double error = car->sums.error();
  const double error_of_fit = yaw_rate_error(fit);
  const double wheelbase_m = 1.0 / car->sums.curvature_factor();
  if (!(error < kMuchBetter * error_of_fit) || !(error < kExplained * car->sums.size()) ||
      !kWheelbases.contains(wheelbase_m / vehicle.length_m)) {
    return std::nullopt;
  }
  return Finding{
      logs.front().file, 0, Severity::kWarning, "turns-like-a-car",
      fmt::format("the vehicle turns like a car: its yaw rate is u tan(steering)/L with the "
                  "wheelbase L = {:.2g} m and a steering lag of about {:.2g} s, with or without "
                  "thrust. This misses the measured yaw rate by {:.2g} rad/s, the fit by {:.2g} "
                  "rad/s. In the model of awmr, the thrust of the steered front wheels turns the "
                  "vehicle, not the side force of its tyres, so these logs give no yaw resistance "
                  "and no I'z. For the mass and the surge resistance, identify logs that drive "
                  "straight ahead",
                  wheelbase_m, car->lag_s, error, error_of_fit)};
}

}  // namespace awmr
