#include "loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/simulate/physics.h"
#include "awmr/simulate/pilot.h"
#include "awmr/simulate/sensing.h"

namespace awmr::pil {
namespace {

using cli::Injection;

/// The firmware's pil_points.
constexpr std::size_t kMaxWaypoints = 16;

float single(double value) { return static_cast<float>(value); }

/// Waypoints that the chip's own guidance goes to; else the host leads and the chip gets a heading.
const WaypointCourse* course_for_chip(const Scenario& scenario) {
  const auto* course = std::get_if<WaypointCourse>(&scenario.guidance);
  const bool plain =
      course != nullptr && !course->skip_passed && !scenario.avoidance && !scenario.shaping;
  return plain ? course : nullptr;
}

Points points_of(const WaypointCourse& course) {
  Points points;
  points.acceptance_m = single(course.acceptance_m);
  for (const Position<double>& point : course.points_m) {
    points.points_m.push_back({single(point.x_m), single(point.y_m)});
  }
  return points;
}

std::size_t samples_of(const LoopSetup& setup) {
  return static_cast<std::size_t>(
      std::floor(setup.scenario.duration_s / setup.sample_time_s + 1e-9));
}

AutopilotInput input_of(const LoopSetup& setup, double t_s, const Sensed& sensed,
                        const Reference<double>& reference) {
  AutopilotInput in{};
  in.mode = static_cast<std::uint8_t>(setup.mode);
  in.measured = {single(sensed.motion.psi_rad), single(sensed.motion.u_mps),
                 single(sensed.motion.v_mps), single(sensed.motion.r_radps)};
  in.position_m = {single(sensed.position_m.x_m), single(sensed.position_m.y_m)};
  in.reference = {single(reference.psi_rad), single(reference.psi_rate_radps),
                  single(reference.psi_accel_radps2), single(reference.speed_mps),
                  single(reference.accel_mps2)};
  const auto now_ms = static_cast<std::uint32_t>(std::llround(t_s * 1000.0));
  in.times = {now_ms, now_ms, now_ms, now_ms};
  return in;
}

void inject(Injection injection, AutopilotInput& in) {
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
    case Injection::kStepLate:
    case Injection::kParameters:
    case Injection::kNone:
      break;
  }
}

/// A pause before a step: the clock is ahead from then on.
void delay(std::uint32_t by_ms, InputTimes& times) {
  times.now_ms += by_ms;
  times.heading_ms += by_ms;
  times.speed_ms += by_ms;
  times.command_ms += by_ms;
}

/// Moves the simulated vehicle on by a sample under the chip's command.
Status drive(Physics& physics, double t_s, const Allocation<float>& command,
             const std::string& scenario) {
  physics.disturb(t_s);
  physics.step(t_s,
               {static_cast<double>(command.force.left), static_cast<double>(command.force.right)},
               static_cast<double>(command.steering_rad));
  if (physics.resolved()) return {};
  return input_error(
      fmt::format("scenario '{}'", scenario),
      fmt::format("the simulated vehicle cannot go on after {:g} s: resistance is too stiff there "
                  "for any step, or a number is no longer finite",
                  t_s));
}

}  // namespace

bool chip_leads(const Scenario& scenario) { return course_for_chip(scenario) != nullptr; }

Status check_scenario(const Scenario& scenario, const std::string& file) {
  std::vector<Fault> faults;
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) {
    faults.push_back({file + ":/guidance",
                      "is open loop, which asks nothing of a controller: give "
                      "heading, waypoints, line or lissajous"});
  }
  if (scenario.actuators) faults.push_back({file + ":/actuators", "the firmware has none: remove"});
  if (scenario.control.observer) {
    faults.push_back({file + ":/control/observer", "the firmware has none: remove"});
  }
  if (scenario.control.split != CombinedSplit::kRedistribute) {
    faults.push_back({file + ":/control/combined_split", "the firmware always does: remove"});
  }
  if (scenario.control.allocation.value_or(AllocationForm::kExact) != AllocationForm::kExact) {
    faults.push_back({file + ":/control/allocation", "the firmware's is exact: remove"});
  }
  const WaypointCourse* course = course_for_chip(scenario);
  if (course != nullptr && course->points_m.size() > kMaxWaypoints) {
    faults.push_back({file + ":/guidance/points_m",
                      fmt::format("the firmware has room for {} waypoints, there are {}",
                                  kMaxWaypoints, course->points_m.size())});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

Window injection_window(const LoopSetup& setup) {
  const std::size_t middle = samples_of(setup) / 2;
  switch (setup.injection) {
    case Injection::kNone:
      return {0, 0};
    case Injection::kParameters:
      return {0, samples_of(setup) + 1};
    case Injection::kStepLate:
      return {middle, middle + 1};
    default:
      return {middle, middle + 20};
  }
}

std::uint8_t expected_fault(Injection injection) {
  switch (injection) {
    case Injection::kNaN:
    case Injection::kInfinite:
      return kFaultNotFinite;
    case Injection::kRange:
    case Injection::kMode:
      return kFaultRange;
    case Injection::kHeadingStale:
      return kFaultHeadingStale;
    case Injection::kSpeedStale:
      return kFaultSpeedStale;
    case Injection::kCommandTimeout:
      return kFaultCommandTimeout;
    case Injection::kStepLate:
      return kFaultStepLate;
    case Injection::kParameters:
      return kFaultParameters;
    case Injection::kNone:
      break;
  }
  return kFaultNone;
}

Result<std::vector<LoopRow>> run_loop(const LoopSetup& setup, Executor& executor) {
  const SimulateOptions options{.sample_time_s = setup.sample_time_s, .substeps = {}};
  Physics physics(setup.plant, setup.force_max, setup.scenario, options);
  Sensing sensing(setup.scenario.sensors, setup.sample_time_s, run_seed(setup.scenario.seed, 0, 0));
  Sensed sensed = sensing.at(0, physics.state());
  Pilot pilot(setup.scenario, setup.sample_time_s, sensed);
  const WaypointCourse* course = course_for_chip(setup.scenario);
  if (course != nullptr) {
    if (auto following = executor.follow(points_of(*course)); !following) {
      return tl::unexpected(following.error());
    }
  }
  const Window window = injection_window(setup);
  std::vector<LoopRow> rows;
  const std::size_t samples = samples_of(setup);
  for (std::size_t k = 0; k <= samples; ++k) {
    LoopRow& row = rows.emplace_back();
    row.t_s = static_cast<double>(k) * setup.sample_time_s;
    row.state = physics.state();
    if (k > 0) sensed = sensing.at(k, row.state);
    const Pilot::Order order = pilot.at(row.t_s, sensed);
    AutopilotInput input = input_of(setup, row.t_s, sensed, order.reference);
    if (k >= window.first && k < window.last) inject(setup.injection, input);
    if (setup.injection == Injection::kStepLate && k >= window.first) delay(10'000, input.times);
    auto step = executor.step(input);
    if (!step) return tl::unexpected(step.error());
    row.step = *step;
    const bool ended =
        course != nullptr ? step->output.arrived : order.finished || order.no_passage;
    if (ended || k == samples) break;
    AWMR_RETURN_IF_ERROR(drive(physics, row.t_s, step->output.command, setup.scenario.name));
  }
  return rows;
}

}  // namespace awmr::pil
