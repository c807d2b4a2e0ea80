/// The vehicle in its world, one sample at a time: what simulate() steps, and what a controller
/// that runs elsewhere (on a chip) can be held against.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/simulate/disturbance.h"
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
  bool resolved() const { return resolved_; }
  /// The disturbance over the sample that begins at `t_s`, without the slope's share; to be asked
  /// once per sample, before step().
  const BodyLoad& disturb(double t_s);
  /// Over one sample, with the commands held. Where no step is short enough for the motion, or it
  /// is no longer finite, the state stays as it was and resolved() is false from then on.
  void step(double t_s, const SideForces<double>& force, double steering_command_rad);

 private:
  SideForces<double> through_motors(const SideForces<double>& command);
  WheelForces<double> at_the_ground(double t_s, const SideForces<double>& force) const;
  template <class Forces>
  void integrate(const Forces& force, double steering_command_rad);
  double fastest_rate(const State<double>& at) const;
  template <class Rates>
  State<double> advance(const State<double>& from, double h, const Rates& rates, int halvings);
  template <class Forces>
  State<double> rates(const State<double>& at, const Forces& force,
                      double steering_command_rad) const;

  Plant<double> plant_;  ///< with its chord at rest
  double force_max_;
  const Scenario* scenario_;
  double sample_time_s_;
  int substeps_;
  long halves_ = 0;  ///< steps that were halved since a rate grew with the speed
  bool resolved_ = true;
  State<double> state_;
  SideForces<double> motors_{};  ///< the forces of the motors, where they lag
  DisturbanceSource surge_, sway_, yaw_;
  BodyLoad load_;
  bool loaded_;    ///< the scenario has a disturbance or a slope
  bool by_wheel_;  ///< the two wheels of a side may have different forces
};

/// A command to the nearest step of the servo and count of the PWM. `force_max` is F'max of a wheel.
void quantise(const Actuators& actuators, double force_max, SideForces<double>& force,
              double& steering_command_rad);

/// The longest RK4 step that resolves the plant at any speed, and the parameter that asks for it.
struct StepLimit {
  double step_s = 0.0;
  ParameterId parameter{};
};
StepLimit step_limit(const Plant<double>& plant);

/// RK4 steps of a run from start to end, with those of its last row.
double steps_of_run(const Plant<double>& plant, double duration_s, double sample_time_s);

}  // namespace awmr
