/// The vehicle in its world, one sample at a time: what simulate() steps, and what a controller
/// that runs elsewhere (on a chip) can be held against.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/simulate/disturbance.h"
#include "awmr/simulate/four_wheel_motion.h"
#include "awmr/simulate/motion.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

struct SimulateOptions;

class Physics {
 public:
  /// `force_max` is F'max of the vehicle's motors, for the battery.
  Physics(const Plant<double>& plant, double force_max, const Scenario& scenario,
          const SimulateOptions& options);

  const State<double>& state() const { return state_; }
  int substeps() const { return substeps_; }
  bool resolved() const { return resolution_.resolved; }
  /// The disturbance over the sample that begins at `t_s`, without the slope's share; call it
  /// once per sample, before step().
  const BodyLoad& disturb(double t_s);
  /// Power that the tyres' side forces dissipate with these commands, over F_max, m/s; without tyres,
  /// the power of the model's scrub.
  double tyre_power_mps(const SideForces<double>& command) const;
  /// RunRow::acting of the last step().
  const WheelForces<double>& acting() const { return acting_; }
  /// Over one sample, with the commands held. Where no step is short enough for the motion, or it
  /// is no longer finite, the state stays as it was and resolved() is false from then on.
  void step(double t_s, const SideForces<double>& force, double steering_command_rad);

 private:
  template <class Forces>
  void move(const Forces& force, double steering_command_rad);

  Plant<double> plant_;  ///< with its chord at rest
  double force_max_;
  const Scenario* scenario_;
  double sample_time_s_;
  int substeps_;
  Resolution<double> resolution_;
  State<double> state_;
  MotorLag lag_;
  SideForces<double> motors_{};  ///< the forces of the motors, where they lag
  WheelForces<double> acting_{0.0, 0.0, 0.0, 0.0};
  RunDisturbance disturbance_;
  BodyLoad load_;
  bool by_wheel_;
};

/// True where the two wheels of a side may have different forces.
bool forces_differ_by_wheel(const Scenario& scenario);

/// What of each wheel's force arrives: the motor's fault, and the ground under it. The rear axle is
/// taken as far behind the centre of gravity as the front one is before it.
WheelForces<double> at_the_ground(const Scenario& scenario, const Plant<double>& plant,
                                  const State<double>& state, double t_s,
                                  const SideForces<double>& force);

/// The lag of the motors; none without actuators.
MotorLag motor_lag(const std::optional<Actuators>& actuators, double sample_time_s);

/// The share of the largest force that is left at `t_s`.
double battery_share(const Battery& battery, double t_s);

/// What pushes the vehicle while the disturbance's terms come to `load`.
Push<double> push_of(const Disturbance& disturbance, const BodyLoad& load);

/// A command to the nearest step of the servo and count of the PWM. `force_max` is F'max of a wheel.
void quantise(const Actuators& actuators, double force_max, SideForces<double>& force,
              double& steering_command_rad);

/// The plant with its chord at rest (rest.h), for the steps of a run; on tyres that of g1 at the wheels.
Plant<double> resolved_at_rest(const Plant<double>& plant, const Scenario& scenario, double step_s);

/// The longest RK4 step that resolves the plant at any speed, and the parameter that asks for it. On
/// tyres: without the resistances that they replace; the tyres' own rate depends on speed.
struct StepLimit {
  double step_s = 0.0;
  ParameterId parameter{};
};
StepLimit step_limit(const Plant<double>& plant, bool on_tyres);

/// RK4 steps of a run from start to end, with those of its last row.
double steps_of_run(const Plant<double>& plant, const Scenario& scenario, double sample_time_s);

}  // namespace awmr
