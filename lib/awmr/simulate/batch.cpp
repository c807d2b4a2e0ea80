#include "awmr/simulate/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

#include "awmr/model/rest.h"
#include "awmr/simulate/lanes/kernels.h"
#include "awmr/simulate/metering.h"
#include "awmr/simulate/one_run.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/pilot.h"
#include "awmr/simulate/sensing.h"

namespace awmr {
namespace {

using lanes::Block;
using lanes::Kernel;
using lanes::kLanes;
using lanes::Row;

static_assert(kBatchRuns == kLanes);

/// A struct of numbers alone, out of one of rows, and into it: the numbers of one lane.
template <class Numbers, class Rows>
Numbers lane_of(const Rows& rows, std::size_t lane) {
  static_assert(sizeof(Numbers) / sizeof(double) == sizeof(Rows) / sizeof(Row));
  double values[sizeof(Numbers) / sizeof(double)];
  for (std::size_t i = 0; i < std::size(values); ++i) {
    std::memcpy(&values[i],
                reinterpret_cast<const char*>(&rows) + i * sizeof(Row) + lane * sizeof(double),
                sizeof(double));
  }
  Numbers numbers;
  std::memcpy(&numbers, values, sizeof numbers);
  return numbers;
}
template <class Numbers, class Rows>
void put(const Numbers& numbers, std::size_t lane, Rows& rows) {
  static_assert(sizeof(Numbers) / sizeof(double) == sizeof(Rows) / sizeof(Row));
  for (std::size_t i = 0; i < sizeof(Numbers) / sizeof(double); ++i) {
    std::memcpy(reinterpret_cast<char*>(&rows) + i * sizeof(Row) + lane * sizeof(double),
                reinterpret_cast<const char*>(&numbers) + i * sizeof(double), sizeof(double));
  }
}

/// What goes on by itself in a lane.
struct LaneParts {
  Sensing sensing;
  RunDisturbance disturbance;
  Sensed sensed = {};
  std::optional<Pilot> pilot = {};  ///< once the first sample is sensed
  CourseRow course = {};            ///< as the pilot ordered it last
  Run run = {};                     ///< its rows, where they are kept
  RunEnd ordered =
      RunEnd::kDuration;  ///< how the present sample ends the run; kDuration: it goes on
};

/// Up to kLanes runs of a scenario, driven together.
struct Batch {
  const Scenario& scenario;
  double sample_time_s;
  const Kernel& kernel;
  bool keeps_rows;
  std::unique_ptr<Block> block = std::make_unique<Block>();
  std::vector<LaneParts> parts = {};             ///< by run
  std::vector<std::optional<Ending>> ends = {};  ///< by run; none: it goes on, or it failed
  double goal_before_rad = 0.0;

  bool is_active(std::size_t lane) const { return block->active.lane[lane] > 0.0; }
};

template <class Body>
void for_active(const Batch& batch, const Body& body) {
  for (std::size_t lane = 0; lane < batch.parts.size(); ++lane) {
    if (batch.is_active(lane)) body(lane);
  }
}

/// Where the guidance is the same for all runs and no row tells of it, none of them has a pilot of its
/// own.
bool has_pilots(const Batch& batch) {
  const Scenario& scenario = batch.scenario;
  if (batch.block->setup.is_open_loop) return false;
  return batch.keeps_rows || !std::holds_alternative<HeadingSteps>(scenario.guidance) ||
         scenario.avoidance || scenario.shaping;
}

void set_up_lane(Batch& batch, const BatchRun& run, std::size_t lane) {
  Block& block = *batch.block;
  const Controller<double> controller = controller_in(batch.scenario, run.controller);
  const RunController<double> laws =
      run_controller(batch.scenario, run.controller, run.mode, batch.sample_time_s);
  const int substeps = substeps_for(run.plant, batch.scenario, batch.sample_time_s);
  const double step_s = batch.sample_time_s / substeps;
  put(laws.split.steering_share, lane, block.steering_share);
  put(resolved_at_rest(run.plant, batch.scenario, step_s), lane, block.plant);
  put(step_s, lane, block.step_s);
  put(static_cast<double>(substeps), lane, block.substeps);
  put(laws.laws, lane, block.controller);
  put(laws.observers.yaw, lane, block.yaw_observer);
  put(laws.observers.surge, lane, block.surge_observer);
  block.setup.anti_windup = laws.observers.anti_windup;
  block.setup.is_observed = block.setup.is_observed || laws.is_observed;
  put(laws.lqi, lane, block.lqi);
  put(laws.dead_zone, lane, block.dead_zone);
  put(laws.back_emf_s_per_m, lane, block.back_emf);
  block.setup.has_back_emf =
      block.setup.has_back_emf || run.plant.back_emf_s_per_m > 0.0 || laws.back_emf_s_per_m > 0.0;
  block.setup.has_scrub = block.setup.has_scrub || run.plant.yaw_scrub_m > 0.0;
  put(largest_force(controller), lane, block.force_most);
  put(metered_vehicle(controller.limits), lane, block.metered);
  put(batch.scenario.initial, lane, block.state);
  put(laws.tau_speed, lane, block.tau_speed);
  put(laws.tau_turn_m, lane, block.tau_turn_m);
}

/// All of a block. A lane without a run is a copy of the first, so that its numbers are harmless.
Batch set_up(std::span<const BatchRun> runs, const Scenario& scenario, double sample_time_s,
             const Kernel& kernel, bool keeps_rows) {
  Batch batch{scenario, sample_time_s, kernel, keeps_rows};
  Block& block = *batch.block;
  const Controller<double> controller = controller_in(scenario, runs.front().controller);
  block.setup.split = controller.limits.split;
  block.setup.form = controller.limits.form;
  block.setup.is_open_loop = std::holds_alternative<OpenLoop>(scenario.guidance);
  block.setup.holds_tau_speed = scenario.held_tau_speed().has_value();
  block.setup.is_lqi = scenario.control.lqi.has_value();
  block.setup.sample_time_s = sample_time_s;
  block.setup.lag = motor_lag(scenario.actuators, sample_time_s);
  block.setup.is_by_wheel = forces_differ_by_wheel(scenario);
  block.setup.course = metered_course(scenario);
  block.setup.tyres = scenario.tyres.value_or(Tyres<double>{});
  for (std::size_t lane = 0; lane < kBatchRuns; ++lane) {
    const bool has_run = lane < runs.size();
    set_up_lane(batch, has_run ? runs[lane] : runs.front(), lane);
    put(has_run ? 1.0 : 0.0, lane, block.active);
  }
  for (const BatchRun& run : runs) {
    const RunSeed seed = run_seed(scenario.seed, run.seed, run.sample);
    batch.parts.push_back({Sensing(scenario.sensors, sample_time_s, seed, run.noise),
                           RunDisturbance(scenario.disturbance, sample_time_s, seed)});
  }
  batch.ends.resize(runs.size());
  return batch;
}

/// Measurements of the controllers.
void sense(Batch& batch, std::size_t k) {
  Block& block = *batch.block;
  if (!batch.scenario.sensors) {
    block.measured = {block.state.psi_rad, block.state.u_mps, block.state.v_mps,
                      block.state.r_radps};
    if (!has_pilots(batch) && !batch.keeps_rows) return;
  }
  for_active(batch, [&](std::size_t lane) {
    LaneParts& parts = batch.parts[lane];
    parts.sensed = parts.sensing.at(k, lane_of<State<double>>(block.state, lane));
    put(parts.sensed.motion, lane, block.measured);
  });
}

/// d_hat = 0 for what the sensors say first.
void start_observing(Block& block) {
  for (std::size_t lane = 0; lane < kBatchRuns; ++lane) {
    const auto laws = lane_of<PreparedController<double>>(block.controller, lane);
    const auto measured = lane_of<Measurement<double>>(block.measured, lane);
    const Observers<double> observers{
        lane_of<DisturbanceObserver<double>>(block.yaw_observer, lane),
        lane_of<DisturbanceObserver<double>>(block.surge_observer, lane), block.setup.anti_windup};
    put(start_observers(observers, observed_motion(laws, measured).momentum), lane, block.observed);
  }
}

void follow(Batch& batch, std::size_t lane, const Pilot::Order& order) {
  Block& block = *batch.block;
  const auto state = lane_of<State<double>>(block.state, lane);
  batch.parts[lane].course = order.course;
  put(order.reference, lane, block.reference);
  put(order.course.psi_goal_rad, lane, block.goal_rad);
  put(order.course.cross_track_m, lane, block.cross_track_m);
  put(distance_m(order.course.target_m, {state.x_m, state.y_m}), lane, block.off_target_m);
  RunEnd& ordered = batch.parts[lane].ordered;
  if (order.no_passage && std::abs(state.u_mps) < kStopped_mps) {
    ordered = RunEnd::kNoPassage;
  } else if (order.finished) {
    ordered = RunEnd::kFinished;
  }
}

/// References of the laws.
void guide(Batch& batch, std::size_t k, double t_s) {
  Block& block = *batch.block;
  if (has_pilots(batch)) {
    for_active(batch, [&](std::size_t lane) {
      LaneParts& parts = batch.parts[lane];
      if (k == 0) parts.pilot.emplace(batch.scenario, batch.sample_time_s, parts.sensed);
      follow(batch, lane, parts.pilot->at(t_s, parts.sensed));
    });
  } else if (const auto* steps = std::get_if<HeadingSteps>(&batch.scenario.guidance)) {
    block.goal_rad = Row(heading_at(*steps, t_s));
    block.reference.psi_rad = block.goal_rad;
    block.reference.speed_mps = Row(batch.scenario.speed_mps);
  }
}

void quantise_commands(Batch& batch) {
  Block& block = *batch.block;
  if (!batch.scenario.actuators) return;
  for_active(batch, [&](std::size_t lane) {
    auto force = lane_of<SideForces<double>>(block.force, lane);
    quantise(*batch.scenario.actuators, block.force_most.lane[lane], force,
             block.steering_command_rad.lane[lane]);
    put(force, lane, block.force);
  });
}

/// The row of the sample, but for the disturbance over it.
RunRow row_of(const Batch& batch, std::size_t lane, double t_s) {
  const Block& block = *batch.block;
  const LaneParts& parts = batch.parts[lane];
  const auto reference = lane_of<Reference<double>>(block.reference, lane);
  return {.t_s = t_s,
          .state = lane_of<State<double>>(block.state, lane),
          .force = lane_of<SideForces<double>>(block.force, lane),
          .steering_command_rad = block.steering_command_rad.lane[lane],
          .tau_speed = block.tau_speed.lane[lane],
          .tau_turn_m = block.tau_turn_m.lane[lane],
          .psi_ref_rad = reference.psi_rad,
          .u_ref_mps = reference.speed_mps,
          .course = parts.course,
          .measured = parts.sensed.motion,
          .measured_position_m = parts.sensed.position_m,
          .clearance_m = block.clearance_m.lane[lane],
          .tyre_power_mps = block.sums.tyre_power_mps.lane[lane],
          .acting = block.setup.is_by_wheel
                        ? lane_of<WheelForces<double>>(block.wheels, lane)
                        : at_all_wheels(lane_of<SideForces<double>>(block.arriving, lane),
                                        block.plant.rear_driven.lane[lane])};
}

/// Takes the sample into the metrics, and ends the runs that it ends.
void meter_sample(Batch& batch, std::size_t k, std::size_t samples, double t_s) {
  Block& block = *batch.block;
  const Scenario& scenario = batch.scenario;
  if (!scenario.obstacles.empty()) {
    for_active(batch, [&](std::size_t lane) {
      put(clearance_m(scenario, lane_of<State<double>>(block.state, lane)), lane,
          block.clearance_m);
    });
  }
  const auto* steps = std::get_if<HeadingSteps>(&scenario.guidance);
  const double goal_rad = steps ? heading_at(*steps, t_s) : 0.0;
  block.sample.time = {
      .t_s = t_s,
      .since_last_s = k == 0 ? 0.0 : t_s - static_cast<double>(k - 1) * batch.sample_time_s,
      .is_first = k == 0,
      .starts_step = k == 0 || goal_rad < batch.goal_before_rad || goal_rad > batch.goal_before_rad,
      .is_in_second_half =
          std::holds_alternative<LissajousCourse>(scenario.guidance) && k >= (samples + 1) / 2};
  batch.goal_before_rad = goal_rad;
  batch.kernel.measure(block);
  for_active(batch, [&](std::size_t lane) {
    LaneParts& parts = batch.parts[lane];
    if (batch.keeps_rows) parts.run.rows.push_back(row_of(batch, lane, t_s));
    if (parts.ordered == RunEnd::kDuration && k < samples) return;
    if (batch.keeps_rows) parts.run.rows.back().disturbance = parts.disturbance.next(t_s);
    batch.ends[lane] = {parts.ordered, t_s, parts.pilot ? parts.pilot->missed() : 0};
    put(0.0, lane, block.active);
  });
}

/// Over the sample that begins at `t_s`, with the commands held.
void move(Batch& batch, double t_s) {
  Block& block = *batch.block;
  const Scenario& scenario = batch.scenario;
  const Push<double> push = push_of(scenario.disturbance, {});
  block.sample.is_loaded = push.is_loaded;
  block.sample.is_sloped = push.is_sloped;
  block.sample.slope_accel_mps2 = push.slope_accel_mps2;
  block.sample.slope_downhill_rad = push.slope_downhill_rad;
  block.sample.has_battery = scenario.battery.has_value();
  if (scenario.battery) {
    block.sample.battery_sag = scenario.battery->sag;
    block.sample.battery_share = battery_share(*scenario.battery, t_s);
  }
  if (push.is_loaded) {
    for_active(batch, [&](std::size_t lane) {
      LaneParts& parts = batch.parts[lane];
      const BodyLoad load = parts.disturbance.next(t_s);
      put(load, lane, block.load);
      if (batch.keeps_rows) parts.run.rows.back().disturbance = load;
    });
  }
  batch.kernel.drive(block);
  if (block.setup.is_by_wheel) {
    for_active(batch, [&](std::size_t lane) {
      put(at_the_ground(scenario, lane_of<Plant<double>>(block.plant, lane),
                        lane_of<State<double>>(block.state, lane), t_s,
                        lane_of<SideForces<double>>(block.arriving, lane)),
          lane, block.wheels);
    });
  }
  batch.kernel.move(block);
}

bool is_finite(const MeterSums<double>& sums) {
  double values[sizeof(MeterSums<double>) / sizeof(double)];
  std::memcpy(values, &sums, sizeof sums);
  return std::all_of(std::begin(values), std::end(values),
                     [](double value) { return std::isfinite(value); });
}

/// Drives the runs to their ends. The metrics of each; none where it failed.
std::vector<std::optional<Metrics>> drive(Batch& batch) {
  Block& block = *batch.block;
  const std::size_t samples = samples_in(batch.scenario.duration_s, batch.sample_time_s);
  if (batch.keeps_rows) {
    for_active(batch, [&](std::size_t lane) { batch.parts[lane].run.rows.reserve(samples + 1); });
  }
  const auto goes_on = [&] {
    return std::any_of(std::begin(block.active.lane), std::end(block.active.lane),
                       [](double active) { return active > 0.0; });
  };
  for (std::size_t k = 0; k <= samples && goes_on(); ++k) {
    const double t_s = static_cast<double>(k) * batch.sample_time_s;
    sense(batch, k);
    if (k == 0 && block.setup.is_observed) start_observing(block);
    guide(batch, k, t_s);
    batch.kernel.control(block);
    quantise_commands(batch);
    meter_sample(batch, k, samples, t_s);
    move(batch, t_s);
  }
  std::vector<std::optional<Metrics>> metrics;
  for (std::size_t lane = 0; lane < batch.ends.size(); ++lane) {
    const auto sums = lane_of<MeterSums<double>>(block.sums, lane);
    const auto& end = batch.ends[lane];
    metrics.emplace_back();
    if (!end || !is_finite(sums)) continue;
    metrics.back() = metrics_of(sums, *end, batch.scenario);
    Run& run = batch.parts[lane].run;
    run.substeps = static_cast<int>(block.substeps.lane[lane]);
    run.end = end->end;
    run.missed_waypoints = end->missed_waypoints;
  }
  return metrics;
}

/// The lanes know no other allocation.
bool all_wheels_driven(std::span<const BatchRun> runs) {
  return std::ranges::all_of(
      runs, [](const BatchRun& run) { return run.controller.limits.is_rear_driven; });
}

DrivenRun one_by_one(const BatchRun& run, const Scenario& scenario, double sample_time_s) {
  DrivenRun driven{
      .run = simulate(
          run.plant, run.controller, scenario, run.mode,
          {.sample_time_s = sample_time_s, .substeps = {}, .seed = run.seed, .sample = run.sample}),
      .metrics = {}};
  driven.metrics = metrics_of(driven.run, scenario, run.controller);
  return driven;
}

const Kernel* kernel_of(const BatchArithmetic& arithmetic) {
  for (const Kernel* one : lanes::supported_kernels()) {
    if (one->name == arithmetic.instructions) return one;
  }
  return nullptr;
}

/// Calls take(i, metrics, run) for each run, without metrics where a run failed or no kernel drives it.
template <class Take>
void drive_by_blocks(std::span<const BatchRun> runs, const Scenario& scenario, double sample_time_s,
                     const BatchArithmetic& arithmetic, bool keeps_rows, const Take& take) {
  const Kernel* const kernel = kernel_of(arithmetic);
  for (std::size_t first = 0; first < runs.size(); first += kBatchRuns) {
    const auto block = runs.subspan(first, std::min(kBatchRuns, runs.size() - first));
    if (!kernel || !all_wheels_driven(block)) {
      for (std::size_t i = 0; i < block.size(); ++i) take(first + i, std::nullopt, Run{});
      continue;
    }
    Batch batch = set_up(block, scenario, sample_time_s, *kernel, keeps_rows);
    const std::vector<std::optional<Metrics>> metrics = drive(batch);
    for (std::size_t i = 0; i < block.size(); ++i) {
      take(first + i, metrics[i], std::move(batch.parts[i].run));
    }
  }
}

}  // namespace

Result<BatchArithmetic> batch_arithmetic() {
  const char* asked = std::getenv("AWMR_INSTRUCTIONS");
  const auto kernels = lanes::supported_kernels();
  const std::string_view name = asked ? asked : kernels.empty() ? "scalar" : kernels.front()->name;
  if (name == "scalar") return BatchArithmetic{"scalar", "scalar"};
  std::string known = "scalar";
  for (const Kernel* kernel : kernels) {
    if (name == kernel->name) return BatchArithmetic{kernel->name, "fused"};
    known += fmt::format(", {}", kernel->name);
  }
  return input_error(
      "AWMR_INSTRUCTIONS",
      fmt::format("'{}' is none that this processor and program have: {}", name, known));
}

std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic) {
  std::vector<Result<Metrics>> results;
  drive_by_blocks(
      runs, scenario, sample_time_s, arithmetic, false,
      [&](std::size_t i, const std::optional<Metrics>& metrics, const Run&) {
        if (metrics) {
          results.emplace_back(*metrics);
          return;
        }
        // A run that failed is reported by simulate(), or saved by it.
        const DrivenRun one = one_by_one(runs[i], scenario, sample_time_s);
        const Status failure = failure_of(one.run, scenario);
        results.push_back(failure ? Result<Metrics>(one.metrics) : tl::unexpected(failure.error()));
      });
  return results;
}

std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic) {
  std::vector<DrivenRun> driven;
  drive_by_blocks(runs, scenario, sample_time_s, arithmetic, true,
                  [&](std::size_t i, const std::optional<Metrics>& metrics, Run run) {
                    driven.push_back(metrics ? DrivenRun{std::move(run), *metrics}
                                             : one_by_one(runs[i], scenario, sample_time_s));
                  });
  return driven;
}

}  // namespace awmr
