// Mission of the firmware: the guidance features of a scenario, with their parameters in float.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "awmr/control/autopilot.h"
#include "awmr/emit/emit.h"
#include "awmr/simulate/scenario.h"

namespace awmr::pil {

/// Waypoints, or corners of a line.
struct Points {
  std::vector<Position<float>> points_m;
  float acceptance_m = 0.0F;  ///< radius at which a waypoint counts as reached; 0 for a line
};

/// Guidance law for a line; the line's corners are in Mission::points.
struct LineMission {
  LineLaws<std::variant, float> law{};
  std::size_t place = 0;  ///< index of the law in LineLaws
  float corner_m = 0.0F;
};

/// Path given as a function of time (Lissajous figure). `gain_per_s`: gain of the feedback of the
/// position error; 0: no feedback.
struct PathMission {
  Lissajous<float> path{};
  float gain_per_s = 0.0F;
};

/// All guidance features of a mission. An absent feature is disabled.
struct Mission {
  Points points;  ///< waypoints or corners of the line; empty if the mission has neither
  bool skip_passed = false;
  std::optional<LineMission> line;
  std::optional<PathMission> path;
  std::optional<float> slow_down_m;  ///< distance from the end at which the vehicle slows down
  std::optional<Avoidance<float>> avoidance;
  std::vector<Obstacle<float>> obstacles;
  std::optional<HeadingShaping<float>> shaping;
  std::optional<Observers<float>> observers;
  CombinedSplit split = CombinedSplit::kRedistribute;

  /// True if the chip computes the reference headings itself, from points or a path. False: the
  /// host sends the reference heading in each step.
  bool leads() const { return !points.points_m.empty() || path.has_value(); }
};

Mission mission_of(const Scenario& scenario);

/// Firmware parts that the mission needs.
std::set<FirmwarePart> parts_of(const Mission& mission);

/// Maximum number of points that the firmware for `awmr pil` can follow.
inline constexpr std::size_t kMaxPoints = 16;

/// Generates the header mission.h of the firmware: the maximum number of points, and functions that
/// set up the mission and follow points. Missions without optional parts and with the same
/// `skip_passed` have the same header, so one firmware serves all of them.
std::string mission_header(const Mission& mission);

/// Returns a checksum of mission_header(). By it, the host detects a board that was flashed for
/// another mission. 0 for missions that need no optional part and skip no waypoint.
std::uint32_t mission_crc(const Mission& mission);

}  // namespace awmr::pil
