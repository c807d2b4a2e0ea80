/// Simulates the motion of vehicles in the environment of a scenario, sample by sample: for the
/// closed loop (closed_loop.h), and for an external controller such as one on a chip (Physics).
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/vehicle_steps.h"

namespace awmr {

struct SimulateOptions;

/// The steps of vehicle_steps.h for a single vehicle.
inline constexpr VehicleSteps<double> kOneVehicleSteps = {
    [](Vehicles<double>& v) { steps::dissipate(OneRun{}, v); },
    [](Vehicles<double>& v) { steps::actuate(OneRun{}, v); },
    [](Vehicles<double>& v) { steps::move(OneRun{}, v); }};

/// A single vehicle for an external controller.
class Physics {
 public:
  /// `force_max` is the largest motor command over F_max, including the dead zone (the upper end of
  /// Vehicle::wheel_force), which a falling battery voltage reduces.
  Physics(const Plant<double>& plant, double force_max, const Scenario& scenario,
          const SimulateOptions& options);

  const State<double>& state() const { return vehicle_.state; }
  /// False once step() has failed.
  bool resolved() const { return vehicle_.active > 0.0; }
  /// Simulates the sample that begins at `t_s` with constant commands. Call it for every sample, in
  /// order. If no step is short enough for the motion, or the state is not finite, the state is
  /// unchanged and resolved() is false from then on.
  void step(double t_s, const SideForces<double>& force, double steering_command_rad);

 private:
  const Scenario* scenario_;
  Vehicles<double> vehicle_{};
  RunDisturbance disturbance_;
};

/// True if front and rear wheel of a side can have different forces: the scenario has motor faults
/// or slippery discs.
bool forces_differ_by_wheel(const Scenario& scenario);

/// Applied wheel forces at `t_s`: the motor commands `force`, changed by motor faults and limited
/// on slippery discs. Assumes that both axles have the same distance from the centre of gravity.
WheelForces<double> at_the_ground(const Scenario& scenario, const Plant<double>& plant,
                                  const State<double>& state, double t_s,
                                  const SideForces<double>& force);

/// The lag of the scenario's motors over a sample; no lag without actuators.
MotorLag motor_lag(const std::optional<Actuators>& actuators, double sample_time_s);

/// Largest motor command at `t_s`, divided by its value with a full battery, in [0, 1]. Sag is not
/// included.
double battery_share(const Battery& battery, double t_s);

/// Rounds the steering command to the nearest step of the servo, and the motor commands `force` to
/// the nearest count of the PWM. `force_max` is the motor command at `pwm_counts` counts.
void quantise(const Actuators& actuators, double force_max, SideForces<double>& force,
              double& steering_command_rad);

/// The plant with its resistances near rest replaced by straight lines through the origin (chords,
/// rest.h), which integration steps of step_s seconds need. On tyres, g1 acts at the wheels, and
/// its chord is chosen for them (resolved_at_rest_on_tyres()).
Plant<double> resolved_at_rest(const Plant<double>& plant, const Scenario& scenario, double step_s);

/// Longest RK4 step that resolves the time constants that do not depend on speed. `parameter`: the
/// parameter of the model that determines it.
struct StepLimit {
  double step_s = 0.0;
  ParameterId parameter{};
};
/// Computes the limit for a plant. With `on_tyres`, the sway resistance g2 and the yaw resistance
/// g3 are left out, because the tyres replace them.
StepLimit step_limit(const Plant<double>& plant, bool on_tyres);

/// Number of RK4 steps of a run over the whole duration of the scenario, if no step is halved.
double steps_of_run(const Plant<double>& plant, const Scenario& scenario, double sample_time_s);

/// Properties common to the vehicles of a scenario. set_up_vehicle() adds back-EMF, scrub and
/// front-wheel drive if any vehicle has them.
VehicleSetup vehicle_setup(const Scenario& scenario, double sample_time_s);

/// Sets up the vehicle of the run with the index `run`, in the scenario's initial state.
/// `force_max`: largest motor command over F_max, including the dead zone.
template <class Row>
void set_up_vehicle(const Plant<double>& plant, double force_max, const Scenario& scenario,
                    double sample_time_s, int substeps, std::size_t run, Vehicles<Row>& v) {
  const double step_s = sample_time_s / substeps;
  put(resolved_at_rest(plant, scenario, step_s), run, v.plant);
  put(step_s, run, v.step_s);
  put(static_cast<double>(substeps), run, v.substeps);
  put(force_max, run, v.force_most);
  put(scenario.initial, run, v.state);
  put(1.0, run, v.active);
  VehicleSetup& setup = v.setup;
  setup.has_back_emf = setup.has_back_emf || plant.back_emf_s_per_m > 0.0;
  setup.has_scrub = setup.has_scrub || plant.yaw_scrub_m > 0.0;
  setup.is_front_driven = setup.is_front_driven || plant.rear_driven < 1.0;
}

template <class Row>
bool is_active(const Vehicles<Row>& v, std::size_t run) {
  return run_of<double>(v.active, run) > 0.0;
}
template <class Row>
bool any_active(const Vehicles<Row>& v) {
  for (std::size_t run = 0; run < kRunsOf<Row>; ++run) {
    if (is_active(v, run)) return true;
  }
  return false;
}

/// Integrates the active vehicles over the sample that begins at `t_s`, with constant commands and
/// constant disturbances (v.load).
template <class Row>
void step_vehicles(const Scenario& scenario, double t_s, const VehicleSteps<Row>& steps,
                   Vehicles<Row>& v) {
  if (scenario.battery) v.battery_share = battery_share(*scenario.battery, t_s);
  steps.actuate(v);
  if (v.setup.is_by_wheel) {
    for (std::size_t run = 0; run < kRunsOf<Row>; ++run) {
      if (!is_active(v, run)) continue;
      put(at_the_ground(scenario, run_of<Plant<double>>(v.plant, run),
                        run_of<State<double>>(v.state, run), t_s,
                        run_of<SideForces<double>>(v.arriving, run)),
          run, v.wheels);
    }
  }
  steps.move(v);
}

}  // namespace awmr
