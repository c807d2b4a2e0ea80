// Reads the guidance, obstacles, avoidance and shaping of scenario.json.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/units.h"
#include "awmr/simulate/scenario_json.h"

namespace awmr {
namespace {

enum class GuidanceType { kOpenLoop, kHeading, kWaypoints, kLine, kLissajous };
constexpr NameTable<GuidanceType, 5> kGuidanceTypes{{{"open_loop", GuidanceType::kOpenLoop},
                                                     {"heading", GuidanceType::kHeading},
                                                     {"waypoints", GuidanceType::kWaypoints},
                                                     {"line", GuidanceType::kLine},
                                                     {"lissajous", GuidanceType::kLissajous}}};
constexpr NumberRule kBelowRightAngle{.min = 0.0, .max = 89.0};

HeadingSteps read_heading_steps(JsonObject& json) {
  HeadingSteps heading;
  heading.tau_speed = json.optional_number("tau_speed", kForce);
  heading.steps = json.objects("steps", [](JsonObject& step) {
    return HeadingStep{step.number("t_s", kTime_s), radians(step.number("psi_deg", kAngle_deg))};
  });
  if (json.size("steps") == 0 || (!heading.steps.empty() && heading.steps.front().t_s > 0.0)) {
    json.fault(ErrorCode::kWrongOrder, "steps",
               fmt::format("the first step must be at t_s = 0, but {}; add a step at 0",
                           heading.steps.empty()
                               ? "there is none"
                               : fmt::format("it is at {:g} s", heading.steps.front().t_s)));
  }
  for (std::size_t i = 1; i < heading.steps.size(); ++i) {
    if (heading.steps[i].t_s <= heading.steps[i - 1].t_s) {
      json.fault(ErrorCode::kWrongOrder, "steps",
                 fmt::format("step {} (counted from 1) at {:g} s is not after the step before it, "
                             "at {:g} s; sort the steps, or correct their t_s",
                             i + 1, heading.steps[i].t_s, heading.steps[i - 1].t_s));
      break;
    }
  }
  return heading;
}

/// Reads a point `[x, y]`, m.
Position<double> read_point(JsonObject& json, const char* key) {
  const std::vector<double> xy = json.numbers(key, kCoordinate_m);
  if (xy.size() == 2) return {xy[0], xy[1]};
  if (const auto size = json.size(key); size && *size != 2) {
    json.fault(ErrorCode::kWrongType, key, "expected a point [x, y] in m");
  }
  return {};
}

/// Reads an array of points `[[x, y], ...]`, m, with at least `least` points.
std::vector<Position<double>> read_points(JsonObject& json, const char* key, std::size_t least) {
  std::vector<Position<double>> points;
  bool well_formed = true;
  bool in_range = true;
  const Json* array = json.rows(key);
  if (array == nullptr) return points;
  if (array->is_array()) {
    for (const Json& point : *array) {
      const bool pair =
          point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
      well_formed = well_formed && pair;
      if (!pair) continue;
      points.push_back({point[0].get<double>(), point[1].get<double>()});
      in_range = in_range && std::abs(points.back().x_m) <= kCoordinate_m.max &&
                 std::abs(points.back().y_m) <= kCoordinate_m.max;
    }
  }
  if (!well_formed || points.size() < least) {
    json.fault(ErrorCode::kWrongType, key,
               "expected an array of points [[x, y], ...] in m, at least " + std::to_string(least));
  } else if (!in_range) {
    json.fault(ErrorCode::kOutOfRange, key,
               fmt::format("the magnitude of a coordinate exceeds {:g} m; give coordinates in m",
                           kCoordinate_m.max));
  }
  return points;
}

WaypointPath read_waypoints(JsonObject& json) {
  WaypointPath path;
  path.points_m = read_points(json, "points_m", 1);
  path.acceptance_m = json.number("acceptance_m", kLength_m);
  path.skip_passed = json.optional_boolean("skip_passed").value_or(false);
  path.slow_down_m = json.optional_number("slow_down_m", kLength_m);
  return path;
}

/// Reports successive points that are equal, because the segment between them has no direction.
void check_segments(JsonObject& json, const char* key,
                    const std::vector<Position<double>>& points_m) {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    if (points_m[i].x_m != points_m[i - 1].x_m || points_m[i].y_m != points_m[i - 1].y_m) continue;
    json.fault(ErrorCode::kGivenTwice, key,
               fmt::format("the points {} and {} are the same, [{}, {}] (the first point is number "
                           "0); remove one of them, or give different points",
                           i - 1, i, points_m[i].x_m, points_m[i].y_m));
  }
}

/// Reads the guidance law of a line with its keys. Keys of other laws are reported as unknown.
void read_line_law(JsonObject& json, LinePath& path) {
  path.law = line_laws()[json.has("law") ? json.choice("law", line_law_names()) : 0];
  const auto read = [&json](const char* key, double& parameter, const LawParameter& rule) {
    const NumberRule range{.min = rule.min, .max = rule.max, .min_excluded = rule.min_excluded};
    parameter = rule.unit * json.number(key, range);
  };
  const auto read_law = [&](auto& law) {
    law.sideslip_compensation = json.optional_boolean("sideslip_compensation").value_or(true);
    law.parameters(law, read);
    if (!law.kUsesCorner) return;
    path.corner_m = json.optional_number("corner_m", kLengthOrNone_m).value_or(0.0);
  };
  std::visit(read_law, path.law);
}

LinePath read_line(JsonObject& json) {
  LinePath path;
  if (json.has("points_m")) {
    path.points_m = read_points(json, "points_m", 2);
    check_segments(json, "points_m", path.points_m);
  } else {
    path.points_m = {read_point(json, "from_m"), read_point(json, "to_m")};
    if (json.has("from_m") && json.has("to_m")) check_segments(json, "to_m", path.points_m);
  }
  read_line_law(json, path);
  path.slow_down_m = json.optional_number("slow_down_m", kLength_m);
  return path;
}

/// Reads an array of two numbers.
std::array<double, 2> read_pair(JsonObject& json, const char* key, NumberRule rule) {
  const std::vector<double> pair = json.numbers(key, rule);
  if (pair.size() == 2) return {pair[0], pair[1]};
  json.fault(ErrorCode::kWrongType, key, "expected two numbers, for x and y");
  return {};
}

LissajousPath read_lissajous(JsonObject& json) {
  LissajousPath path;
  const auto amplitude_m = read_pair(json, "amplitude_m", kCoordinate_m);
  const auto rate_radps = read_pair(json, "rate_radps", kSignedRate_radps);
  path.path = {amplitude_m[0], amplitude_m[1], rate_radps[0], rate_radps[1]};
  path.closed_loop = json.boolean("closed_loop");
  if (const auto gain = json.optional_number("position_gain_per_s", kRate)) {
    if (!path.closed_loop) {
      json.fault(
          ErrorCode::kConflict, "position_gain_per_s",
          "this key has no effect if closed_loop is false; remove it, or set closed_loop to true");
    }
    path.position_gain_per_s = *gain;
  }
  path.tolerance_m = json.optional_number("tolerance_m", kLength_m).value_or(path.tolerance_m);
  return path;
}

}  // namespace

Guidance read_guidance(JsonObject& json) {
  switch (json.choice("type", kGuidanceTypes)) {
    case GuidanceType::kOpenLoop:
      return OpenLoop{json.number("tau_speed", kForce), json.number("tau_turn", kForce)};
    case GuidanceType::kHeading:
      return read_heading_steps(json);
    case GuidanceType::kWaypoints:
      return read_waypoints(json);
    case GuidanceType::kLine:
      return read_line(json);
    case GuidanceType::kLissajous:
      return read_lissajous(json);
  }
  return {};  // not reached
}

Obstacle<double> read_obstacle(JsonObject& json) {
  return {{json.number("x_m", kCoordinate_m), json.number("y_m", kCoordinate_m)},
          json.number("radius_m", kLength_m)};
}

Avoidance<double> read_avoidance(JsonObject& json) {
  return {.mmd_base_m = json.number("mmd_base_m", kLength_m),
          .mmd_per_speed_s = json.number("mmd_per_speed_s", kTime_s),
          .sigma_rad = radians(json.number("sigma_deg", kBelowRightAngle)),
          .vehicle_radius_m = json.number("vehicle_radius_m", kLengthOrNone_m),
          .clearance_m = json.number("clearance_m", kLength_m),
          .hysteresis_m = json.number("hysteresis_m", kLengthOrNone_m),
          .side_hysteresis_rad =
              radians(json.number("side_hysteresis_deg", {.min = 0.0, .max = 180.0})),
          .brake_m = json.number("brake_m", kLength_m)};
}

HeadingShaping<double> read_shaping(JsonObject& json) {
  return {
      .omega_radps = json.number("omega_radps", {.min = 0.0, .max = 50.0, .min_excluded = true}),
      .rate_max_radps = radians(json.number("rate_max_degps", kRate)),
      .accel_max_radps2 = radians(json.number("accel_max_degps2", kRate))};
}

}  // namespace awmr
