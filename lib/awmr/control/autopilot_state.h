/// State of the autopilot between two steps, the function that initialises it from the parameters,
/// and functions that give it a route, obstacles, a filter or an observer. These take effect in the
/// next step.
#pragma once

#include <stdint.h>

#include "awmr/control/autopilot_parts.h"
#include "awmr/control/controller.h"
#include "awmr/control/directed_speed.h"
#include "awmr/control/guidance/guidance.h"
#include "awmr/control/parameters_block.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/safety.h"

namespace awmr {

/// State of the autopilot between two steps. G is the type of the resistances g1 and g3, as in
/// Controller. P lists the optional parts that are compiled in (autopilot_parts.h).
template <class G, class P>
struct Autopilot : GuidanceLaws<float, P>, P::Observation, P::Motors, P::Gains, P::Positioning {
  PreparedController<float, G> controller;
  SafetyLimits limits;
  uint32_t last_step_ms;           ///< time of the last step, valid if has_stepped
  DirectedSpeed<float> direction;  ///< direction of travel, for a speed sensor without a sign
  uint32_t direction_ms;           ///< time of the last speed reading (InputTimes::speed_ms)
  float mass_inverse;              ///< 1/m'
  bool has_stepped;                ///< at least one step has been made since the start
  bool are_parameters_good;        ///< the check sum of the parameters was correct at the start
};

/// Reads the parameters. Returns true if their check sum equals `crc`, which the header of the
/// emitted library defines. Otherwise, every step outputs the safe command. Parameters of optional
/// parts: `rest` for RestingTable and MotorCurve, `observer` for Observer, `gains` for GainsByMode;
/// null: none. On an AVR, all pointers are addresses in flash.
template <class G, class P>
bool start_autopilot(Autopilot<G, P>& a, const ParameterBlock* block,
                     const ResistanceLine* surge_lines, size_t surge_count,
                     const ResistanceLine* yaw_lines, size_t yaw_count, uint32_t crc,
                     const RestBlock* rest = 0, const ObserverBlock* observer = 0,
                     const ModeGainsBlock* gains = 0) {
  PreparedController<float, G>& c = a.controller;
  read_flash(&block->constants, c.constants);
  set_resistance(&block->surge_table, block->surge_alpha_beta, surge_lines, c.surge);
  set_resistance(&block->yaw_table, block->yaw_alpha_beta, yaw_lines, c.yaw);
  if (rest != 0) {
    set_rest(&rest->surge_rest_speed, &rest->surge_at_rest, c.surge);
    set_friction_width(rest, 0, c.yaw);
  }
  part_of<typename P::Motors>(a).start(rest);
  part_of<typename P::Gains>(a).start(gains);
  read_flash(&block->safety, a.limits);
  disable_guidance(a);
  part_of<typename P::Observation>(a).start(observer);
  part_of<typename P::Positioning>(a).reset();
  a.has_stepped = false;
  a.direction = DirectedSpeed<float>();
  a.direction_ms = 0;
  a.mass_inverse = 1.0F / c.constants.mass_norm;
  a.are_parameters_good = crc32_of_parameters(block, surge_lines, surge_count, yaw_lines, yaw_count,
                                              rest, observer, gains) == crc;
  return a.are_parameters_good;
}

/// Makes the autopilot follow these waypoints from the next step on, instead of any line or path.
/// If the list is empty (`count` 0), the vehicle holds the heading of AutopilotInput::reference.
template <class G, class P>
void follow_waypoints(Autopilot<G, P>& a, const Waypoints<float>& waypoints) {
  a.waypoints = waypoints;
  a.acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  a.is_leg_started = false;
  part_of<typename P::Line>(a).disable();
  part_of<typename P::Path>(a).disable();
}

/// Makes the autopilot follow this line from the next step on, instead of any waypoints or path.
/// `sample_time_s`: time between two steps.
template <class G, class P>
void follow_line(Autopilot<G, P>& a, const typename P::Line::Route& line, float sample_time_s) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  typename P::Line& part = part_of<typename P::Line>(a);
  part.line = line;
  part.sample_time_s = sample_time_s;
  part.is_started = false;
}

/// Makes the autopilot follow this timed path from the next step on, instead of any waypoints or
/// line. The next step is at t = 0 of the path. `gain_per_s`: gain k of the position feedback in
/// closed_path(), > 0; 0: no position feedback.
template <class G, class P>
void follow_path(Autopilot<G, P>& a, const Lissajous<float>& path, float gain_per_s) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  typename P::Path& part = part_of<typename P::Path>(a);
  part.path = path;
  part.gain_per_s = gain_per_s;
  part.is_on = true;
  part.is_started = false;
}

/// Makes the autopilot avoid `count` obstacles from the next step on; 0: none. `sectors` is work
/// space for `count` elements. The arrays must stay valid: every step reads them, without a copy.
template <class G, class P>
void avoid_obstacles(Autopilot<G, P>& a, const Avoidance<float>& avoidance,
                     const Obstacle<float>* obstacles, Sector<float>* sectors, int count) {
  Avoider<float>& part = part_of<Avoider<float>>(a);
  part.avoidance = avoidance;
  part.obstacles = obstacles;
  part.sectors = sectors;
  part.count = count;
  part.state = AvoidanceState();
}

/// Makes the autopilot smooth the heading reference with this filter from the next step on,
/// starting at the vehicle's heading. `sample_time_s`: time between two steps.
template <class G, class P>
void shape_headings(Autopilot<G, P>& a, const HeadingShaping<float>& filter, float sample_time_s) {
  Shaper<float>& part = part_of<Shaper<float>>(a);
  part.filter = filter;
  part.sample_time_s = sample_time_s;
  part.is_on = true;
  part.is_started = false;
}

/// Makes the autopilot estimate the position with these constants. The estimate starts in the next
/// step whose input has a GPS fix as its position (AutopilotInput::position_is_fix).
template <class G, class P>
void filter_position(Autopilot<G, P>& a, const PositionFilter<float>& filter) {
  part_of<Positioner<>>(a).estimate = PositionEstimate<float>(filter);
}

/// Makes the autopilot estimate and compensate the disturbance from the next step on. The first
/// estimate is 0. `sample_time_s`: time between two steps.
template <class G, class P>
void observe_disturbance(Autopilot<G, P>& a, const Observers<float>& observers,
                         float sample_time_s) {
  part_of<Observer>(a).enable(observers, sample_time_s);
}

}  // namespace awmr
