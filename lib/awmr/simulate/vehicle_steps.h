/// The part of a sample that computes the vehicles: motors and battery convert the commands to
/// forces, which move the vehicles. Each function computes all runs that are simulated together
/// (rows of numbers, row_view.h). Private to this folder.
#pragma once

#include "awmr/simulate/motion.h"
#include "awmr/simulate/row_view.h"

namespace awmr {

/// Properties common to all vehicles that are simulated together.
struct VehicleSetup {
  MotorLag lag;
  bool has_battery = false;
  double battery_sag = 0.0;  ///< Battery::sag
  bool is_by_wheel = false;  ///< true: front and rear wheel of a side can have different forces
  bool is_on_tyres = false;
  Tyres<double> tyres;            ///< valid if is_on_tyres
  bool has_friction = false;      ///< any vehicle not on tyres has Coulomb friction (g1, g3)
  bool has_back_emf = false;      ///< any vehicle has back-EMF
  bool has_scrub = false;         ///< any vehicle has scrub
  bool is_front_driven = false;   ///< true: at least one vehicle has front-wheel drive
  ExternalForces<double> push{};  ///< flags and slope; the disturbance `load` differs by vehicle
};

/// All numbers of the vehicles that are simulated together, one vehicle per run.
template <class Row>
struct Vehicles {
  VehicleSetup setup;
  double battery_share = 1.0;  ///< result of battery_share() for the current sample

  /// 1 for a run that continues; 0 if it has ended or failed, or for a lane without a run
  Row active;

  // Constant over a run.
  Plant<Row> plant;             ///< result of resolved_at_rest() (physics.h)
  FrictionRates<Row> friction;  ///< Coulomb friction that `plant` does not contain
  Row step_s;                   ///< h: integration step, s
  Row substeps;                 ///< RK4 steps per sample
  Row force_most;               ///< largest motor command divided by F_max, including the dead zone

  // State of a run.
  State<Row> state;
  SideForces<Row> motors;  ///< motor forces F at the start of the sample, after lag (MotorLag)
  /// number of RK4 steps that had to be halved so far (Resolution::halves)
  Row halves;

  // Values of the current sample: the commands, the applied forces by side (`arriving`) or by wheel
  // (`wheels`), and the forces and moment of the disturbances (`load`).
  SideForces<Row> force;
  Row steering_command_rad;
  SideForces<Row> arriving;
  WheelForces<Row> wheels;
  BodyLoadOf<Row> load;
  Row tyre_power_mps;  ///< RunRow::tyre_power_mps
};

/// The functions that compute the vehicles of a sample, for one type of row. An inactive run
/// (Vehicles::active is 0) does not move.
template <class Row>
struct VehicleSteps {
  /// Computes `tyre_power_mps` from state and motor commands. No-op if the vehicles have neither
  /// tyres nor scrub.
  void (*dissipate)(Vehicles<Row>& v);
  /// Computes the motor forces `arriving` from the commands, with the effects of motor lag and
  /// battery.
  void (*actuate)(Vehicles<Row>& v);
  /// Integrates the motion over the sample. If no integration step is short enough for a vehicle,
  /// or a number is not finite, its state is unchanged and its run becomes inactive.
  void (*move)(Vehicles<Row>& v);
};

namespace steps {

/// Returns the body whose motion is integrated: the 3-DOF plant, or the same vehicle on tyres.
template <bool kIsOnTyres, class View, class Row>
decltype(auto) body_of(const View& view, const Vehicles<Row>& v) {
  using T = typename View::Number;
  if constexpr (kIsOnTyres) {
    const Tyres<double>& tyres = v.setup.tyres;
    return FourWheels<T>{view(v.plant),
                         {T(tyres.friction), T(tyres.cornering_per_rad), T(tyres.rest_speed_mps)}};
  } else {
    return view(v.plant);
  }
}

/// Returns the wheel forces that RunRow::acting reports.
template <class View, class Row>
WheelForces<typename View::Number> acting_forces(const View& view, const Vehicles<Row>& v) {
  if (v.setup.is_by_wheel) return view(v.wheels);
  return by_wheel(view(v.plant.rear_driven), view(v.arriving));
}

template <class View, class Row>
AWMR_WHOLE void dissipate(const View& view, Vehicles<Row>& v) {
  if (v.setup.is_on_tyres) {
    view.store(tyre_power_mps(body_of<true>(view, v), view(v.state), view(v.force)),
               v.tyre_power_mps);
  } else if (v.setup.has_scrub) {
    view.store(scrub_power_mps(view(v.plant), view(v.state), view(v.force)), v.tyre_power_mps);
  }
}

template <class View, class Row>
AWMR_WHOLE void actuate(const View& view, Vehicles<Row>& v) {
  using T = typename View::Number;
  const SideForces<T> command = view(v.force);
  SideForces<T> motors = view(v.motors);
  SideForces<T> force = through_motors(v.setup.lag, command, motors);
  view.store(motors, v.motors);
  if (v.setup.has_back_emf) {
    force = switched_off(view(v.plant.back_emf_s_per_m), command, force);
  }
  if (v.setup.has_battery) {
    if (v.setup.battery_sag > 0.0) {
      const T motors_a_side = T(1.0) + view(v.plant.rear_driven);
      force = under_sag(v.setup.battery_sag, motors_a_side, view(v.plant.back_emf_s_per_m),
                        view(v.plant.half_track_m), view(v.state), force);
    }
    const T most = view(v.force_most) * T(v.battery_share);
    force = up_to(force, most);
  }
  view.store(force, v.arriving);
}

/// A step of another integrator with friction (FrictionRates or FrictionWithScrub) added.
template <class Friction, class Stepper>
struct WithFriction {
  Friction friction;
  Stepper stepper;

  template <class T, class Rates>
  State<T> operator()(const State<T>& from, const T& h, const Rates& rates) const {
    return step_with_friction(friction, from, h, rates, stepper);
  }
};

/// Integrates the active vehicles over a sample, with constant forces. `rates(body, state, steering
/// command)` returns the time derivatives of the state.
template <bool kIsOnTyres, class View, class Row, class Rates, class Stepper>
AWMR_WHOLE void move_by(const View& view, Vehicles<Row>& v, const Rates& rates,
                        const Stepper& stepper) {
  using math::select;
  using T = typename View::Number;
  const auto& body = body_of<kIsOnTyres>(view, v);
  const T command = view(v.steering_command_rad);
  const Mask<T> requested = view(v.active) > T(0.0);
  State<T> state = view(v.state);
  Resolution<T> resolution{view(v.halves), Mask<T>(true)};
  integrate(
      body, T(view(v.step_s)), T(view(v.substeps)),
      [&](const State<T>& from, const T& h) __attribute__((always_inline)) {
        return stepper(
            from, h, [&](const State<T>& at) __attribute__((always_inline)) {
              return rates(body, at, command);
            });
      },
      requested, state, resolution);
  view.store(state, v.state);
  view.store(resolution.halves, v.halves);
  view.store(select(requested && resolution.resolved, T(1.0), T(0.0)), v.active);
}

template <bool kIsOnTyres, class View, class Row, class Forces, class Stepper>
void move_pushed(const View& view, Vehicles<Row>& v, const Forces& force, const Stepper& stepper) {
  using T = typename View::Number;
  const ExternalForces<double>& common = v.setup.push;
  const ExternalForces<T> push{view(v.load), common.is_loaded, common.is_sloped,
                               common.slope_accel_mps2, common.slope_downhill_rad};
  move_by<kIsOnTyres>(
      view, v,
      [&](const auto& body, const State<T>& at, const T& command)
          __attribute__((always_inline)) { return pushed_rates(body, push, at, force, command); },
      stepper);
}
template <class View, class Row, class Stepper>
void move_alone(const View& view, Vehicles<Row>& v, const SideForces<typename View::Number>& force,
                const Stepper& stepper) {
  using T = typename View::Number;
  move_by<false>(
      view, v,
      [&](const Plant<T>& plant, const State<T>& at, const T& command)
          __attribute__((always_inline)) { return side_driven_rates(plant, at, force, command); },
      stepper);
}

/// Integrates vehicles not on tyres of which at least one has Coulomb friction or tyre scrub.
template <class View, class Row, class Stepper>
void move_with_friction(const View& view, Vehicles<Row>& v, const Stepper& stepper) {
  using T = typename View::Number;
  using Wheels = WheelForces<T>;
  const Wheels force = acting_forces(view, v);
  const FrictionRates<T> coulomb = view(v.friction);
  if (v.setup.has_scrub) {
    using Friction = FrictionWithScrub<T, Wheels>;
    const Plant<T>& plant = view(v.plant);
    const WithFriction<Friction, Stepper> sliding{Friction{coulomb, plant, force}, stepper};
    move_pushed<false>(view, v, force, sliding);
  } else {
    const WithFriction<FrictionRates<T>, Stepper> sliding{coulomb, stepper};
    move_pushed<false>(view, v, force, sliding);
  }
}

/// Integrates the vehicles by the function for the state's time derivatives that has the fewest
/// terms of those that suffice. Tests for each term inside the derivatives would slow down every
/// integration step. tests/bench replaces the integrator `stepper` by others, for comparison.
template <class View, class Row, class Stepper = RungeKutta4>
void move(const View& view, Vehicles<Row>& v, const Stepper& stepper = {}) {
  using T = typename View::Number;
  const VehicleSetup& setup = v.setup;
  const SideForces<T> force = view(v.arriving);
  if (setup.is_on_tyres) {
    if (setup.is_by_wheel) {
      move_pushed<true>(view, v, WheelForces<T>(view(v.wheels)), stepper);
    } else {
      move_pushed<true>(view, v, force, stepper);
    }
  } else if (setup.has_friction || setup.has_scrub) {
    move_with_friction(view, v, stepper);
  } else if (setup.is_by_wheel) {
    move_pushed<false>(view, v, WheelForces<T>(view(v.wheels)), stepper);
  } else if (setup.has_back_emf || setup.is_front_driven || setup.push.is_loaded) {
    move_pushed<false>(view, v, force, stepper);
  } else {
    move_alone(view, v, beyond_dead_zone(force, T(view(v.plant.wheel_dead_zone))), stepper);
  }
}

}  // namespace steps
}  // namespace awmr
