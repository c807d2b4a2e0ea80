#include "awmr/trials/replay.h"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "awmr/model/steady.h"

namespace awmr {
namespace {

constexpr std::size_t kShortestWindow = 3;

/// Returns the first row of the window, not before row `from`, with a measurement of the channel.
/// Empty if there is none.
std::optional<std::size_t> first_fresh(const LogWindow& window, LogChannel channel,
                                       std::size_t from) {
  const auto& measured = (*window.log)[channel];
  if (!measured) return std::nullopt;
  for (std::size_t row = std::max(from, window.begin); row < window.end; ++row) {
    if (measured->fresh[row]) return row;
  }
  return std::nullopt;
}

/// Rate of change of a channel at the start of the window, in the channel's unit per second. It is
/// the slope of the least-squares line through the first measurement and the measurements within
/// 0.5 s after it. Empty with fewer than two measurements.
std::optional<double> first_slope(const LogWindow& window, LogChannel channel) {
  constexpr double kSpan_s = 0.5;
  const auto first = first_fresh(window, channel, window.begin);
  if (!first) return std::nullopt;
  const DrivingLog& log = *window.log;
  const double t0_s = log.t_s[*first];
  const double value0 = log[channel]->value[*first];
  double n = 1.0;
  double t = 0.0;
  double tt = 0.0;
  double y = 0.0;
  double ty = 0.0;
  for (auto row = first_fresh(window, channel, *first + 1); row;
       row = first_fresh(window, channel, *row + 1)) {
    const double dt_s = log.t_s[*row] - t0_s;
    if (n > 1.0 && dt_s > kSpan_s) break;
    const double change = log[channel]->value[*row] - value0;
    n += 1.0;
    t += dt_s;
    tt += dt_s * dt_s;
    y += change;
    ty += dt_s * change;
  }
  if (n < 2.0) return std::nullopt;
  return (n * ty - t * y) / (n * tt - t * t);
}

/// True if the vehicle probably moves backward at the start of the window: the mean force in the
/// second before it is negative. For the first window of a log: the mean force in its first half
/// second is negative.
bool moves_backward(const LogWindow& window) {
  constexpr double kBefore_s = 1.0;
  constexpr double kAfter_s = 0.5;
  const DrivingLog& log = *window.log;
  const double now_s = log.t_s[window.begin];
  const bool is_first = window.begin == 0;
  double force = 0.0;
  for (std::size_t row = window.begin; row > 0 && log.t_s[row - 1] >= now_s - kBefore_s; --row) {
    force += log.force_left[row - 1] + log.force_right[row - 1];
  }
  for (std::size_t row = 0; is_first && row < window.end && log.t_s[row] <= now_s + kAfter_s;
       ++row) {
    force += log.force_left[row] + log.force_right[row];
  }
  return force < 0.0;
}

}  // namespace

std::vector<LogWindow> windows_of(const DrivingLog& log, double longest_s) {
  std::vector<LogWindow> windows;
  const double step_s = log.median_step_s();
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    if (end - begin >= kShortestWindow) windows.push_back({&log, begin, end});
    begin = end;
  };
  std::size_t piece_end = 0;  // the part without gaps that contains `begin` ends before this row
  for (std::size_t row = 1; row <= log.rows(); ++row) {
    if (row == log.rows() || log.t_s[row] - log.t_s[row - 1] > kGapSteps * step_s) {
      piece_end = row;
      // Windows of equal length leave no short remainder. If one step were not subtracted, the row
      // added by add_row_of_rest() could make a further window. The number of windows is at most
      // the number of rows, because times in nanoseconds that are read as seconds would give far
      // more windows.
      const double span_s = log.t_s[piece_end - 1] - log.t_s[begin] - step_s;
      const double most = static_cast<double>(piece_end - begin);
      const auto parts =
          static_cast<std::size_t>(std::clamp(std::ceil(span_s / longest_s), 1.0, most));
      const std::size_t first = begin;
      for (std::size_t part = 1; part <= parts; ++part) {
        close(first + (piece_end - first) * part / parts);
      }
    }
  }
  return windows;
}

HeldSignal::HeldSignal(const std::vector<double>& t_s, const std::vector<double>& value)
    : t_s_(&t_s), value_(&value), integral_(t_s.size(), 0.0) {
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    integral_[i] = integral_[i - 1] + value[i - 1] * (t_s[i] - t_s[i - 1]);
  }
}

double HeldSignal::integral(double t_s) const {
  const auto after = std::upper_bound(t_s_->begin(), t_s_->end(), t_s);
  const std::size_t row =
      after == t_s_->begin() ? 0 : static_cast<std::size_t>(after - t_s_->begin()) - 1;
  return integral_[row] + (*value_)[row] * (t_s - (*t_s_)[row]);
}

LogSignals::LogSignals(const DrivingLog& driving_log)
    : log(&driving_log),
      left(driving_log.t_s, driving_log.force_left),
      right(driving_log.t_s, driving_log.force_right) {}

bool is_measurement(const DrivingLog& log, LogChannel channel, std::size_t row) {
  if (!log[channel] || !log[channel]->fresh[row]) return false;
  return channel != LogChannel::kSteering || log.steering_command_rad;
}

State<double> measured_initial_state(const LogWindow& window) {
  const DrivingLog& log = *window.log;
  const auto first = [&](LogChannel channel) -> std::optional<double> {
    const auto row = first_fresh(window, channel, window.begin);
    if (!row) return std::nullopt;
    return log[channel]->value[*row];
  };
  const auto x_rate = first_slope(window, LogChannel::kX);
  const auto y_rate = first_slope(window, LogChannel::kY);
  const bool course = x_rate && y_rate;
  const auto speed = first(LogChannel::kSpeed);
  const bool backward = speed ? *speed < 0.0 : moves_backward(window);
  const double sign = backward ? -1.0 : 1.0;
  State<double> s{};
  s.x_m = first(LogChannel::kX).value_or(0.0);
  s.y_m = first(LogChannel::kY).value_or(0.0);
  s.psi_rad = first(LogChannel::kHeading)
                  .value_or(course ? std::atan2(sign * *y_rate, sign * *x_rate) : 0.0);
  s.u_mps =
      speed.value_or(course ? *x_rate * std::cos(s.psi_rad) + *y_rate * std::sin(s.psi_rad) : 0.0);
  s.v_mps = first(LogChannel::kSway).value_or(0.0);
  s.r_radps =
      first(LogChannel::kYawRate).value_or(first_slope(window, LogChannel::kHeading).value_or(0.0));
  s.steering_rad =
      first(LogChannel::kSteering)
          .value_or(log.steering_command_rad ? (*log.steering_command_rad)[window.begin] : 0.0);
  return s;
}

namespace {

/// Speed, m/s or rad/s, below which a resistance may be replaced by a straight line through the
/// origin (rest_speed()). Logs do not resolve slower motion.
constexpr double kChordSpeed = 0.01;

/// Longest integration step h, s, that resolves a resistance g(w) without its Coulomb friction. w
/// is the speed or yaw rate, beta the exponent of g; the inertia is m' or I'z:
///   h <= inertia w/(max(1, beta) g(w))
/// Computes the bound at w = kChordSpeed, where g(w)/w is largest if beta < 1, and at the steady w
/// under `force`, where g(w)/w is largest if beta > 1. The Runge-Kutta method is stable up to 2.78
/// times this step.
double resistance_step_s(Resistance<double> law, double inertia, double force) {
  law.coulomb = 0.0;
  double step_s = std::numeric_limits<double>::infinity();
  for (const double w : {kChordSpeed, steady_rate(law, force).value_or(kChordSpeed)}) {
    step_s = std::min(step_s, relaxation_time_s(law, inertia, w) / std::max(1.0, law.beta));
  }
  return step_s;
}

}  // namespace

double replay_step_s(const Plant<double>& plant) {
  double fastest_s = plant.steering_time_constant_s;
  if (plant.sway_alpha > 0.0) fastest_s = std::min(fastest_s, plant.mass_norm / plant.sway_alpha);
  if (const double rate = back_emf_rate(plant); rate > 0.0) {
    fastest_s = std::min(fastest_s, 1.0 / rate);
  }
  constexpr double kFullForce = 4.0;
  const double arm_m = plant.half_track_m + plant.front_axle_m;
  return std::min({0.25 * fastest_s, resistance_step_s(plant.surge, plant.mass_norm, kFullForce),
                   resistance_step_s(plant.yaw, plant.inertia_norm, kFullForce * arm_m)});
}

Result<void> check_replay(const Plant<double>& plant, const std::string& file) {
  const double step_s = replay_step_s(plant);
  if (step_s >= kShortestReplayStep_s) return {};
  const bool servo = step_s == 0.25 * plant.steering_time_constant_s;
  const double braking = back_emf_rate(plant);
  const bool motors = braking > 0.0 && step_s == 0.25 * (1.0 / braking);
  const bool sway = step_s == 0.25 * (plant.mass_norm / plant.sway_alpha);
  const std::string what =
      servo    ? fmt::format("steering.time_constant_s is {:g} s", plant.steering_time_constant_s)
      : motors ? fmt::format("the motors' back_emf_s_per_m {:g} brakes the vehicle within {:g} s",
                             plant.back_emf_s_per_m, 1.0 / braking)
      : sway   ? fmt::format("m'/sway_alpha is {:g}/{:g} s", plant.mass_norm, plant.sway_alpha)
               : fmt::format("the resistance stops the vehicle (m' {:g}, I'z {:g}) within {:g} s",
                             plant.mass_norm, plant.inertia_norm, 4.0 * step_s);
  return input_error(
      ErrorCode::kOutOfRange, file,
      fmt::format("{}, too fast to be followed by the integration steps with which awmr "
                  "simulates a log (the shortest time that they can follow is {:g} s): check the "
                  "values in vehicle.json and the units of the trials",
                  what, 4.0 * kShortestReplayStep_s));
}

}  // namespace awmr
