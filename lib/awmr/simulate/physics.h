/// Simulates the motion of vehicles in the environment of a scenario, sample by sample. The closed
/// loop (closed_loop.h) uses these functions; an external controller, such as one on a chip, uses
/// the class Physics.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/vehicle_steps.h"

namespace awmr {

struct SimulateOptions;

/// The functions of vehicle_steps.h for a single vehicle.
inline constexpr VehicleSteps<double> kOneVehicleSteps = {
    [](Vehicles<double>& v) { steps::dissipate(OneRun{}, v); },
    [](Vehicles<double>& v) { steps::actuate(OneRun{}, v); },
    [](Vehicles<double>& v) { steps::move(OneRun{}, v); }};

/// A single simulated vehicle that an external controller drives.
class Physics {
 public:
  /// `force_max`: largest motor command with a full battery, divided by F_max: the upper end of
  /// Vehicle::wheel_force. The wheel force at this command is smaller by the dead zone F'0.
  Physics(const Plant<double>& plant, double force_max, const Scenario& scenario,
          const SimulateOptions& options);

  const State<double>& state() const { return vehicle_.state; }
  /// False once step() has failed.
  bool resolved() const { return vehicle_.active > 0.0; }
  /// Simulates the sample that begins at `t_s`, with constant commands. Call it for every sample,
  /// in order. If no integration step is short enough for the motion, or the state is not finite,
  /// the state is unchanged, and resolved() is false from then on.
  void step(double t_s, const SideForces<double>& force, double steering_command_rad);

 private:
  const Scenario* scenario_;
  Vehicles<double> vehicle_{};
  RunDisturbance disturbance_;
};

/// Returns the wheel forces at `t_s`: the motor commands `force`, reduced by motor faults and
/// limited on slippery discs. Assumes the rear axle as far from the centre of gravity as the front
/// axle.
WheelForces<double> at_the_ground(const Scenario& scenario, const Plant<double>& plant,
                                  const State<double>& state, double t_s,
                                  const SideForces<double>& force);

/// Largest motor command at `t_s` divided by its value with a full battery, in [0, 1]. The voltage
/// drop under load (sag) is not included.
double battery_share(const Battery& battery, double t_s);

/// Rounds the steering command to the nearest step of the servo, and the motor commands `force` to
/// the nearest PWM count. `force_max` is the motor command at `pwm_counts` counts.
void quantise(const Actuators& actuators, double force_max, SideForces<double>& force,
              double& steering_command_rad);

/// Returns the plant for integration steps of step_s seconds. A resistance that is too steep near
/// rest for such steps is replaced there by a straight line through the origin (chord, rest.h). The
/// plant has no Coulomb friction, because the integration steps add it (sliding.h). On tyres, the
/// surge resistance g1 acts at the wheels, and its chord is chosen for them, with Coulomb friction
/// (resolved_at_rest_on_tyres()).
Plant<double> resolved_at_rest(const Plant<double>& plant, const Scenario& scenario, double step_s);

/// Longest RK4 step that resolves those time constants of the plant that do not depend on speed.
/// `parameter` is the model parameter that limits the step.
struct StepLimit {
  double step_s = 0.0;
  ParameterId parameter{};
};
/// Computes the longest step for a plant. If `on_tyres` is true, the sway and yaw resistances g2
/// and g3 do not limit the step: tyre forces replace them.
StepLimit step_limit(const Plant<double>& plant, bool on_tyres);

/// Number of RK4 steps in the whole duration of the scenario, if no step has to be halved.
double steps_of_run(const Plant<double>& plant, const Scenario& scenario, double sample_time_s);

/// Returns the properties that the vehicles of all runs share, without back-EMF, scrub and
/// front-wheel drive: set_up_vehicle() adds these if a vehicle has them.
VehicleSetup vehicle_setup(const Scenario& scenario, double sample_time_s);

/// Sets up the vehicle of the run with the index `run`, in the scenario's initial state.
/// `force_max`: largest motor command divided by F_max, from which no dead zone is subtracted.
template <class Row>
void set_up_vehicle(const Plant<double>& plant, double force_max, const Scenario& scenario,
                    double sample_time_s, int substeps, std::size_t run, Vehicles<Row>& v) {
  const double step_s = sample_time_s / substeps;
  const bool is_on_tyres = scenario.tyres.has_value();
  const FrictionRates<double> friction =
      is_on_tyres ? FrictionRates<double>{} : friction_rates(plant);
  put(resolved_at_rest(plant, scenario, step_s), run, v.plant);
  put(friction, run, v.friction);
  put(step_s, run, v.step_s);
  put(static_cast<double>(substeps), run, v.substeps);
  put(force_max, run, v.force_most);
  put(scenario.initial, run, v.state);
  put(1.0, run, v.active);
  VehicleSetup& setup = v.setup;
  setup.has_friction = setup.has_friction || friction.any();
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

/// Integrates the motion of the active vehicles over the sample that begins at `t_s`. Commands and
/// disturbances (v.load) are constant over the sample.
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
