#include "awmr/identify/logs/problem/initial_guess.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "awmr/identify/logs/problem/windows.h"
#include "awmr/model/dynamics.h"

namespace awmr {
namespace {

/// The measurements of a channel, linear between them and constant before the first and after the
/// last; one number per row. Empty if the channel is missing.
std::vector<double> filled(const DrivingLog& log, LogChannel channel) {
  std::vector<double> values;
  std::size_t last = 0;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (!is_measurement(log, channel, row)) continue;
    const double value = log[channel]->value[row];
    const double from = values.empty() ? value : values.back();
    const double from_s = log.t_s[last];
    for (std::size_t i = values.size(); i < row; ++i) {
      const double share = (log.t_s[i] - from_s) / (log.t_s[row] - from_s);
      values.push_back(from + share * (value - from));
    }
    values.push_back(value);
    last = row;
  }
  if (!values.empty()) values.resize(log.rows(), values.back());
  return values;
}

/// Slope of a series by row: difference between values at least 0.1 s before and after, divided by
/// the time between. Empty for fewer than two values.
std::vector<double> slope_of(const std::vector<double>& t_s, const std::vector<double>& values) {
  constexpr double kSpan_s = 0.1;
  std::vector<double> slope;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < values.size() && values.size() > 1; ++i) {
    while (begin + 1 < i && t_s[i] - t_s[begin + 1] > kSpan_s) ++begin;
    while (end + 1 < values.size() && (end <= i || t_s[end] - t_s[i] < kSpan_s)) ++end;
    slope.push_back((values[end] - values[begin]) / (t_s[end] - t_s[begin]));
  }
  return slope;
}

/// Speed u along the heading psi: u = x_dot cos psi + y_dot sin psi. Empty if one of them is
/// missing.
std::vector<double> speed_of(const DrivingLog& log) {
  const std::vector<double> east = slope_of(log.t_s, filled(log, LogChannel::kX));
  const std::vector<double> north = slope_of(log.t_s, filled(log, LogChannel::kY));
  const std::vector<double> heading = filled(log, LogChannel::kHeading);
  std::vector<double> speed;
  for (std::size_t i = 0; i < std::min({east.size(), north.size(), heading.size()}); ++i) {
    speed.push_back(east[i] * std::cos(heading[i]) + north[i] * std::sin(heading[i]));
  }
  return speed;
}

/// Generalised forces of the commands in one row, without dead zone, back-EMF and servo lag.
GeneralisedForces<double> forces_in(const DrivingLog& log, std::size_t row,
                                    const Vehicle& vehicle) {
  const SideForces<double> force{log.force_left[row], log.force_right[row]};
  const double steering_rad = log.driving_steering_rad()[row];
  return vehicle.drive == Drive::kFrontWheel
             ? front_wheel_forces(vehicle.front_axle_m, vehicle.half_track_m, force, steering_rad)
             : generalised_forces(vehicle.front_axle_m, vehicle.half_track_m, force, steering_rad);
}

/// Least-squares solution of inertia w_dot + alpha |w|^b sgn w = force without derivatives of a
/// noisy w: with means W_k of w over block k of a log, and means F_k and G_k of the time integrals
/// of the force and of |w|^b sgn w,
///
///     inertia (W_k - W_k-1) + alpha (G_k - G_k-1) = F_k - F_k-1
class BlockFit {
 public:
  /// Adds the rows of a window without gaps. `w`, `force`: by row of the log.
  void add(const LogWindow& window, const std::vector<double>& w,
           const std::vector<double>& force) {
    constexpr double kBlock_s = 0.25;
    const std::vector<double>& t_s = window.log->t_s;
    Eigen::Vector3d now = Eigen::Vector3d::Zero();  // w and the integrals of |w|^b sgn w and force
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> before;
    std::size_t first = window.begin;
    for (std::size_t i = window.begin; i + 1 < window.end; ++i) {
      now(0) = w[i];
      sum += now;
      const double h_s = t_s[i + 1] - t_s[i];
      now(1) += std::copysign(std::pow(std::abs(w[i]), kGuessedBeta), w[i]) * h_s;
      now(2) += force[i] * h_s;
      if (t_s[i + 1] - t_s[first] < kBlock_s) continue;
      const Eigen::Vector3d mean = sum / static_cast<double>(i + 1 - first);
      if (before) products_ += (mean - *before) * (mean - *before).transpose();
      before = mean;
      sum.setZero();
      first = i + 1;
    }
  }

  /// The solution. Empty if one of its values is not positive, or if inertia or resistance explains
  /// less than a tenth of the force in addition to the other: noise of w then makes it too small.
  std::optional<GuessedLaw> law() const {
    constexpr double kLeast = 0.1;
    const Eigen::Vector2d right = products_.topRightCorner<2, 1>();
    const Eigen::Vector2d x = products_.topLeftCorner<2, 2>().ldlt().solve(right);
    const double by_one =
        std::max(right(0) * right(0) / products_(0, 0), right(1) * right(1) / products_(1, 1));
    const bool is_shown = x.dot(right) - by_one > kLeast * products_(2, 2);
    if (!x.allFinite() || !(x.minCoeff() > 0.0) || !is_shown) return std::nullopt;
    return GuessedLaw{x(0), x(1)};
  }

 private:
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();  // [W G F]^T [W G F] of all differences
};

template <class SpeedOf, class ForceOf>
std::optional<GuessedLaw> law_of(const std::vector<DrivingLog>& logs, LogChannel measured,
                                 SpeedOf speed_of_log, ForceOf force_in_row) {
  BlockFit fit;
  for (const DrivingLog& log : logs) {
    if (log[measured]) return std::nullopt;
    const std::vector<double> speed = speed_of_log(log);
    if (speed.empty()) continue;
    std::vector<double> force(log.rows());
    for (std::size_t row = 0; row < log.rows(); ++row) force[row] = force_in_row(log, row);
    for (const LogWindow& window : windows_of(log, kWindow_s)) fit.add(window, speed, force);
  }
  return fit.law();
}

}  // namespace

std::optional<GuessedLaw> surge_of_positions(const std::vector<DrivingLog>& logs,
                                             const Vehicle& vehicle) {
  return law_of(logs, LogChannel::kSpeed, speed_of, [&](const DrivingLog& log, std::size_t row) {
    return forces_in(log, row, vehicle).tau_speed;
  });
}

std::optional<GuessedLaw> yaw_of_headings(const std::vector<DrivingLog>& logs,
                                          const Vehicle& vehicle) {
  const auto yaw_rate_of = [](const DrivingLog& log) {
    return slope_of(log.t_s, filled(log, LogChannel::kHeading));
  };
  return law_of(logs, LogChannel::kYawRate, yaw_rate_of,
                [&](const DrivingLog& log, std::size_t row) {
                  const GeneralisedForces<double> forces = forces_in(log, row, vehicle);
                  return forces.tau_steering_m + forces.tau_diff_m;
                });
}

}  // namespace awmr
