/// Simulates the closed loop, for a single run (Row = double) or sixteen at a time (lanes::Row):
///   sensors -> guidance -> controller -> actuators -> rows and metrics -> vehicle
/// Sensors, guidance, disturbances and the ground are computed for one run after the other.
/// Controller, motors, motion and metrics are computed for all runs at once, by the functions in
/// loop_steps.h and vehicle_steps.h. Private to this folder.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "awmr/simulate/batch.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/loop_steps.h"
#include "awmr/simulate/metering.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario_guidance.h"
#include "awmr/simulate/sensing.h"

namespace awmr {

/// Speed |u|, m/s, below which a vehicle counts as stopped. If no way to the target is left between
/// obstacles, the run of a stopped vehicle ends with RunEnd::kNoPassage.
inline constexpr double kStopped_mps = 1e-3;

/// Returns the controller with the settings that the scenario requests: form of the allocation, and
/// split of the yaw moment in combined mode.
Controller<double> controller_in(const Scenario& scenario, Controller<double> controller);

/// Returns the controller properties that all runs of a scenario share, from the `controller` of
/// any run. is_observed stays false, because it depends on the gains of each run.
ControllerSetup controller_setup(const Scenario& scenario, const Controller<double>& controller,
                                 double sample_time_s);

/// Returns the controller of a run in this yaw mode. `controller`: the result of controller_in().
RunController<double> run_controller(const Scenario& scenario, const Controller<double>& controller,
                                     YawMode mode);

/// The functions of loop_steps.h for a single run.
inline constexpr LoopSteps<double> kOneRunSteps = {
    "scalar", [](LoopRuns<double>& runs) { steps::control(OneRun{}, runs); },
    [](LoopRuns<double>& runs) { steps::measure(OneRun{}, runs); }, kOneVehicleSteps};

/// Options of the closed loop.
struct LoopOptions {
  double sample_time_s = 0.01;
  std::size_t samples = 0;           ///< index of the last sample; the first has the index 0
  std::optional<int> substeps = {};  ///< RK4 steps per sample; absent: as substeps_for() computes
  /// true: the rows of each run are stored, and take_run() returns them
  bool keeps_rows = false;
  bool has_metrics = false;  ///< metrics() may be called
};

/// Runs of one scenario that are simulated together.
template <class Row>
class ClosedLoop {
 public:
  /// `steps`: the functions that compute controller, motors, motion and metrics of one control
  /// sample for all runs at once. They are compiled for this Row: for a single run (double), or for
  /// a row of numbers, one per run (lanes::Row). Precondition: there are 1 to kRunsOf<Row> runs,
  /// and scenario and steps outlive the loop.
  ClosedLoop(std::span<const BatchRun> runs, const Scenario& scenario, const LoopSteps<Row>& steps,
             const LoopOptions& options);

  /// Simulates all runs until they end. Call it once.
  void drive();

  /// Returns the result of a run after drive(). Call it once per run, because it moves the stored
  /// rows out. The end is RunEnd::kFailed if a number was not finite or no integration step was
  /// short enough.
  Run take_run(std::size_t run);
  /// Returns the metrics of a run; empty if the run failed.
  std::optional<Metrics> metrics(std::size_t run) const;

 private:
  /// State of a single run.
  struct Parts {
    Sensing sensing;
    Positioning positioning;
    RunDisturbance disturbance;
    ScenarioGuidance guidance;
    Sensed sensed = {};
    PathRow path = {};  ///< guidance columns of the current row
    /// Why the run ends at the current sample. kDuration: it does not end before the scenario's
    /// duration.
    RunEnd ending = RunEnd::kDuration;
    std::vector<RunRow> rows = {};
    std::optional<Ending> end = {};  ///< absent: the run continues, or it failed
  };

  void set_up_controller(const BatchRun& run, std::size_t index);
  void set_up_vehicle(const BatchRun& run, std::size_t index);
  bool has_own_guidance() const;
  template <class Body>
  void for_active(const Body& body);

  void sense(std::size_t k, double t_s);
  void guide(double t_s);
  void follow(std::size_t run, const GuidanceOutput& output);
  void quantise_commands();
  void disturb(double t_s);
  void keep_rows(std::size_t k, double t_s);
  RunRow row_of(std::size_t run, double t_s) const;
  void end_runs(std::size_t k, double t_s);

  const Scenario& scenario_;
  const LoopSteps<Row>& steps_;
  LoopOptions options_;
  std::unique_ptr<LoopRuns<Row>> runs_;
  std::vector<Parts> parts_;  ///< by run
  MeterClock clock_;
};

template <class Row>
ClosedLoop<Row>::ClosedLoop(std::span<const BatchRun> runs, const Scenario& scenario,
                            const LoopSteps<Row>& steps, const LoopOptions& options)
    : scenario_(scenario),
      steps_(steps),
      options_(options),
      runs_(std::make_unique<LoopRuns<Row>>()),
      clock_(scenario, options.samples) {
  runs_->control = controller_setup(scenario, runs.front().controller, options.sample_time_s);
  runs_->task = metrics_task(scenario);
  runs_->vehicles.setup = vehicle_setup(scenario, options.sample_time_s);
  for (std::size_t i = 0; i < kRunsOf<Row>; ++i) {
    // A lane without a run gets a copy of the first run, so that its numbers are valid.
    const bool has_run = i < runs.size();
    const BatchRun& run = has_run ? runs[i] : runs.front();
    set_up_controller(run, i);
    set_up_vehicle(run, i);
    put(has_run ? 1.0 : 0.0, i, runs_->vehicles.active);
  }
  for (const BatchRun& run : runs) {
    const RunSeed seed = run_seed(scenario.seed, run.seed, run.sample);
    parts_.push_back({Sensing(scenario.sensors, options.sample_time_s, seed, run.noise),
                      Positioning(scenario, options.sample_time_s),
                      RunDisturbance(scenario.disturbance, options.sample_time_s, seed),
                      ScenarioGuidance(scenario, options.sample_time_s)});
    if (options.keeps_rows) parts_.back().rows.reserve(options.samples + 1);
  }
}

template <class Row>
void ClosedLoop<Row>::set_up_controller(const BatchRun& run, std::size_t index) {
  const Controller<double> controller = controller_in(scenario_, run.controller);
  const RunController<double> own = run_controller(scenario_, controller, run.mode);
  ControllerSetup& setup = runs_->control;
  setup.is_observed =
      setup.is_observed || (own.yaw_observer.bandwidth_radps > 0.0 && !setup.is_open_loop);
  put(own, index, runs_->controller);
  put(metered_vehicle(controller), index, runs_->metered);
}

template <class Row>
void ClosedLoop<Row>::set_up_vehicle(const BatchRun& run, std::size_t index) {
  const double sample_time_s = options_.sample_time_s;
  const int substeps =
      options_.substeps.value_or(substeps_for(run.plant, scenario_, sample_time_s));
  const AllocationLimits<double>& limits = run.controller.limits;
  awmr::set_up_vehicle(run.plant, limits.force_max + limits.dead_zone, scenario_, sample_time_s,
                       substeps, index, runs_->vehicles);
}

/// True if the guidance must be computed run by run, because the references of the runs differ.
/// False in open loop, and for heading steps without avoidance, shaping and stored rows.
template <class Row>
bool ClosedLoop<Row>::has_own_guidance() const {
  if (runs_->control.is_open_loop) return false;
  return options_.keeps_rows || !std::holds_alternative<HeadingSteps>(scenario_.guidance) ||
         scenario_.avoidance || scenario_.shaping;
}

/// Calls body(run) for each active run.
template <class Row>
template <class Body>
void ClosedLoop<Row>::for_active(const Body& body) {
  for (std::size_t run = 0; run < parts_.size(); ++run) {
    if (is_active(runs_->vehicles, run)) body(run);
  }
}

/// Computes the measurements at sample k, at the time t_s.
template <class Row>
void ClosedLoop<Row>::sense(std::size_t k, double t_s) {
  const State<Row>& state = runs_->vehicles.state;
  if (!scenario_.sensors) {
    runs_->measured = {state.psi_rad, state.u_mps, state.v_mps, state.r_radps};
    if (!has_own_guidance() && !options_.keeps_rows) return;
  }
  for_active([&](std::size_t run) {
    Parts& parts = parts_[run];
    parts.sensed = parts.sensing.at(k, run_of<State<double>>(state, run));
    parts.sensed.position_m = parts.positioning.step(t_s, parts.sensed);
    put(parts.sensed.motion, run, runs_->measured);
  });
}

/// Computes the references of the control laws at the time t_s.
template <class Row>
void ClosedLoop<Row>::guide(double t_s) {
  if (has_own_guidance()) {
    for_active([&](std::size_t run) {
      Parts& parts = parts_[run];
      follow(run, parts.guidance.step(t_s, parts.sensed));
    });
  } else if (const auto* steps = std::get_if<HeadingSteps>(&scenario_.guidance)) {
    runs_->goal_rad = Row(heading_at(*steps, t_s));
    runs_->reference.psi_rad = runs_->goal_rad;
    runs_->reference.speed_mps = Row(scenario_.speed_mps);
  }
}

template <class Row>
void ClosedLoop<Row>::follow(std::size_t run, const GuidanceOutput& output) {
  const auto state = run_of<State<double>>(runs_->vehicles.state, run);
  Parts& parts = parts_[run];
  parts.path = output.path;
  put(output.reference, run, runs_->reference);
  put(output.path.psi_goal_rad, run, runs_->goal_rad);
  put(output.path.cross_track_m, run, runs_->cross_track_m);
  if (runs_->time.is_in_second_half) {  // only in the second half do metrics use the distance
    put(distance_m(output.path.target_m, {state.x_m, state.y_m}), run, runs_->off_target_m);
  }
  if (output.no_passage && std::abs(state.u_mps) < kStopped_mps) {
    parts.ending = RunEnd::kNoPassage;
  } else if (output.finished) {
    parts.ending = RunEnd::kFinished;
  }
}

template <class Row>
void ClosedLoop<Row>::quantise_commands() {
  const auto& actuators = scenario_.actuators;
  if (!actuators || !(actuators->steering_quantum_rad > 0.0 || actuators->pwm_counts > 0)) return;
  Vehicles<Row>& v = runs_->vehicles;
  for_active([&](std::size_t run) {
    auto force = run_of<SideForces<double>>(v.force, run);
    auto steering_rad = run_of<double>(v.steering_command_rad, run);
    quantise(*actuators, run_of<double>(v.force_most, run), force, steering_rad);
    put(force, run, v.force);
    put(steering_rad, run, v.steering_command_rad);
  });
}

template <class Row>
void ClosedLoop<Row>::disturb(double t_s) {
  if (!scenario_.disturbance.any()) return;
  for_active(
      [&](std::size_t run) { put(parts_[run].disturbance.next(t_s), run, runs_->vehicles.load); });
}

template <class Row>
RunRow ClosedLoop<Row>::row_of(std::size_t run, double t_s) const {
  const Vehicles<Row>& v = runs_->vehicles;
  const Parts& parts = parts_[run];
  const auto reference = run_of<Reference<double>>(runs_->reference, run);
  return {.t_s = t_s,
          .state = run_of<State<double>>(v.state, run),
          .force = run_of<SideForces<double>>(v.force, run),
          .steering_command_rad = run_of<double>(v.steering_command_rad, run),
          .tau_speed = run_of<double>(runs_->tau_speed, run),
          .tau_turn_m = run_of<double>(runs_->tau_turn_m, run),
          .psi_ref_rad = reference.psi_rad,
          .u_ref_mps = reference.speed_mps,
          .path = parts.path,
          .measured = parts.sensed.motion,
          .measured_position_m = parts.sensed.position_m,
          .disturbance = run_of<BodyLoad>(v.load, run),
          .clearance_m = run_of<double>(runs_->clearance_m, run),
          .tyre_power_mps = run_of<double>(v.tyre_power_mps, run),
          .acting = v.setup.is_by_wheel ? run_of<WheelForces<double>>(v.wheels, run)
                                        : by_wheel(run_of<double>(v.plant.rear_driven, run),
                                                   run_of<SideForces<double>>(v.arriving, run))};
}

/// Appends the row of sample k to each active run. If a number in the row is not finite, the run
/// ends and the row is removed. The first row (k = 0) is kept, so that each run has a row.
template <class Row>
void ClosedLoop<Row>::keep_rows(std::size_t k, double t_s) {
  if (!options_.keeps_rows) return;
  for_active([&](std::size_t run) {
    std::vector<RunRow>& rows = parts_[run].rows;
    rows.push_back(row_of(run, t_s));
    if (is_finite(rows.back())) return;
    if (k > 0) rows.pop_back();
    put(0.0, run, runs_->vehicles.active);
  });
}

template <class Row>
void ClosedLoop<Row>::end_runs(std::size_t k, double t_s) {
  for_active([&](std::size_t run) {
    Parts& parts = parts_[run];
    if (parts.ending == RunEnd::kDuration && k < options_.samples) return;
    parts.end = {parts.ending, t_s, parts.guidance.missed()};
    put(0.0, run, runs_->vehicles.active);
  });
}

template <class Row>
void ClosedLoop<Row>::drive() {
  Vehicles<Row>& v = runs_->vehicles;
  for (std::size_t k = 0; k <= options_.samples && any_active(v); ++k) {
    const double t_s = static_cast<double>(k) * options_.sample_time_s;
    runs_->time = clock_.next(t_s);
    sense(k, t_s);
    guide(t_s);
    steps_.control(*runs_);
    quantise_commands();
    disturb(t_s);
    steps_.vehicle.dissipate(v);
    if (!scenario_.obstacles.empty()) {
      for_active([&](std::size_t run) {
        put(clearance_m(scenario_, run_of<State<double>>(v.state, run)), run, runs_->clearance_m);
      });
    }
    keep_rows(k, t_s);
    if (options_.has_metrics) steps_.measure(*runs_);
    end_runs(k, t_s);
    step_vehicles(scenario_, t_s, steps_.vehicle, v);
  }
}

template <class Row>
Run ClosedLoop<Row>::take_run(std::size_t run) {
  Parts& parts = parts_[run];
  Run taken;
  taken.rows = std::move(parts.rows);
  taken.substeps = static_cast<int>(run_of<double>(runs_->vehicles.substeps, run));
  taken.end = parts.end ? parts.end->end : RunEnd::kFailed;
  taken.position_resets = parts.positioning.resets();
  taken.missed_waypoints = parts.guidance.missed();
  return taken;
}

template <class Row>
std::optional<Metrics> ClosedLoop<Row>::metrics(std::size_t run) const {
  const std::optional<Ending>& end = parts_[run].end;
  const auto sums = run_of<MetricsAccumulator<double>>(runs_->sums, run);
  if (!end || !is_finite(sums)) return std::nullopt;
  return metrics_of(sums, *end, scenario_);
}

}  // namespace awmr
