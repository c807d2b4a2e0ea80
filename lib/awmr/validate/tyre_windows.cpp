#include "awmr/validate/tyre_windows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace awmr::tyre_fit {
namespace {

std::vector<double> steering_angles(const DrivingLog& log, const Plant<double>& plant) {
  // Longest integration step, as a fraction of the servo's time constant.
  constexpr double kLongestStep = 0.25;
  std::vector<double> angles;
  if (!log.steering_command_rad) return angles;
  const std::vector<double>& commands = *log.steering_command_rad;
  angles.push_back(commands.front());
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    const double span_s = log.t_s[row + 1] - log.t_s[row];
    const int steps = steps_in(span_s, kLongestStep * plant.steering_time_constant_s);
    State<double> servo{};
    servo.steering_rad = angles.back();
    for (int i = 0; i < steps; ++i) {
      servo = rk4_step(servo, span_s / steps, [&](const State<double>& at) {
        State<double> rates{};
        rates.steering_rad = steering_rate(plant, at.steering_rad, commands[row]);
        return rates;
      });
    }
    angles.push_back(servo.steering_rad);
  }
  return angles;
}

/// True if the errors of this row count. In the first second of the window they do not, because the
/// error of the initial state decays there.
bool counts(const LogWindow& rows, std::size_t row) {
  constexpr double kBegin_s = 1.0;
  return rows.log->t_s[row] - rows.log->t_s[rows.begin] >= kBegin_s;
}

struct ErrorsByRow {
  explicit ErrorsByRow(const ReplayedWindow& of) : window(of), all(rows_of(of.channels)) {}
  void operator()(std::size_t row, const State<double>& state) {
    if (!counts(window.rows, row)) return;
    each_measurement(*window.rows.log, row, [&](LogChannel channel, double measured) {
      all[count++] = channel_of(state, channel) - measured;
    });
  }
  const ReplayedWindow& window;
  Eigen::VectorXd all;
  Eigen::Index count = 0;
};

/// Subtracts the mean over the window from the errors of heading and position. Reason: the error of
/// the initial reading shifts all later values.
Eigen::VectorXd about_their_mean(const ReplayedWindow& window, Eigen::VectorXd errors) {
  for (const LogChannel channel : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading}) {
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      if (window.channels[at(i)] != channel) continue;
      sum += errors[i];
      count += 1.0;
    }
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      if (window.channels[at(i)] == channel) errors[i] -= sum / count;
    }
  }
  return errors;
}

}  // namespace

Tyres<double> tyres_at(const LogTyres& at) {
  Tyres<double> tyres;
  tyres.friction = std::exp(at[kFriction]);
  tyres.cornering_per_rad = std::exp(at[kCornering]);
  return tyres;
}

ReplayedLog::ReplayedLog(const DrivingLog& log, const Plant<double>& plant, double motor_lag_s)
    : signals(log), angles_rad(steering_angles(log, plant)) {
  if (motor_lag_s > 0.0) lagged.emplace(log, 0, log.rows(), motor_lag_s);
}

State<double> ReplayedLog::state_before(const LogWindow& rows) const {
  State<double> state = measured_initial_state(rows);
  if (!angles_rad.empty()) state.steering_rad = angles_rad[rows.begin];
  return state;
}

std::vector<ReplayedLog> replayed_logs(const std::vector<DrivingLog>& logs,
                                       const Plant<double>& plant, double motor_lag_s) {
  std::vector<ReplayedLog> replayed;
  for (const DrivingLog& log : logs) replayed.emplace_back(log, plant, motor_lag_s);
  return replayed;
}

std::vector<ReplayedWindow> windows_in(const std::vector<DrivingLog>& logs,
                                       const std::vector<ReplayedLog>& replayed) {
  std::vector<ReplayedWindow> windows;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (const LogWindow& rows : windows_of(logs[i], kWindow_s)) {
      ReplayedWindow window{&replayed[i], rows, replayed[i].state_before(rows)};
      for (std::size_t row = rows.begin; row < rows.end; ++row) {
        if (!counts(rows, row)) continue;
        each_measurement(logs[i], row, [&](LogChannel c, double) { window.channels.push_back(c); });
      }
      if (!window.channels.empty()) windows.push_back(std::move(window));
    }
  }
  return windows;
}

Windows evenly_chosen(const std::vector<ReplayedWindow>& all) {
  constexpr std::size_t kMaxWindows = 60;
  const std::size_t count = std::min(all.size(), kMaxWindows);
  Windows windows;
  for (std::size_t i = 0; i < count; ++i) windows.push_back(&all[i * all.size() / count]);
  return windows;
}

Turns turns_in(const LogWindow& rows, const Plant<double>& plant) {
  // Smaller RMS steering angles, or RMS differences of left and right force, count as no turn.
  constexpr double kLittleAngle_rad = 0.02;
  constexpr double kLittleForce = 0.02;
  // Smallest ratio of the squared moments with which the larger one counts as the only cause.
  constexpr double kMuchMore = 3.0;
  const DrivingLog& log = *rows.log;
  double by_sides = 0.0;  // sum over the rows of the squared differential moment, m^2
  double by_steering = 0.0;
  double angles = 0.0;
  double apart = 0.0;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const double angle = log.driving_steering_rad()[row];
    const double difference = log.force_right[row] - log.force_left[row];
    const double mean_force = 0.5 * (log.force_left[row] + log.force_right[row]);
    const double steered = steering_moment_m(plant.front_axle_m, mean_force, angle);
    const double apart_m = differential_moment_m(plant.half_track_m, difference);
    by_sides += apart_m * apart_m;
    by_steering += steered * steered;
    angles += angle * angle;
    apart += difference * difference;
  }
  const auto count = static_cast<double>(rows.end - rows.begin);
  const bool steers = angles > count * kLittleAngle_rad * kLittleAngle_rad;
  const bool pushes = apart > count * kLittleForce * kLittleForce;
  return {.by_sides = pushes && by_sides > kMuchMore * by_steering,
          .by_steering = steers && by_steering >= kMuchMore * by_sides};
}

Eigen::VectorXd errors_of_model(const ReplayedWindow& window, const Plants& plants) {
  ErrorsByRow errors(window);
  replay<double>(window.log->signals, window.rows.begin, window.rows.end, plants.model, nullptr,
                 plants.model_step_s, window.initial, std::ref(errors), window.log->motors());
  return about_their_mean(window, std::move(errors.all));
}

std::optional<Eigen::VectorXd> errors_on_tyres(const ReplayedWindow& window, const Plants& plants,
                                               const LogTyres& tyres) {
  ErrorsByRow errors(window);
  const bool resolved =
      replay(window.log->signals, window.rows.begin, window.rows.end,
             FourWheels<double>{plants.body, tyres_at(tyres)}, plants.four_wheel_step_s,
             window.initial, std::ref(errors), window.log->motors());
  if (!resolved || !errors.all.allFinite()) return std::nullopt;
  return about_their_mean(window, std::move(errors.all));
}

std::optional<ErrorSums> sums_on_tyres(const Windows& windows, const Plants& plants,
                                       const LogTyres& tyres) {
  ErrorSums sums;
  for (const ReplayedWindow* window : windows) {
    const auto errors = errors_on_tyres(*window, plants, tyres);
    if (!errors) return std::nullopt;
    sums.add(*window, *errors);
  }
  return sums;
}

}  // namespace awmr::tyre_fit
