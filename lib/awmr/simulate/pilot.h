/// The high-level controller of a scenario: from where the vehicle is to what the heading and speed
/// references of the laws are. Private to this folder.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/guidance/guidance.h"
#include "awmr/control/measurement.h"
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
  Pilot(const Pilot&) = delete;
  Pilot(Pilot&&) = default;

  struct Order {
    Reference<double> reference{};
    CourseRow course;
    bool finished = false;
    bool no_passage = false;
  };
  /// Call it once per sample, in order; not in open loop.
  Order at(double t_s, const Sensed& sensed);
  /// Waypoints passed by or covered by an obstacle, so far.
  int missed() const { return laws_.progress.missed; }

 private:
  /// The parts of the guidance that a scenario can have; without a clock that wraps.
  struct Parts {
    using Line = CourseFollower;
    using Path = PathFollower<double, double>;
    using Arrival = SlowDown<double>;
    using Avoidance = Avoider<double>;
    using Shaping = Shaper<double>;
  };

  void set_up(const OpenLoop&, const Sensed&) {}
  void set_up(const HeadingSteps&, const Sensed&) {}
  void set_up(const WaypointCourse& course, const Sensed& start);
  void set_up(const LineCourse& course, const Sensed& start);
  void set_up(const LissajousCourse& course, const Sensed& start);
  void describe(const OpenLoop&, double, const Sensed&, Order&) {}
  void describe(const HeadingSteps&, double, const Sensed&, Order&) {}
  void describe(const WaypointCourse& course, double t_s, const Sensed& sensed, Order& order);
  void describe(const LineCourse& course, double t_s, const Sensed& sensed, Order& order);
  void describe(const LissajousCourse& course, double t_s, const Sensed& sensed, Order& order);
  bool way_is_free(const Position<double>& from, const Position<double>& to, int leg);

  const Scenario* scenario_;
  double sample_time_s_;
  GuidanceLaws<double, Parts> laws_{};
  std::vector<Sector<double>> sectors_;  ///< of the obstacles
  std::optional<int> leg_checked_;       ///< the leg whose passage was looked for
  bool passage_ = true;
};

}  // namespace awmr
