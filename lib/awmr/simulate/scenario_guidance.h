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

/// The guidance of one run, with its state between samples.
class ScenarioGuidance {
 public:
  ScenarioGuidance(const Scenario& scenario, double sample_time_s);
  ScenarioGuidance(const ScenarioGuidance&) = delete;
  ScenarioGuidance(ScenarioGuidance&&) = default;

  /// Computes the references at the time `t_s`. Call it once per sample, in order from t = 0, and
  /// not in open loop, which has no references.
  GuidanceOutput step(double t_s, const Sensed& sensed);
  /// Number of waypoints that have been missed so far, including those covered by an obstacle.
  int missed() const { return laws_.progress.missed; }

 private:
  /// The parts of the guidance that a scenario can use (guidance/parts.h). Their times, in s, do
  /// not wrap like the clock of a firmware.
  struct Parts {
    using Line = AnyLineFollower<double>;
    using Path = PathFollower<double, double>;
    using Arrival = SlowDown<double>;
    using Avoidance = Avoider<double>;
    using Shaping = Shaper<double>;
  };

  using Pose = VehiclePose<double, double>;

  void set_up(const OpenLoop&) {}
  void set_up(const HeadingSteps&) {}
  void set_up(const WaypointPath& path);
  void set_up(const LinePath& path);
  void set_up(const LissajousPath& path);
  void describe(const OpenLoop&, const Pose&, GuidanceOutput&) {}
  void describe(const HeadingSteps&, const Pose&, GuidanceOutput&) {}
  void describe(const WaypointPath& path, const Pose& pose, GuidanceOutput& output);
  void describe(const LinePath& path, const Pose& pose, GuidanceOutput& output);
  void describe(const LissajousPath& path, const Pose& pose, GuidanceOutput& output);
  bool way_is_free(const Position<double>& from, const Position<double>& to, int leg);

  const Scenario* scenario_;
  double sample_time_s_;
  GuidanceLaws<double, Parts> laws_{};
  std::vector<Sector<double>> sectors_;  ///< work space of the avoidance
  std::optional<int> leg_checked_;       ///< leg for which way_is_free() has checked the way
  bool passage_ = true;                  ///< result of this check
};

}  // namespace awmr
