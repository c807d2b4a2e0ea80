#include "awmr/trials/steady.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/trials/checks/channel_quality.h"

namespace awmr {
namespace {

/// Largest accepted change of a constant command, in F' or rad.
constexpr double kSameCommand = 1e-3;
/// Largest steering angle of a surge run, rad: 0.5 deg.
constexpr double kStraight_rad = 0.0087;

/// Steering angle of each row, rad: the measured one, or the command if none was measured.
const std::vector<double>& steering_angle_of(const DrivingLog& log) {
  return log[LogChannel::kSteering] ? log[LogChannel::kSteering]->value : *log.steering_command_rad;
}

std::vector<RowSpan> constant_commands(const DrivingLog& log) {
  // Takes the steering command if there is one, because noise changes a measured angle in every
  // row.
  const std::vector<double>& steering = log.driving_steering_rad();
  const double gap_s = kGapSteps * log.median_step_s();
  std::vector<RowSpan> stretches;
  RowSpan stretch{0, 1};
  for (std::size_t i = 1; i <= log.rows(); ++i) {
    const auto moved = [&](const std::vector<double>& signal) {
      return std::abs(signal[i] - signal[stretch.begin]) > kSameCommand;
    };
    if (i < log.rows() && !moved(log.force_left) && !moved(log.force_right) && !moved(steering) &&
        log.t_s[i] - log.t_s[i - 1] <= gap_s) {
      continue;
    }
    stretch.end = i;
    stretches.push_back(stretch);
    stretch.begin = i;
  }
  return stretches;
}

/// Straight line fitted to a rate over a stretch: its mean, its rise from end to end, and the
/// standard errors of both.
struct Line {
  int count = 0;
  double mean = 0.0;
  double rise = 0.0;
  double mean_error = 0.0;
  double rise_error = 0.0;
};

Line line_through(const DrivingLog& log, const Measured& rate, RowSpan s) {
  double t = 0.0;
  double w = 0.0;
  int n = 0;
  for (std::size_t i = s.begin; i < s.end; ++i) {
    if (!rate.fresh[i]) continue;
    t += log.t_s[i];
    w += rate.value[i];
    ++n;
  }
  if (n < 5) return {};
  t /= n;
  w /= n;
  double tt = 0.0;
  double tw = 0.0;
  double ww = 0.0;
  for (std::size_t i = s.begin; i < s.end; ++i) {
    if (!rate.fresh[i]) continue;
    const double dt = log.t_s[i] - t;
    const double dw = rate.value[i] - w;
    tt += dt * dt;
    tw += dt * dw;
    ww += dw * dw;
  }
  const double slope = tw / tt;
  const double variance = std::max(0.0, (ww - slope * tw) / (n - 2));
  const double span_s = log.t_s[s.end - 1] - log.t_s[s.begin];
  return {n, w, slope * span_s, std::sqrt(variance / n), std::sqrt(variance / tt) * span_s};
}

bool is_steady(const Line& line, double drift) {
  if (line.count == 0) return false;
  return std::abs(line.rise) <= drift * std::abs(line.mean) ||
         std::abs(line.rise) <= 3.0 * line.rise_error;
}

/// Cuts rows off the beginning of `stretch` until the remainder is steady (SteadyRule). Returns the
/// straight line fitted to the rate in the remainder. Empty if no remainder is steady.
std::optional<Line> steady_rest(const DrivingLog& log, const Measured& rate, const SteadyRule& rule,
                                RowSpan& stretch) {
  constexpr double kLater_s = 0.25;
  for (double from_s = log.t_s[stretch.begin] + rule.settling_s;; from_s += kLater_s) {
    while (stretch.begin < stretch.end && log.t_s[stretch.begin] < from_s) ++stretch.begin;
    if (stretch.begin >= stretch.end ||
        log.t_s[stretch.end - 1] - log.t_s[stretch.begin] < rule.shortest_s) {
      return std::nullopt;
    }
    const Line line = line_through(log, rate, stretch);
    if (is_steady(line, rule.drift)) return line;
  }
}

double mean_of(const std::vector<double>& signal, RowSpan s) {
  double sum = 0.0;
  for (std::size_t i = s.begin; i < s.end; ++i) sum += signal[i];
  return sum / static_cast<double>(s.end - s.begin);
}

/// A part of a log with steady motion.
struct SteadyRun {
  double begin_s = 0.0;  ///< t_s of its first row
  double end_s = 0.0;    ///< t_s of its last row
  int line = 0;          ///< line of its first row in the file
  bool turning = false;  ///< true: turning run; false: surge run
  /// Magnitude of the yaw rate (turning run, rad/s) or speed (surge run, m/s).
  double mean_rate = 0.0;
  /// Standard error of mean_rate, from the scatter about the straight line. Assumes independent
  /// errors of neighbouring rows.
  double std_error = 0.0;
  double wheel_force = 0.0;   ///< F' of each wheel, the mean of both sides
  double steering_rad = 0.0;  ///< steering angle, rad, left positive
  SideForces<double> sides{};
};

/// Returns the steady run in a stretch of constant commands (SteadyRule); empty if there is none.
std::optional<SteadyRun> steady_run(const DrivingLog& log, const Vehicle& vehicle,
                                    RowSpan stretch) {
  const double left = mean_of(log.force_left, stretch);
  const double right = mean_of(log.force_right, stretch);
  const double steering_rad = mean_of(steering_angle_of(log), stretch);
  const bool uneven = std::abs(left - right) > kSameCommand;
  const bool turning = vehicle.has_steering() ? std::abs(steering_rad) > kStraight_rad : uneven;
  const auto& rate = log[turning ? LogChannel::kYawRate : LogChannel::kSpeed];
  const bool by_sides = turning && !vehicle.has_steering();
  if (!rate || (!by_sides && (!(left > 0.0) || uneven))) return std::nullopt;
  const auto line = steady_rest(log, *rate, SteadyRule{}, stretch);
  if (!line) return std::nullopt;
  // A mean rate that does not exceed three standard errors may be 0: the vehicle may be at rest.
  if (!(std::abs(line->mean) > 3.0 * line->mean_error)) return std::nullopt;
  const double left_turn = by_sides ? right - left : steering_rad;
  if (turning ? line->mean * left_turn < 0.0 : line->mean < 0.0) return std::nullopt;
  return SteadyRun{.begin_s = log.t_s[stretch.begin],
                   .end_s = log.t_s[stretch.end - 1],
                   .line = log.line[stretch.begin],
                   .turning = turning,
                   .mean_rate = std::abs(line->mean),
                   .std_error = line->mean_error,
                   .wheel_force = 0.5 * (left + right),
                   .steering_rad = steering_rad,
                   .sides = {left, right}};
}

TurningRow sides_turning_row(const SteadyRun& run, const Vehicle& vehicle) {
  const auto [least, most] = std::minmax(run.sides.left, run.sides.right);
  return {.line = run.line,
          .tau_turn_m = differential_moment_m(vehicle.half_track_m, most - least),
          .yaw_rate_radps = run.mean_rate,
          .turns = {},
          .elapsed_s = {},
          .sides = SideForces<double>{least, most}};
}

TurningRow turning_row(const SteadyRun& run, const Vehicle& vehicle) {
  if (!vehicle.has_steering()) return sides_turning_row(run, vehicle);
  const double angle = std::abs(run.steering_rad);
  return {.line = run.line,
          .steering_rad = angle,
          .wheel_force = run.wheel_force,
          .tau_turn_m = steering_moment_m(vehicle.front_axle_m, run.wheel_force, angle),
          .yaw_rate_radps = run.mean_rate,
          .turns = {},
          .elapsed_s = {}};
}

Finding note_of(const SteadyRun& run, const Vehicle& vehicle, const std::string& file) {
  const bool by_sides = run.turning && !vehicle.has_steering();
  return {file, run.line, Severity::kNote, "steady-segment",
          fmt::format("steady from {:.3f} to {:.3f} s: {} run, {}, {} {:.4g} +- {:.2g} {}",
                      run.begin_s, run.end_s, run.turning ? "turning" : "surge",
                      by_sides ? fmt::format("force_left {:.4g}, force_right {:.4g}",
                                             run.sides.left, run.sides.right)
                               : fmt::format("wheel_force {:.4g}, steering {:.3g} deg",
                                             run.wheel_force, degrees(run.steering_rad)),
                      run.turning ? "yaw rate" : "speed", run.mean_rate, run.std_error,
                      run.turning ? "rad/s" : "m/s")};
}

}  // namespace

SteadyRuns steady_runs(const DrivingLog& log, const Vehicle& vehicle,
                       std::vector<Finding>& findings) {
  SteadyRuns runs;
  runs.surge.file = runs.turning.file = log.file;
  for (const RowSpan stretch : constant_commands(log)) {
    const auto run = steady_run(log, vehicle, stretch);
    if (!run) continue;
    if (run->turning) {
      runs.turning.rows.push_back(turning_row(*run, vehicle));
    } else {
      runs.surge.rows.push_back(
          {run->line, vehicle.driven_wheels() * run->wheel_force, run->mean_rate, {}, {}});
    }
    findings.push_back(note_of(*run, vehicle, log.file));
  }
  return runs;
}

std::vector<SteadyWheel> steady_wheels(const DrivingLog& log, const Vehicle& vehicle,
                                       const SteadyRule& rule) {
  const auto& speed = log[LogChannel::kSpeed];
  const auto& yaw_rate = log[LogChannel::kYawRate];
  if (!speed) return {};
  std::vector<SteadyWheel> wheels;
  for (RowSpan stretch : constant_commands(log)) {
    const double left = mean_of(log.force_left, stretch);
    const double right = mean_of(log.force_right, stretch);
    const auto u = steady_rest(log, *speed, rule, stretch);
    if (!u) continue;
    if (std::abs(left - right) <= kSameCommand) {
      wheels.push_back({0.5 * (left + right), u->mean, u->mean_error});
      continue;
    }
    const Line r = yaw_rate ? line_through(log, *yaw_rate, stretch) : Line{};
    if (!is_steady(r, rule.drift)) continue;
    const double d = vehicle.half_track_m;
    const double std_error = std::hypot(u->mean_error, d * r.mean_error);
    wheels.push_back({left, u->mean - d * r.mean, std_error, true});
    wheels.push_back({right, u->mean + d * r.mean, std_error, true});
  }
  return wheels;
}

}  // namespace awmr
