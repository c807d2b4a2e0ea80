// JSON Schemas of recover.json and suggest.json.
#include <limits>

#include "awmr/core/json.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/findings_json.h"

namespace awmr {
namespace {

constexpr long kMaxRuns = std::numeric_limits<int>::max();

void describe_recovery(JsonObject& json) {
  json.schema("awmr.recover/1");
  read_provenance(json);
  json.integer("runs", 0, kMaxRuns);
  json.integer("refused_runs", 0, kMaxRuns);
  json.string("noise");
  for (JsonObject& parameter : json.object("parameters").values()) {
    for (const char* key :
         {"truth", "bias", "rmse", "mean_std_error", "coverage95", "worst_relative_error"}) {
      parameter.number(key);
    }
    parameter.integer("runs", 0, kMaxRuns);
    parameter.reject_unknown_keys();
  }
  read_findings(json);
  json.reject_unknown_keys();
}

void describe_suggestion(JsonObject& json) {
  json.schema("awmr.suggest/1");
  read_provenance(json);
  json.string("criterion");
  json.strings("assumptions");
  for (JsonObject& missing : json.optional_objects("missing")) {
    missing.string("parameter");
    missing.string("trial");
    missing.reject_unknown_keys();
  }
  for (JsonObject& turn : json.optional_objects("scrub_turns")) {
    for (const char* key :
         {"force_left", "force_right", "most_force_left", "most_force_right", "yaw_rate_degps"}) {
      turn.number(key);
    }
    turn.reject_unknown_keys();
  }
  json.optional_string("about_scrub");
  if (auto coasting = json.optional_object("steer_while_coasting")) {
    for (const char* key : {"speed_mps", "steering_deg", "rolling_yaw_rate_degps"}) {
      coasting->number(key, kPositive);
    }
    coasting->reject_unknown_keys();
  }
  for (JsonObject& trial : json.objects("trials")) {
    trial.choice("kind", kTrialKindNames);
    JsonObject settings = trial.object("settings");
    for (const std::string& name : settings.keys()) settings.number(name);
    trial.string("words");
    trial.string("parameter");
    for (const char* key : {"std_error_before", "std_error_after", "information_gain"}) {
      trial.number(key);
    }
    trial.reject_unknown_keys();
  }
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string recover_schema() {
  return json_schema_text("awmr.recover/1", "Bias and coverage of the fits, by simulation",
                          describe_recovery);
}

std::string suggest_schema() {
  return json_schema_text("awmr.suggest/1", "The trials to record next", describe_suggestion);
}

}  // namespace awmr
