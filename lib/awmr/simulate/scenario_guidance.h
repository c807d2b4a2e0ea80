/// Guidance of a scenario: computes the references of the control laws (heading and speed) from the
/// measurements. Private to this folder.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/guidance/guidance.h"
#include "awmr/control/measurement.h"
#include "awmr/simulate/any_line.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/sensing.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Returns the commanded heading at the time `t_s`, rad, not wrapped: the heading of the last step
/// that has begun.
double heading_at(const HeadingSteps& guidance, double t_s);

/// Output of the guidance at one sample.
struct GuidanceOutput {
  Reference<double> reference{};
  PathRow path;
  bool finished = false;  ///< the vehicle has reached the end of the route
  /// Obstacles block every way to the target. The reference speed is then 0.
  bool no_passage = false;
};

/// PathFollower that also stores the current point of the path, which the row of the run needs.
struct TimedPathFollower : PathFollower<double, double> {
  PathPoint<double> point{};
};
inline PathPoint<double> path_point(TimedPathFollower& part, double t_s) {
  return part.point = part.path.at(t_s);
}

/// The guidance of one run, with its state between samples.
class ScenarioGuidance {
 public:
  /// `start`: measurements at t = 0.
  ScenarioGuidance(const Scenario& scenario, double sample_time_s, const Sensed& start);
  ScenarioGuidance(const ScenarioGuidance&) = delete;
  ScenarioGuidance(ScenarioGuidance&&) = default;

  /// Computes the references at the time `t_s`. Call it once per sample, in order, and not in open
  /// loop, which has no references.
  GuidanceOutput step(double t_s, const Sensed& sensed);
  /// Number of waypoints that have been missed so far, including those covered by an obstacle.
  int missed() const { return laws_.progress.missed; }

 private:
  /// The parts of the guidance that a scenario can use (guidance/parts.h). Their times, in s, do
  /// not wrap like the clock of a firmware.
  struct Parts {
    using Line = AnyLineFollower<double>;
    using Path = TimedPathFollower;
    using Arrival = SlowDown<double>;
    using Avoidance = Avoider<double>;
    using Shaping = Shaper<double>;
  };

  void set_up(const OpenLoop&, const Sensed&) {}
  void set_up(const HeadingSteps&, const Sensed&) {}
  void set_up(const WaypointPath& path, const Sensed& start);
  void set_up(const LinePath& path, const Sensed& start);
  void set_up(const LissajousPath& path, const Sensed& start);
  void describe(const OpenLoop&, const Sensed&, GuidanceOutput&) {}
  void describe(const HeadingSteps&, const Sensed&, GuidanceOutput&) {}
  void describe(const WaypointPath& path, const Sensed& sensed, GuidanceOutput& output);
  void describe(const LinePath& path, const Sensed& sensed, GuidanceOutput& output);
  void describe(const LissajousPath& path, const Sensed& sensed, GuidanceOutput& output);
  bool way_is_free(const Position<double>& from, const Position<double>& to, int leg);

  const Scenario* scenario_;
  double sample_time_s_;
  GuidanceLaws<double, Parts> laws_{};
  std::vector<Sector<double>> sectors_;  ///< work space of the avoidance
  std::optional<int> leg_checked_;       ///< leg for which way_is_free() has checked the way
  bool passage_ = true;                  ///< result of this check
};

}  // namespace awmr
