/// Simulates the model with the commands of a log ("replays" the log). The functions are templates
/// on the scalar type T: double for predictions, ceres::Jet for derivatives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/resolved_steps.h"
#include "awmr/model/sliding.h"
#include "awmr/model/tyres.h"
#include "awmr/trials/lagged_forces.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Part of a log without a gap: rows [begin, end).
struct LogWindow {
  const DrivingLog* log = nullptr;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Splits the log at its gaps, and each part into windows of equal length, at most `longest_s` plus
/// one median time step. Drops windows of fewer than 3 rows.
std::vector<LogWindow> windows_of(const DrivingLog& log, double longest_s);

/// Number of equal steps that divide a time span so that none is longer than `longest_step_s`.
inline int steps_in(double span_s, double longest_step_s) {
  return std::max(1, static_cast<int>(std::ceil(span_s / longest_step_s - 1e-9)));
}

/// Mean force over [t, t + h] of motors with lag. `delay_s`: latency of the commands; null if they
/// have none. If T is ceres::Jet, the result has the derivative with respect to the latency.
/// `command`: mean of the delayed command over [t, t + h]. If the motors have back-EMF and the
/// command is 0, the force is 0 without lag, because the motor is then switched off.
template <class T>
SideForces<T> lagged_force(const LaggedForces& lagged, const LogSignals& signals, double t_s,
                           double h_s, const T* delay_s, const SideForces<T>& command,
                           const Plant<T>& plant) {
  const double d = delay_s ? value_of(*delay_s) : 0.0;
  const LaggedForces::Mean mean = lagged.mean(signals, t_s, h_s, d);
  const bool switches_off = plant.back_emf_s_per_m > T(0.0);
  const auto side = [&](double force, double by_delay, const T& commanded) {
    if (switches_off && value_of(commanded) == 0.0) return T(0.0);
    return delay_s ? T(force) + by_delay * (*delay_s - T(d)) : T(force);
  };
  return {side(mean.force.left, mean.by_delay.left, command.left),
          side(mean.force.right, mean.by_delay.right, command.right)};
}

/// Advances `state` from the time `from_s` to `to_s`, both between `row` and the next row. The
/// commands are constant in this time: those of the row `acting`. Other arguments: see
/// replay_rows().
template <class T, class Step>
State<T> step_between(const LogSignals& signals, std::size_t row, std::size_t acting,
                      const T& from_s, const T& to_s, const Plant<T>& plant, const T* delay_s,
                      double longest_step_s, State<T> state, const LaggedForces* lagged,
                      Step step) {
  const DrivingLog& log = *signals.log;
  const bool servo = log.steering_command_rad.has_value();
  const double row_s = log.t_s[row];
  const double span_s = row + 1 < log.rows() ? log.t_s[row + 1] - row_s : 1.0;
  const double share = (value_of(from_s) - row_s) / span_s;
  const double end_share = (value_of(to_s) - row_s) / span_s;
  const int steps = steps_in(value_of(to_s) - value_of(from_s), longest_step_s);
  const T h = (to_s - from_s) / double(steps);
  for (int i = 0; i < steps; ++i) {
    SideForces<T> force{T(log.force_left[acting]), T(log.force_right[acting])};
    if (lagged) {
      const double at_s = value_of(from_s) + i * value_of(h);
      force = lagged_force(*lagged, signals, at_s, value_of(h), delay_s, force, plant);
    }
    if (!servo) {
      state.steering_rad =
          T(signals.angle_after(row, share + (end_share - share) * ((i + 0.5) / steps)));
    }
    const T steering = servo ? T((*log.steering_command_rad)[acting]) : state.steering_rad;
    state = step(state, h, force, steering);
  }
  return state;
}

/// Advances `state` from the time `from_s` to `to_s`, both between `row` and the next row. An
/// integration step ends where a delayed command changes, because servo limits and the dead zone
/// apply to each command, not to the mean over a step. Other arguments: see replay_rows().
template <class T, class Step>
State<T> advance_after_row(const LogSignals& signals, std::size_t row, T from_s, const T& to_s,
                           const Plant<T>& plant, const T* delay_s, double longest_step_s,
                           State<T> state, const LaggedForces* lagged, Step step) {
  const T delay = delay_s ? *delay_s : T(0.0);
  const double end_s = value_of(to_s) - value_of(delay);
  ActingRow acting(signals.log->t_s, value_of(from_s) - value_of(delay));
  const auto differ = [&](std::size_t a, std::size_t b) {
    return signals.forces_differ(a, b) || signals.steering_commands_differ(a, b);
  };
  for (;;) {
    const std::optional<double> change_s = acting.next_change_s(end_s, differ);
    const T until_s = change_s ? T(*change_s + delay) : to_s;
    if (!change_s || value_of(until_s) - value_of(from_s) > kSameTime_s) {
      state = step_between(signals, row, acting.row(), from_s, until_s, plant, delay_s,
                           longest_step_s, state, lagged, step);
      from_s = until_s;
    }
    if (!change_s) return state;
    acting.pass_change();
  }
}

/// Simulates the rows [begin, end) from the initial `state`, and calls visit(row, state) at each
/// row. `step(state, h_s, force, steering_rad)` returns the state after one integration step, which
/// is at most `longest_step_s` long. `delay_s`: latency of the commands, null for none. `lagged`:
/// forces of motors with lag, null for motors without. In a log without steering commands, the
/// simulation takes the logged steering angle as the actual angle, without delay.
template <class T, class Visit, class Step>
void replay_rows(const LogSignals& signals, std::size_t begin, std::size_t end,
                 const Plant<T>& plant, const T* delay_s, double longest_step_s, State<T> state,
                 Visit visit, const LaggedForces* lagged, Step step) {
  const DrivingLog& log = *signals.log;
  for (std::size_t row = begin; row < end; ++row) {
    if (!log.steering_command_rad) state.steering_rad = T(log[LogChannel::kSteering]->value[row]);
    visit(row, state);
    if (row + 1 == end) return;
    state = advance_after_row(signals, row, T(log.t_s[row]), T(log.t_s[row + 1]), plant, delay_s,
                              longest_step_s, state, lagged, step);
  }
}

/// Returns the plant with a steering stop of 10 rad if the log has a steering angle but no steering
/// command, so that no stop limits the logged angle. For other logs, returns the plant unchanged.
template <class T>
Plant<T> without_stop_of_logged_angle(Plant<T> plant, const DrivingLog& log) {
  if (!log.steering_command_rad) plant.steering_max_rad = T(10.0);
  return plant;
}

/// Integration step of the 3-DOF model along a log. Does not smooth Coulomb friction and tyre scrub
/// near rest, so that they can hold the vehicle (sliding.h).
template <class T>
class ModelStep {
 public:
  /// Precondition: `plant` is a result of resolved_beside_friction() for the longest step, which
  /// keeps such steps stable near rest.
  ModelStep(const Plant<T>& plant, const DrivingLog& log)
      : plant_(without_stop_of_logged_angle(plant, log)), friction_(friction_rates(plant_)) {
    if (friction_.any()) plant_ = without_friction(plant_);
  }
  /// The plant with the steering stop of without_stop_of_logged_angle(), and without Coulomb
  /// friction, which rates() and the integration step add.
  const Plant<T>& plant() const { return plant_; }
  /// Time derivatives of the state, with Coulomb friction.
  State<T> rates(const State<T>& at, const SideForces<T>& force, const T& steering) const {
    const State<T> free = state_rates(plant_, at, force, steering);
    return under_friction(force, [&](const auto& friction) {
      return with_friction<T>(friction.in(at), sliding(friction, at, free), free);
    });
  }
  State<T> operator()(const State<T>& from, const T& h, const SideForces<T>& force,
                      const T& steering) const {
    const auto free = [&](const State<T>& at) { return state_rates(plant_, at, force, steering); };
    return under_friction(
        force, [&](const auto& friction) { return step_with_friction(friction, from, h, free); });
  }

 private:
  /// Returns result(friction), with the friction of the vehicle at these forces.
  template <class ResultOf>
  State<T> under_friction(const SideForces<T>& force, const ResultOf& result) const {
    if (!(plant_.yaw_scrub_m > T(0.0))) return result(friction_);
    return result(FrictionWithScrub<T, SideForces<T>>{friction_, plant_, force});
  }

  Plant<T> plant_;
  FrictionRates<T> friction_;
};

/// Calls replay_rows() with the 3-DOF model. Precondition: `plant` fulfils the precondition of the
/// constructor of ModelStep.
template <class T, class Visit>
void replay(const LogSignals& signals, std::size_t begin, std::size_t end, const Plant<T>& plant,
            const T* delay_s, double longest_step_s, State<T> state, Visit visit,
            const LaggedForces* lagged = nullptr) {
  const ModelStep<T> step(plant, *signals.log);
  replay_rows(signals, begin, end, step.plant(), delay_s, longest_step_s, state, visit, lagged,
              step);
}

/// Calls replay_rows() with the four-wheel tyre model, without latency of the commands.
/// Precondition: `vehicle.body` is a result of resolved_at_rest_on_tyres(), which keeps the steps
/// stable near rest. Returns false if the tyres became too stiff for any step; the states from then
/// on are invalid.
template <class Visit>
bool replay(const LogSignals& signals, std::size_t begin, std::size_t end,
            FourWheels<double> vehicle, double longest_step_s, const State<double>& state,
            Visit visit, const LaggedForces* lagged = nullptr) {
  vehicle.body = without_stop_of_logged_angle(vehicle.body, *signals.log);
  Resolution<double> resolution;
  replay_rows<double>(
      signals, begin, end, vehicle.body, nullptr, longest_step_s, state, visit, lagged,
      [&](const State<double>& from, double h, const SideForces<double>& force, double steering) {
        const auto rates = [&](const State<double>& at) {
          return state_rates(vehicle, at, force, steering);
        };
        return advance(
            vehicle, from, h,
            [&](const State<double>& at, double length) { return rk4_step(at, length, rates); },
            true, 0, resolution);
      });
  return resolution.resolved;
}

/// Component of the state that a channel measures.
template <class T>
constexpr T State<T>::*component_of(LogChannel channel) {
  switch (channel) {
    case LogChannel::kX:
      return &State<T>::x_m;
    case LogChannel::kY:
      return &State<T>::y_m;
    case LogChannel::kHeading:
      return &State<T>::psi_rad;
    case LogChannel::kSpeed:
      return &State<T>::u_mps;
    case LogChannel::kSway:
      return &State<T>::v_mps;
    case LogChannel::kYawRate:
      return &State<T>::r_radps;
    case LogChannel::kSteering:
      break;
  }
  return &State<T>::steering_rad;
}

template <class T>
T& channel_of(State<T>& s, LogChannel channel) {
  return s.*component_of<T>(channel);
}
template <class T>
const T& channel_of(const State<T>& s, LogChannel channel) {
  return s.*component_of<T>(channel);
}

/// True if the row has a measurement of the channel to compare with the model. A steering angle
/// that is the model's input, because no servo command was logged, does not count.
bool is_measurement(const DrivingLog& log, LogChannel channel, std::size_t row);

/// Calls visit(channel, value) for each measurement in a row.
template <class Visit>
void each_measurement(const DrivingLog& log, std::size_t row, Visit visit) {
  for (const LogChannel channel : kChannels) {
    if (is_measurement(log, channel, row)) visit(channel, log[channel]->value[row]);
  }
}

/// Initial state of a window: the first measurement of each channel in it. If a channel has none,
///   - the yaw rate is derived from the heading;
///   - the heading and the speed are derived from the positions. The heading is the direction of
///     motion, or its opposite if the speed (without a speed, the commands) shows that the vehicle
///     moves backward;
///   - the steering angle is the steering command at the first row;
///   - any other component is 0.
State<double> measured_initial_state(const LogWindow& window);

/// Longest step of replay() that is accurate for this plant, s: the shorter of two steps. One is a
/// quarter of the shortest time constant of servo, sway and back-EMF braking; the other is the step
/// that the resistances of surge and yaw allow. With steps of a quarter of a time constant, the
/// Runge-Kutta method has a relative error of 3e-5 per time constant of an exponential decay.
double replay_step_s(const Plant<double>& plant);

/// Shortest permitted step, s. It resolves a time constant of 0.4 ms, shorter than that of any
/// effect visible in a log. Shorter steps would take too long.
inline constexpr double kShortestReplayStep_s = 1e-4;

/// Checks that replay() can simulate this plant. Errors (input): a time constant of the plant
/// requires steps below kShortestReplayStep_s; the message names this time constant. `file`: place
/// in the error.
Result<void> check_replay(const Plant<double>& plant, const std::string& file);

}  // namespace awmr
