#include "mission.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "awmr/control/crc.h"

namespace awmr::pil {
namespace {

float in_float(double value) { return static_cast<float>(value); }

template <class Law>
std::vector<double> parameters_of(const Law& law) {
  std::vector<double> values;
  law.parameters(law,
                 [&](const char*, auto value, const LawParameter&) { values.push_back(value); });
  return values;
}

/// Converts a guidance law for lines from double to float, in which the chip computes.
template <template <class> class Law>
Law<float> in_float(const Law<double>& law) {
  Law<float> result{};
  const std::vector<double> values = parameters_of(law);
  auto next = values.begin();
  result.parameters(result, [&](const char*, float& parameter, const LawParameter&) {
    parameter = in_float(*next++);
  });
  result.sideslip_compensation = law.sideslip_compensation;
  return result;
}

Points points_of(const std::vector<Position<double>>& points_m, double acceptance_m) {
  Points points;
  points.acceptance_m = in_float(acceptance_m);
  for (const Position<double>& point : points_m) {
    points.points_m.push_back({in_float(point.x_m), in_float(point.y_m)});
  }
  return points;
}

void add(const OpenLoop&, Mission&) {}
void add(const HeadingSteps&, Mission&) {}
void add(const WaypointPath& guided, Mission& mission) {
  mission.points = points_of(guided.points_m, guided.acceptance_m);
  mission.skip_passed = guided.skip_passed;
  if (guided.slow_down_m) mission.slow_down_m = in_float(*guided.slow_down_m);
}
void add(const LinePath& guided, Mission& mission) {
  mission.points = points_of(guided.points_m, 0.0);
  mission.line = LineMission{
      std::visit([](const auto& law) -> LineLaws<std::variant, float> { return in_float(law); },
                 guided.law),
      guided.law.index(), in_float(guided.corner_m)};
  if (guided.slow_down_m) mission.slow_down_m = in_float(*guided.slow_down_m);
}
void add(const LissajousPath& guided, Mission& mission) {
  const Lissajous<double>& path = guided.path;
  mission.path = PathMission{{in_float(path.amplitude_x_m), in_float(path.amplitude_y_m),
                              in_float(path.rate_x_radps), in_float(path.rate_y_radps)},
                             guided.closed_loop ? in_float(guided.position_gain_per_s) : 0.0F};
}

Avoidance<float> in_float(const Avoidance<double>& a) {
  return {in_float(a.mmd_base_m),          in_float(a.mmd_per_speed_s), in_float(a.sigma_rad),
          in_float(a.vehicle_radius_m),    in_float(a.clearance_m),     in_float(a.hysteresis_m),
          in_float(a.side_hysteresis_rad), in_float(a.brake_m)};
}

/// Formats numbers as a C initialiser, with so many digits that the compiler reads the same floats.
std::string braced(const std::vector<float>& values) {
  std::vector<std::string> literals;
  for (const float value : values) literals.push_back(fmt::format("{:.8e}f", value));
  return fmt::format("{{{}}}", fmt::join(literals, ", "));
}

/// C++ source text for the generated header mission.h. `constants`: definitions of objects;
/// `calls`: statements that pil_set_up() executes once after awmr_init().
struct SetUp {
  std::string constants;
  std::string calls;

  void add(const char* type, const char* name, const std::string& value, const std::string& call) {
    constants += fmt::format("const {} {} = {};\n", type, name, value);
    calls += fmt::format("  {};\n", call);
  }
};

void add_avoidance(const Mission& mission, SetUp& set_up) {
  const Avoidance<float>& a = *mission.avoidance;
  std::string obstacles;
  for (const Obstacle<float>& obstacle : mission.obstacles) {
    obstacles += fmt::format(
        "{}, ", braced({obstacle.centre_m.x_m, obstacle.centre_m.y_m, obstacle.radius_m}));
  }
  set_up.constants += fmt::format("const awmr_obstacle pil_obstacles[] = {{{}}};\n", obstacles);
  set_up.constants += fmt::format("awmr_sector pil_sectors[{}];\n", mission.obstacles.size());
  set_up.add("awmr_avoidance", "pil_avoidance",
             braced({a.mmd_base_m, a.mmd_per_speed_s, a.sigma_rad, a.vehicle_radius_m,
                     a.clearance_m, a.hysteresis_m, a.side_hysteresis_rad, a.brake_m}),
             fmt::format("awmr_avoid(&pil_avoidance, pil_obstacles, pil_sectors, {})",
                         mission.obstacles.size()));
}

SetUp set_up_of(const Mission& mission) {
  SetUp set_up;
  if (const auto& path = mission.path) {
    const Lissajous<float>& p = path->path;
    set_up.add("awmr_path", "pil_path",
               braced({p.amplitude_x_m, p.amplitude_y_m, p.rate_x_radps, p.rate_y_radps,
                       path->gain_per_s}),
               "awmr_follow_path(&pil_path)");
  }
  if (mission.slow_down_m) {
    set_up.calls += fmt::format("  awmr_slow_down({:.8e}f);\n", *mission.slow_down_m);
  }
  if (mission.avoidance) add_avoidance(mission, set_up);
  if (const auto& shaping = mission.shaping) {
    set_up.add("awmr_shaping", "pil_shaping",
               braced({shaping->omega_radps, shaping->rate_max_radps, shaping->accel_max_radps2}),
               "awmr_shape(&pil_shaping)");
  }
  if (const auto& observers = mission.observers) {
    const Observers<float>& o = *observers;
    set_up.add("awmr_observer", "pil_observer",
               fmt::format("{{{:.8e}f, {:.8e}f, {:.8e}f, {:d}}}", o.yaw.bandwidth_radps,
                           o.yaw.limit, o.surge.limit, o.anti_windup),
               "awmr_observe(&pil_observer)");
  }
  return set_up;
}

constexpr std::string_view kHeader =
    R"(// Made by awmr pil: guidance that this firmware runs in addition to heading hold.
#pragma once

#include "awmr.h"

constexpr uint8_t kPilPoints = {};  // maximum number of points to follow
constexpr uint32_t kPilMission = 0x{:08X}UL;

{}
/// Sets up the mission; call it after awmr_init().
inline void pil_set_up() {{
{}}}

/// Follows these points from the next step on.
inline void pil_follow(const awmr_point* points, int16_t count, float acceptance_m) {{
{}}}
)";

std::string header_with(const Mission& mission, std::uint32_t crc) {
  SetUp set_up = set_up_of(mission);
  std::string follow = fmt::format("  awmr_follow{}(points, count, acceptance_m);\n",
                                   mission.skip_passed ? "_skipping" : "");
  if (const auto& line = mission.line) {
    const auto [parameters, is_compensated] = std::visit(
        [](const auto& law) {
          const std::vector<double> values = parameters_of(law);
          return std::pair(braced({values.begin(), values.end()}), law.sideslip_compensation);
        },
        line->law);
    set_up.constants += fmt::format("const float pil_line[] = {};\n", parameters);
    follow = fmt::format(
        "  (void)acceptance_m;\n  awmr_follow_line_by(points, count, pil_line, {:.8e}f, {:d});\n",
        line->corner_m, is_compensated);
  }
  const bool plain = parts_of(mission).empty();
  return fmt::format(kHeader,
                     plain ? kMaxPoints : std::max<std::size_t>(1, mission.points.points_m.size()),
                     crc, set_up.constants, set_up.calls, follow);
}

}  // namespace

Mission mission_of(const Scenario& scenario) {
  Mission mission;
  std::visit([&mission](const auto& guided) { add(guided, mission); }, scenario.guidance);
  mission.split = scenario.control.split;
  if (scenario.avoidance && !scenario.obstacles.empty()) {
    mission.avoidance = in_float(*scenario.avoidance);
    for (const Obstacle<double>& o : scenario.obstacles) {
      mission.obstacles.push_back(
          {{in_float(o.centre_m.x_m), in_float(o.centre_m.y_m)}, in_float(o.radius_m)});
    }
  }
  if (const auto& shaping = scenario.shaping) {
    mission.shaping = {in_float(shaping->omega_radps), in_float(shaping->rate_max_radps),
                       in_float(shaping->accel_max_radps2)};
  }
  if (const auto& observer = scenario.control.observer) {
    const float bandwidth_radps = in_float(observer->bandwidth_radps);
    mission.observers = {{bandwidth_radps, in_float(observer->yaw_max_m)},
                         {bandwidth_radps, in_float(observer->surge_max)},
                         scenario.control.anti_windup};
  }
  return mission;
}

std::set<FirmwarePart> parts_of(const Mission& mission) {
  std::set<FirmwarePart> parts;
  if (mission.line) parts.insert(FirmwarePart::kLine);
  if (mission.path) parts.insert(FirmwarePart::kPath);
  if (mission.slow_down_m) parts.insert(FirmwarePart::kSlowDown);
  if (mission.avoidance) parts.insert(FirmwarePart::kAvoidance);
  if (mission.shaping) parts.insert(FirmwarePart::kShaping);
  if (mission.observers) parts.insert(FirmwarePart::kObserver);
  return parts;
}

std::string mission_header(const Mission& mission) {
  return header_with(mission, mission_crc(mission));
}

std::uint32_t mission_crc(const Mission& mission) {
  if (parts_of(mission).empty() && !mission.skip_passed) return 0;
  std::uint32_t crc = kCrc32Start;
  for (const char c : header_with(mission, 0)) crc = crc32_with(crc, static_cast<std::uint8_t>(c));
  return ~crc;
}

}  // namespace awmr::pil
