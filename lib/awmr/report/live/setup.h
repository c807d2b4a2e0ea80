/// Input of the page's interactive part (live.cpp, WebAssembly) as a list of numbers. `awmr report`
/// writes the list from model.json and gains.json, and the interactive part reads the list. Both
/// use visit_numbers(), so that the numbers have the same order. Private to report/.
#pragma once

#include <vector>

#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"

namespace awmr {

/// Input of the interactive part: the inputs of the tuning constraints (they include plant and
/// force limits of the vehicle), and a heading scenario.
struct LiveSetup {
  /// Inputs of the tuning constraints; `plant` is the identified plant of the model.
  ConstraintContext context;
  double allocation_form = 0.0;  ///< the AllocationForm of the vehicle, as a number
  /// Largest yaw moment, m, and surge force, both divided by F_max, that the tuned observer
  /// compensates; 0 without an observer.
  double observer_yaw_max_m = 0.0;
  double observer_surge_max = 0.0;
  double speed_mps = 0.0;  ///< u_d, commanded speed of the scenario, m/s
  double duration_s = 0.0;
  State<double> initial{};
  std::vector<HeadingStep> steps;
};

template <class Visit>
void visit_resistance(Resistance<double>& law, Visit&& visit) {
  for (double* x : {&law.alpha, &law.beta, &law.rest_speed, &law.coulomb, &law.quadratic}) {
    visit(*x);
  }
}

template <class Visit>
void visit_plant(Plant<double>& plant, Visit&& visit) {
  visit_resistance(plant.surge, visit);
  visit_resistance(plant.yaw, visit);
  for (double* x : {&plant.sway_alpha, &plant.mass_norm, &plant.inertia_norm, &plant.front_axle_m,
                    &plant.half_track_m, &plant.steering_max_rad, &plant.steering_max_rate_radps,
                    &plant.steering_time_constant_s, &plant.wheel_dead_zone,
                    &plant.back_emf_s_per_m, &plant.rear_driven}) {
    visit(*x);
  }
}

/// Passes a value that is not a double (bool, enumeration) to `visit` as a double.
template <class T, class Visit>
void visit_as_number(T& value, Visit&& visit) {
  double number = static_cast<double>(value);
  visit(number);
  value = static_cast<T>(number);
}

/// Passes the number of elements of a list to `visit`, then the elements.
template <class T, class Visit, class VisitElement>
void visit_list(std::vector<T>& list, Visit&& visit, VisitElement&& visit_element) {
  double size = static_cast<double>(list.size());
  visit(size);
  list.resize(static_cast<std::size_t>(size));
  for (T& element : list) visit_element(element, visit);
}

/// Calls visit(double&) for all numbers of the setup in a fixed order, to write or to read them.
template <class Visit>
void visit_numbers(LiveSetup& setup, Visit&& visit) {
  ConstraintContext& c = setup.context;
  visit_as_number(c.form, visit);
  visit(c.margin);
  visit_plant(c.plant, visit);
  visit_as_number(c.has_steering, visit);
  // -1: gains for all modes.
  double mode = c.mode ? static_cast<double>(static_cast<int>(*c.mode)) : -1.0;
  visit(mode);
  if (mode >= 0.0) c.mode = static_cast<YawMode>(static_cast<int>(mode));
  for (double* x :
       {&c.sample_time_s, &c.speed_mps, &c.step_rad, &c.fastest_radps, &c.limits.damping,
        &c.limits.late_damping, &c.limits.delayed_damping, &c.limits.noise_share, &c.wheel_force.lo,
        &c.wheel_force.hi, &c.heading_noise_rad, &c.yaw_rate_noise_radps, &c.latency_s,
        &c.motor_time_constant_s}) {
    visit(*x);
  }
  double steering_rate_degps = c.limits.steering_rate_rms_degps.value_or(0.0);  // 0: no limit
  visit(steering_rate_degps);
  if (steering_rate_degps > 0.0) c.limits.steering_rate_rms_degps = steering_rate_degps;
  visit_list(c.draws, visit, [](DrawnVehicle& drawn, auto& v) {
    visit_plant(drawn.plant, v);
    v(drawn.wheel_force.lo);
    v(drawn.wheel_force.hi);
  });
  visit(setup.allocation_form);
  visit(setup.observer_yaw_max_m);
  visit(setup.observer_surge_max);
  visit(setup.speed_mps);
  visit(setup.duration_s);
  State<double>& s = setup.initial;
  for (double* x : {&s.x_m, &s.y_m, &s.psi_rad, &s.u_mps, &s.v_mps, &s.r_radps}) visit(*x);
  visit_list(setup.steps, visit, [](HeadingStep& step, auto& v) {
    v(step.t_s);
    v(step.psi_rad);
  });
}

}  // namespace awmr
