#include "awmr/simulate/scenario_file.h"

#include <string>
#include <utility>

#include "awmr/core/json/json_document.h"
#include "awmr/core/units.h"
#include "awmr/simulate/scenario_json.h"

namespace awmr {
namespace {

State<double> read_initial(JsonObject& json) {
  return {.x_m = json.number("x_m", kCoordinate_m),
          .y_m = json.number("y_m", kCoordinate_m),
          .psi_rad = radians(json.number("psi_deg", kAngle_deg)),
          .u_mps = json.number("u_mps", kSignedSpeed_mps),
          .v_mps = json.number("v_mps", kSignedSpeed_mps),
          .r_radps = radians(json.number("r_degps", kYawRate_degps)),
          .steering_rad = 0.0};
}

/// Reads speed_mps, the commanded speed u_d. With a constant thrust (`holds_thrust`), there is no
/// commanded speed: the key is then an error, and the result is 0.
double read_speed(JsonObject& json, bool holds_thrust) {
  if (!json.has("speed_mps")) {
    if (!holds_thrust) json.fault(ErrorCode::kMissing, "speed_mps", "this key is missing; add it");
    return 0.0;
  }
  if (holds_thrust) {
    json.fault(
        ErrorCode::kConflict, "speed_mps",
        "the guidance has a constant tau_speed, so no speed is commanded; remove speed_mps or "
        "tau_speed");
  }
  return json.number("speed_mps", kSpeed_mps);
}

/// Reports keys that have no effect in this scenario.
void reject_idle_keys(JsonObject& json, const Scenario& scenario) {
  const bool open = std::holds_alternative<OpenLoop>(scenario.guidance);
  if (scenario.avoidance && (!json.has("obstacles") || json.size("obstacles") == 0)) {
    json.fault(ErrorCode::kConflict, "avoidance",
               "the scenario has no obstacles to avoid; add obstacles, or remove this key");
  }
  for (const char* key : {"avoidance", "shaping", "sensors", "control"}) {
    if (open && json.has(key)) {
      json.fault(ErrorCode::kConflict, key, "this key has no effect in open loop; remove it");
    }
  }
  if (json.has("estimator") && !(scenario.sensors && scenario.sensors->gps)) {
    json.fault(
        ErrorCode::kConflict, "estimator",
        "this key has no effect without the fixes of a GPS; add sensors/gps, or remove this key");
  }
  if (scenario.tyres) {
    for (const TyreConflict& conflict : tyre_conflicts(scenario)) {
      json.fault(ErrorCode::kConflict, conflict.key, conflict.message);
    }
  }
  const auto* timed = std::get_if<LissajousPath>(&scenario.guidance);
  if (timed && timed->closed_loop && scenario.speed_mps > 0.0) {
    json.fault(ErrorCode::kConflict, "speed_mps",
               "the speed must be 0 if closed_loop is true, because the path determines the speed; "
               "set speed_mps to 0, or closed_loop to false");
  }
}

constexpr std::string_view kScenarioSchema = "awmr.scenario/1";

Scenario scenario_from_json(JsonObject& json) {
  Scenario scenario;
  json.schema(kScenarioSchema);
  scenario.name = json.string("name");
  scenario.duration_s = json.number("duration_s", kDuration_s);
  scenario.initial = json.object("initial", read_initial);
  scenario.guidance = json.object("guidance", read_guidance);
  scenario.speed_mps = read_speed(json, scenario.held_tau_speed().has_value());
  scenario.obstacles = json.optional_objects("obstacles", read_obstacle);
  scenario.avoidance = json.optional_object("avoidance", read_avoidance);
  scenario.shaping = json.optional_object("shaping", read_shaping);
  read_world(json, scenario);
  scenario.seed =
      static_cast<std::uint64_t>(json.optional_integer("seed", 0, 1000000000L).value_or(0));
  reject_idle_keys(json, scenario);
  json.reject_unknown_keys();
  return scenario;
}

}  // namespace

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  return read_json_object(path, scenario_from_json);
}

Result<Scenario> scenario_from_text(std::string_view text, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_text(text, file));
  return read_json_object(document, file, scenario_from_json);
}

std::string scenario_schema() {
  return json_schema_text(kScenarioSchema, "A scenario: task and environment",
                          [](JsonObject& json) { scenario_from_json(json); });
}

}  // namespace awmr
