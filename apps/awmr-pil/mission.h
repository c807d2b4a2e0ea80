// What a scenario asks of the firmware beside headings, in the numbers of the chip.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/control/autopilot.h"
#include "awmr/emit/emit.h"
#include "awmr/simulate/scenario.h"

namespace awmr::pil {

/// Points to go to, or corners of a line.
struct Points {
  std::vector<Position<float>> points_m;
  float acceptance_m = 0.0F;
};

/// A line's law, without its corners.
struct LineMission {
  LineLaw<float> law{};
  float corner_m = 0.0F;
};

/// A path in time; `gain_per_s` is 0 for the open form.
struct PathMission {
  Lissajous<float> path{};
  float gain_per_s = 0.0F;
};

/// All of it. What is optional is off where it is absent.
struct Mission {
  Points points;  ///< empty: neither waypoints nor a line
  bool skip_passed = false;
  std::optional<LineMission> line;
  std::optional<PathMission> path;
  std::optional<float> slow_down_m;
  std::optional<Avoidance<float>> avoidance;
  std::vector<Obstacle<float>> obstacles;
  std::optional<HeadingShaping<float>> shaping;
  std::optional<Observers<float>> observers;
  CombinedSplit split = CombinedSplit::kRedistribute;

  /// True where the chip leads; else it is told headings.
  bool leads() const { return !points.points_m.empty() || path.has_value(); }
};

Mission mission_of(const Scenario& scenario);

/// The parts that the firmware needs for it.
std::set<FirmwarePart> parts_of(const Mission& mission);

/// Most points that a firmware of these programs holds.
inline constexpr std::size_t kMaxPoints = 16;

/// mission.h of the firmware: how many points it holds, what it sets up at the start and how it
/// follows points. Where no part is needed it is the same for every mission.
std::string mission_header(const Mission& mission);

/// 0 where no part is needed; else a check sum of mission_header(), by which a board that was
/// flashed for another mission is known.
std::uint32_t mission_crc(const Mission& mission);

}  // namespace awmr::pil
