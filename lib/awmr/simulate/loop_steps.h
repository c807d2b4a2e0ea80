/// The part of a sample that computes controllers and metrics, for all runs that are simulated
/// together (rows of numbers, row_view.h). With vehicle_steps.h, it is the arithmetic of the closed
/// loop: for a single run, or for several runs in vector registers. Private to this folder.
#pragma once

#include "awmr/simulate/meter.h"
#include "awmr/simulate/run_controller.h"
#include "awmr/simulate/vehicle_steps.h"

namespace awmr {

/// All numbers of the runs that are simulated together. Plain data, because the kernels of simd/
/// share no functions with the rest of the program.
template <class Row>
struct LoopRuns {
  ControllerSetup control;
  MetricsTask task;
  MetricsTime time;  ///< time data of the present sample

  Vehicles<Row> vehicles;
  RunController<Row> controller;
  RunControllerState<Row> controller_state;
  MetricsVehicle<Row> metered;
  MetricsAccumulator<Row> sums;

  // Values of the current sample: measurements, references and outputs of the control laws. The
  // motor and steering commands are in `vehicles`.
  Measurement<Row> measured;
  Reference<Row> reference;
  Row tau_speed, tau_turn_m;
  // Further inputs of the metrics, explained in MetricsRow.
  Row goal_rad, cross_track_m, off_target_m, clearance_m;
};

/// The functions that compute a sample, for one type of row. The closed loop calls them in the
/// order control, vehicle.dissipate, measure, vehicle.actuate, vehicle.move. They do not change
/// motion and metrics of an inactive run (Vehicles::active is 0).
template <class Row>
struct LoopSteps {
  const char* name;
  /// Computes the commands of motors and steering from `measured` and `reference`.
  void (*control)(LoopRuns<Row>& runs);
  /// Adds the current sample to the sums of the metrics.
  void (*measure)(LoopRuns<Row>& runs);
  VehicleSteps<Row> vehicle;
};

namespace steps {

template <class View, class Row>
AWMR_WHOLE void control(const View& view, LoopRuns<Row>& runs) {
  using T = typename View::Number;
  const ControllerSetup& setup = runs.control;
  const auto& controller = view(runs.controller);
  const auto& measured = view(runs.measured);
  RunControllerState<T> state = view(runs.controller_state);
  if (runs.time.is_first) state = start_controller(setup, controller, measured);
  const RunCommand<T> command =
      command_sample(setup, controller, measured, view(runs.reference), state);
  if (setup.is_observed) view.store(state.observed, runs.controller_state.observed);
  if (setup.is_lqi) view.store(state.lqi, runs.controller_state.lqi);
  view.store(command.tau_speed, runs.tau_speed);
  view.store(command.tau_turn_m, runs.tau_turn_m);
  view.store(command.force, runs.vehicles.force);
  view.store(command.steering_rad, runs.vehicles.steering_command_rad);
}

template <class View, class Row>
AWMR_WHOLE void measure(const View& view, LoopRuns<Row>& runs) {
  using math::all;
  using T = typename View::Number;
  const Vehicles<Row>& v = runs.vehicles;
  MetricsAccumulator<T> sums = view(runs.sums);
  awmr::measure<T>(
      {view(v.state), view(v.force), acting_forces(view, v), view(v.steering_command_rad),
       view(runs.goal_rad), view(runs.cross_track_m), view(runs.off_target_m),
       view(runs.clearance_m), view(runs.reference.speed_mps), view(v.tyre_power_mps)},
      view(runs.metered), runs.task, runs.time, sums);
  const Mask<T> counts = view(v.active) > T(0.0);
  if (all(counts)) {
    view.store(sums, runs.sums);
  } else {
    view.store(counts, sums, runs.sums);
  }
}

}  // namespace steps
}  // namespace awmr
