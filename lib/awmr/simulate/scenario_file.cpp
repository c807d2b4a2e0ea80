#include <array>
#include <numbers>
#include <string>
#include <utility>

#include "awmr/core/json.h"
#include "awmr/core/units.h"
#include "awmr/simulate/scenario.h"

namespace awmr {
namespace {

const std::array<std::string, 5> kGuidanceTypes{"open_loop", "heading", "waypoints", "line",
                                                "lissajous"};

State<double> read_initial(JsonObject json) {
  State<double> state{};
  state.x_m = json.number("x_m");
  state.y_m = json.number("y_m");
  state.psi_rad = radians(json.number("psi_deg"));
  state.u_mps = json.number("u_mps");
  state.v_mps = json.number("v_mps");
  state.r_radps = radians(json.number("r_degps"));
  json.reject_unknown_keys();
  return state;
}

HeadingSteps read_heading_steps(JsonObject& json) {
  HeadingSteps heading;
  std::vector<JsonObject> steps = json.objects("steps");
  for (JsonObject& step : steps) {
    heading.steps.push_back({step.number("t_s", kNonNegative), radians(step.number("psi_deg"))});
    step.reject_unknown_keys();
  }
  if (heading.steps.empty() || heading.steps.front().t_s > 0.0) {
    json.fault("steps", "the first step has to be at t_s = 0");
  }
  for (std::size_t i = 1; i < heading.steps.size(); ++i) {
    if (heading.steps[i].t_s <= heading.steps[i - 1].t_s) {
      json.fault("steps", "the steps' times have to increase");
      break;
    }
  }
  return heading;
}

Guidance read_guidance(JsonObject json) {
  Guidance guidance;
  const std::size_t type = json.choice("type", kGuidanceTypes);
  if (type == 0) {
    guidance = OpenLoop{json.number("tau_speed"), json.number("tau_turn")};
  } else if (type == 1) {
    guidance = read_heading_steps(json);
  } else {
    json.fault("type", "this guidance is not in this version; use open_loop or heading");
    return guidance;
  }
  json.reject_unknown_keys();
  return guidance;
}

}  // namespace

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  const auto document = read_json_file(path);
  if (!document) return tl::unexpected(document.error());
  std::vector<Fault> faults;
  JsonObject json(*document, path.string(), "", faults);
  Scenario scenario;
  json.schema("awmr.scenario/1");
  scenario.name = json.string("name");
  scenario.duration_s = json.number("duration_s", kPositive);
  scenario.initial = read_initial(json.object("initial"));
  scenario.speed_mps = json.number("speed_mps", kNonNegative);
  scenario.guidance = read_guidance(json.object("guidance"));
  for (const char* key : {"obstacles", "avoidance", "disturbance", "sensors", "seed"}) {
    if (json.has(key)) json.fault(key, "this key is not in this version; remove it");
  }
  json.reject_unknown_keys();
  if (!faults.empty()) return input_errors(std::move(faults));
  return scenario;
}

std::string_view name_of(YawMode mode) {
  switch (mode) {
    case YawMode::kDifferential:
      return "differential";
    case YawMode::kSteering:
      return "steering";
    case YawMode::kCombined:
      return "combined";
  }
  return "";
}

std::optional<YawMode> yaw_mode_by_name(std::string_view name) {
  for (const YawMode mode : kYawModes) {
    if (name_of(mode) == name) return mode;
  }
  return std::nullopt;
}

}  // namespace awmr
