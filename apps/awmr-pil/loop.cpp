#include "loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "awmr/emit/board/arming.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario_guidance.h"
#include "awmr/simulate/sensing.h"
#include "command_injection.h"
#include "injections.h"
#include "sensor_injection.h"

namespace awmr::pil {
namespace {

using cli::Injection;

float single(double value) { return static_cast<float>(value); }

/// Returns the chip's input at the time `t_s`. The chip itself applies obstacle avoidance and
/// heading shaping, so it gets the reference heading without them. A chip that follows points or a
/// path ignores this heading. The reference speed is 0 at the end of the path, or if obstacles
/// leave no passage.
AutopilotInput input_of(const LoopSetup& setup, double t_s, const Sensed& sensed,
                        const GuidanceOutput& output) {
  const bool stops = output.finished || output.no_passage;
  AutopilotInput in{};
  in.mode = static_cast<std::uint8_t>(setup.mode);
  in.measured = {single(sensed.motion.psi_rad), single(sensed.motion.u_mps),
                 single(sensed.motion.v_mps), single(sensed.motion.r_radps)};
  in.position_m = {single(sensed.position_m.x_m), single(sensed.position_m.y_m)};
  in.reference.psi_rad = single(output.path.psi_goal_rad);
  in.reference.speed_mps = stops ? 0.0F : single(setup.scenario.speed_mps);
  const auto now_ms = static_cast<std::uint32_t>(std::llround(t_s * 1000.0));
  in.times = {now_ms, now_ms, now_ms, now_ms};
  in.speed_unsigned = has_unsigned_speed(setup.scenario) ? 1 : 0;
  in.position_is_fix = estimates_position(setup.scenario) ? 1 : 0;
  in.fix_ms = static_cast<std::uint32_t>(std::llround(sensed.fix_taken_s * 1000.0));
  return in;
}

/// Age that is added to the last command while the vehicle is disarmed, ms. It exceeds every
/// timeout, so the control step gives the safe command, as on the board of a disarmed vehicle.
constexpr std::uint32_t kSilence_ms = 4'000'000;

void inject(Injection injection, AutopilotInput& in) {
  // Age of an input, and length of a pause, that are injected, ms.
  constexpr std::uint32_t kLong_ms = 10'000;
  switch (injection) {
    case Injection::kNaN:
      in.measured.r_radps = std::numeric_limits<float>::quiet_NaN();
      break;
    case Injection::kInfinite:
      in.measured.u_mps = -std::numeric_limits<float>::infinity();
      break;
    case Injection::kRange:
      in.measured.u_mps = 1000.0F;
      break;
    case Injection::kMode:
      in.mode = 3;
      break;
    case Injection::kHeadingStale:
      in.times.heading_ms -= kLong_ms;
      break;
    case Injection::kSpeedStale:
      in.times.speed_ms -= kLong_ms;
      break;
    case Injection::kCommandTimeout:
      in.times.command_ms -= kLong_ms;
      break;
    default:
      break;
  }
}

/// Injects a pause of `by_ms` before a step by advancing the clock. The time stamps of the inputs
/// advance too: their age stays the same, so that only the pause is a fault.
void delay(std::uint32_t by_ms, InputTimes& times) {
  times.now_ms += by_ms;
  times.heading_ms += by_ms;
  times.speed_ms += by_ms;
  times.command_ms += by_ms;
}

/// Sets the actuators' forces and steering angle: the chip's command, rounded to their resolution.
void command(const LoopSetup& setup, LoopRow& row) {
  const Allocation<float>& requested = row.step.output.command;
  row.force = {static_cast<double>(requested.force.left),
               static_cast<double>(requested.force.right)};
  row.steering_command_rad = static_cast<double>(requested.steering_rad);
  if (setup.scenario.actuators) {
    quantise(*setup.scenario.actuators, setup.force_max, row.force, row.steering_command_rad);
  }
}

/// Injects a wiring error: the motors are reversed, and left and right are exchanged. Each side
/// gets the negative force of the other side. The vehicle then turns as commanded, but drives in
/// the opposite direction.
void reverse_motors(LoopRow& row) { row.force = {-row.force.right, -row.force.left}; }

void swap_sides(LoopRow& row) { row.force = {row.force.right, row.force.left}; }

/// Applies an injected failure of the motors or the servo to the forces and the steering angle.
void fail_actuators(Injection injection, LoopRow& row) {
  if (injection == Injection::kMotorsReversed) reverse_motors(row);
  if (injection == Injection::kSidesSwapped) swap_sides(row);
  if (injection == Injection::kSteeringStuck) row.steering_command_rad = 0.0;
  if (injection == Injection::kServoReversed) row.steering_command_rad *= -1.0;
}

/// A failure of a sensor or of the operator's line, which must disarm the vehicle, and the board's
/// arming that does so.
class DisarmingFailure {
 public:
  explicit DisarmingFailure(const LoopSetup& setup)
      : is_of_commands_(is_command_failure(setup.injection)),
        sensors_(setup.injection, setup.sample_time_s, setup.gps_limits),
        commands_(setup.injection) {
    arming_.arm(kFaultNone, kSensorGood);
  }

  /// Changes the input of step `k`, with the failure if `fails`. `before`: the row of the previous
  /// step; null in the first step. Returns the sensor check that detects a failure.
  SensorFault step(std::size_t k, bool fails, const LoopRow* before, AutopilotInput& input) {
    SensorFault cause = kSensorGood;
    if (is_of_commands_) {
      commands_.step(fails, arming_, input.times);
    } else {
      const Commanded commanded =
          before && arming_.is_armed()
              ? Commanded{before->step.output.tau_turn_m, before->step.output.psi_ref_rad}
              : Commanded{0.0F, input.reference.psi_rad};
      cause = sensors_.step(k, fails, commanded, input);
    }
    if (!arming_.is_armed()) input.times.command_ms -= kSilence_ms;
    return cause;
  }

  void observe(const LoopRow& row) { arming_.observe(row.step.output.fault, row.cause); }

 private:
  bool is_of_commands_;
  CheckedSensors sensors_;
  CheckedCommands commands_;
  Arming arming_;
};

/// The vehicle, its sensors and its guidance in double, from sample to sample.
class SimulatedDrive {
 public:
  explicit SimulatedDrive(const LoopSetup& setup)
      : setup_(setup),
        physics_(setup.plant, setup.force_max, setup.scenario,
                 {.sample_time_s = setup.sample_time_s}),
        sensing_(setup.scenario.sensors, setup.sample_time_s, run_seed(setup.scenario.seed, 0, 0)),
        positioning_(setup.scenario, setup.sample_time_s),
        guidance_(setup.scenario, setup.sample_time_s) {}

  /// Measures the state of sample `k` at the time `row.t_s`, and stores it in `row`. Returns the
  /// chip's input.
  AutopilotInput measure(std::size_t k, LoopRow& row) {
    row.state = physics_.state();
    const Sensed sensed = sensing_.at(k, row.state);
    Sensed located = sensed;  // with the estimated position, for the guidance
    located.position_m = positioning_.step(row.t_s, sensed);
    guided_ = guidance_.step(row.t_s, located);
    return input_of(setup_, row.t_s, sensed, guided_);
  }
  bool has_no_passage() const { return guided_.no_passage; }

  /// Moves the vehicle over one sample, with the forces and the steering angle of `row`.
  Status move(const LoopRow& row) {
    physics_.step(row.t_s, row.force, row.steering_command_rad);
    if (physics_.resolved()) return {};
    return input_error(
        ErrorCode::kDiverges, fmt::format("scenario '{}'", setup_.scenario.name),
        fmt::format("the simulation cannot continue after {:g} s: the resistance is too stiff for "
                    "the shortest integration step, or a value is not finite. Check the model and "
                    "the gains",
                    row.t_s));
  }

 private:
  const LoopSetup& setup_;
  Physics physics_;
  Sensing sensing_;
  Positioning positioning_;
  ScenarioGuidance guidance_;
  GuidanceOutput guided_;
};

}  // namespace

void know_receiver(const Gps& gps, Model& model) {
  model.vehicle.sensors.position_m = fix_noise_m(gps);
  model.vehicle.sensors.position_latency_s = gps.latency_s;
}

bool has_unsigned_speed(const Scenario& scenario) {
  return scenario.sensors && !scenario.sensors->speed_signed;
}

Status check_scenario(const Scenario& scenario, const std::string& file) {
  std::vector<Fault> faults;
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) {
    faults.push_back({ErrorCode::kUnsupported, file + ":/guidance",
                      "is open loop, but the firmware always runs its controller; give a guidance "
                      "of type heading, waypoints, line or lissajous"});
  }
  if (scenario.held_tau_speed()) {
    faults.push_back({ErrorCode::kUnsupported, file + ":/guidance/tau_speed",
                      "tau_speed sets a constant thrust, but the firmware controls the speed: "
                      "remove tau_speed, and give speed_mps"});
  }
  if (scenario.control.allocation.value_or(AllocationForm::kExact) != AllocationForm::kExact) {
    faults.push_back({ErrorCode::kUnsupported, file + ":/control/allocation",
                      "the firmware supports only the exact allocation of forces and steering "
                      "angle: remove this key"});
  }
  if (scenario.control.lqi) {
    faults.push_back({ErrorCode::kUnsupported, file + ":/control/heading_law",
                      "the firmware supports only the sliding-mode heading law: remove this key, "
                      "or set its type to sliding_mode"});
  }
  const std::size_t points = mission_of(scenario).points.points_m.size();
  if (points > kMaxPoints) {
    faults.push_back({ErrorCode::kTooLarge, file + ":/guidance/points_m",
                      fmt::format("the firmware stores at most {} points of a path, found {}; use "
                                  "fewer",
                                  kMaxPoints, points)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

Result<std::vector<LoopRow>> run_loop(const LoopSetup& setup, Executor& executor,
                                      const Progress& progress) {
  SimulatedDrive drive(setup);
  if (!setup.mission.points.points_m.empty()) {
    AWMR_RETURN_IF_ERROR(executor.follow(setup.mission.points));
  }
  const std::size_t samples = samples_in(setup.scenario.duration_s, setup.sample_time_s);
  const Window window = injection_window(setup.injection, setup.middle, samples);
  std::optional<DisarmingFailure> failure;
  if (disarms(setup.injection)) failure.emplace(setup);
  std::vector<LoopRow> rows;
  for (std::size_t k = 0; k <= samples; ++k) {
    LoopRow row;
    row.t_s = static_cast<double>(k) * setup.sample_time_s;
    const bool has_begun = k >= window.first;
    AutopilotInput input = drive.measure(k, row);
    if (failure) {
      row.cause = failure->step(k, has_begun, rows.empty() ? nullptr : &rows.back(), input);
    } else if (has_begun && k < window.last) {
      inject(setup.injection, input);
    }
    if (setup.injection == Injection::kStepLate && has_begun) delay(10'000, input.times);
    if (std::binary_search(setup.resets.begin(), setup.resets.end(), k)) {
      AWMR_RETURN_IF_ERROR(executor.reset());
    }
    AWMR_ASSIGN_OR_RETURN(row.step, executor.step(input));
    if (failure) failure->observe(row);
    command(setup, row);
    if (has_begun) fail_actuators(setup.injection, row);
    rows.push_back(row);
    if (progress) progress(k, samples);
    if (row.step.output.arrived || drive.has_no_passage() || k == samples) break;
    AWMR_RETURN_IF_ERROR(drive.move(row));
  }
  return rows;
}

}  // namespace awmr::pil
