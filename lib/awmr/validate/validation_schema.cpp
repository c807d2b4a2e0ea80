// Schema of validation.json as written by validation_text().
#include <limits>
#include <string>

#include "awmr/core/json.h"
#include "awmr/model/findings_json.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

constexpr long kMost = std::numeric_limits<int>::max();
const std::string kVerdicts[] = {"reproduced", "not-reproduced"};

void describe_trials(JsonObject& json) {
  for (JsonObject& trial : json.objects("trials")) {
    trial.choice("kind", kTrialKindNames);
    trial.string("file");
    trial.integer("line", 0, kMost);
    trial.string("unit");
    trial.number("measured");
    trial.nullable_number("predicted");
    trial.nullable_number("relative_error");
    trial.reject_unknown_keys();
  }
}

void describe_error(JsonObject json) {
  for (const char* key : {"nrmse", "r2", "rmse"}) json.number(key);
  json.reject_unknown_keys();
}

void describe_logs(JsonObject& json) {
  for (JsonObject& log : json.objects("logs")) {
    log.string("file");
    log.number("horizon_s", kPositive);
    log.boolean("passed");
    for (JsonObject& channel : log.object("channels").values()) {
      channel.string("unit");
      channel.integer("samples", 0, kMost);
      describe_error(channel.object("one_step"));
      describe_error(channel.object("long_horizon"));
      if (auto series = channel.optional_object("series")) {
        for (const char* key : {"t_s", "measured", "predicted"}) series->numbers(key);
        series->reject_unknown_keys();
      }
      channel.reject_unknown_keys();
    }
    log.reject_unknown_keys();
  }
}

void describe_drives(JsonObject& json) {
  for (JsonObject& drive : json.optional_objects("drives")) {
    drive.string("file");
    drive.string("scenario");
    drive.choice("mode", kYawModeNames);
    drive.number("from_s");
    drive.number("duration_s", kPositive);
    drive.integer("draws", 39, 10000);
    drive.number("p_value", {.min = 0.0, .max = 1.0});
    drive.boolean("inside");
    for (JsonObject& channel : drive.object("channels").values()) {
      channel.string("unit");
      channel.integer("samples", 1, kMost);
      channel.number("noise");
      channel.boolean("noise_from_log");
      for (const char* key : {"distance", "allowed", "difference"}) channel.number(key);
      channel.boolean("inside");
      channel.nullable_number("outside_since_s");
      channel.reject_unknown_keys();
    }
    for (JsonObject& suspect : drive.objects("suspects")) {
      suspect.string("what");
      suspect.number("value");
      suspect.string("unit");
      suspect.number("explained", {.min = 0.0, .max = 1.0});
      suspect.reject_unknown_keys();
    }
    drive.reject_unknown_keys();
  }
}

void describe_cases(JsonObject& claim) {
  for (JsonObject& one : claim.optional_objects("cases")) {
    one.choice("allocation", kAllocationFormNames);
    one.interval("wheel_force");
    one.number("mass_factor", kPositive);
    one.choice("split", kCombinedSplitNames);
    one.choice("verdict", kVerdicts);
    one.optional_string("mode");
    one.reject_unknown_keys();
  }
}

void describe_claims(JsonObject& json) {
  for (JsonObject& claim : json.objects("claims")) {
    for (const char* key : {"id", "statement", "figure", "tolerance", "why"}) claim.string(key);
    claim.choice("verdict", kVerdicts);
    if (auto modes = claim.optional_object("modes")) {
      for (const std::string& mode : modes->keys()) modes->choice(mode, kVerdicts);
    }
    describe_cases(claim);
    claim.optional_string("decided_by");
    claim.reject_unknown_keys();
  }
}

void describe_validation(JsonObject& json) {
  json.schema("awmr.validation/1");
  read_provenance(json);
  json.boolean("passed");
  json.string("verdict");
  JsonObject errors = json.object("rms_relative_error");
  for (const char* kind : {"surge", "turning", "coastdown"}) errors.nullable_number(kind);
  errors.reject_unknown_keys();
  describe_trials(json);
  describe_logs(json);
  describe_drives(json);
  describe_claims(json);
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string validation_schema() {
  return json_schema_text("awmr.validation/1", "A model held against its trials, logs and claims",
                          describe_validation);
}

}  // namespace awmr
