/// The high-level controller of a scenario: from where the vehicle is to what the heading and speed
/// laws are asked to follow. Private to this folder.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/simulate/line_following.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/sensing.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// The heading that is to be held at `t_s`.
double heading_at(const HeadingSteps& guidance, double t_s);

/// The guidance of one run, with what it remembers from sample to sample.
class Pilot {
 public:
  /// `start` is what the sensors say at t = 0.
  Pilot(const Scenario& scenario, double sample_time_s, const Sensed& start);

  struct Order {
    Reference<double> reference{};
    CourseRow course;
    bool finished = false;
    bool no_passage = false;
  };
  /// To be asked once per sample, in order; not in open loop.
  Order at(double t_s, const Sensed& sensed);
  /// Waypoints passed by or covered by an obstacle, so far.
  int missed() const { return waypoints_.missed; }

 private:
  Order guidance(const HeadingSteps& steps, double t_s, const Sensed& sensed);
  Order guidance(const WaypointCourse& course, double t_s, const Sensed& sensed);
  Order guidance(const LineCourse& course, double t_s, const Sensed& sensed);
  Order guidance(const LissajousCourse& course, double t_s, const Sensed& sensed);
  Order guidance(const OpenLoop&, double, const Sensed&) { return {}; }
  void steer_clear(const Sensed& sensed, Order& order);
  bool way_is_free(const Position<double>& from, const Position<double>& to, int leg);

  const Scenario* scenario_;
  double sample_time_s_;
  WaypointProgress<double> waypoints_;
  LineProgress line_;
  AvoidanceState avoidance_;
  std::vector<Sector<double>> sectors_;  ///< of the obstacles
  ShapedHeading<double> shaped_;
  double held_rad_;
  double target_distance_m_ = 0.0;  ///< to where the guidance leads, for the avoidance
  std::optional<int> leg_checked_;  ///< the leg whose passage was looked for
  bool passage_ = true;
};

}  // namespace awmr
