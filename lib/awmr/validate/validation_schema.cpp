// Reader of validation.json. Makes the JSON Schema of the whole file, and reads `/tyres` from one.
#include <limits>
#include <string>

#include "awmr/core/json.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/ranges.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

constexpr const char* kValidationSchema = "awmr.validation/1";
constexpr long kMax = std::numeric_limits<int>::max();
const std::string kVerdicts[] = {"reproduced", "not-reproduced"};

void describe_trials(JsonObject& json) {
  for (JsonObject& trial : json.objects("trials")) {
    trial.choice("kind", kTrialKindNames);
    trial.string("file");
    trial.integer("line", 0, kMax);
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
      channel.integer("samples", 0, kMax);
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

std::optional<Estimate> read_estimate(JsonObject& json, const char* key) {
  auto object = json.optional_object(key);
  if (!object) return std::nullopt;
  Estimate estimate;
  estimate.value = object->number("value", kPositive);
  estimate.std_error = object->number("std_error", kPositive);
  estimate.ci95 = object->interval("ci95");
  object->reject_unknown_keys();
  return estimate;
}

TyreFit tyres_from_json(JsonObject json) {
  TyreFit fit;
  fit.tyres.friction = json.number("friction", kTyreFrictionRule);
  fit.tyres.cornering_per_rad =
      json.number("cornering_stiffness_per_rad", kCorneringStiffnessRule_per_rad);
  JsonObject estimates = json.object("estimates");
  fit.friction = read_estimate(estimates, "friction");
  fit.cornering_per_rad = read_estimate(estimates, "cornering_stiffness_per_rad");
  estimates.reject_unknown_keys();
  fit.windows = static_cast<int>(json.integer("windows", kMinTyreWindows, kMax));
  JsonObject channels = json.object("held_out");
  for (const std::string& channel : channels.keys()) {
    JsonObject error = channels.object(channel);
    fit.held_out.push_back({.channel = channel,
                            .model_rms = error.number("model_rms", kNonNegative),
                            .four_wheel_rms = error.number("four_wheel_rms", kNonNegative)});
    error.reject_unknown_keys();
  }
  std::vector<std::string> plants = names_in(kPlantKindNames);
  plants.emplace_back(kUndecidedPlant);
  fit.better = value_in(kPlantKindNames, plants[json.choice("better", plants)]);
  json.reject_unknown_keys();
  return fit;
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
      channel.integer("samples", 1, kMax);
      channel.number("noise");
      channel.boolean("noise_from_log");
      for (const char* key : {"distance", "allowed", "difference"}) channel.number(key);
      channel.boolean("inside");
      channel.nullable_number("outside_since_s");
      channel.reject_unknown_keys();
    }
    for (JsonObject& hypothesis : drive.objects("suspects")) {
      hypothesis.string("what");
      hypothesis.number("value");
      hypothesis.string("unit");
      hypothesis.number("explained", {.min = 0.0, .max = 1.0});
      hypothesis.reject_unknown_keys();
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

/// Reads the whole file. Returns its tyres, the only part that other commands use.
std::optional<TyreFit> validation_from_json(JsonObject& json) {
  json.schema(kValidationSchema);
  read_provenance(json);
  json.boolean("passed");
  json.string("verdict");
  JsonObject errors = json.object("rms_relative_error");
  for (const char* kind : {"surge", "turning", "coastdown"}) errors.nullable_number(kind);
  errors.reject_unknown_keys();
  describe_trials(json);
  describe_logs(json);
  std::optional<TyreFit> tyres;
  if (const auto object = json.optional_object("tyres")) tyres = tyres_from_json(*object);
  describe_drives(json);
  describe_claims(json);
  read_findings(json);
  json.reject_unknown_keys();
  return tyres;
}

void describe_validation(JsonObject& json) { validation_from_json(json); }

}  // namespace

Result<TyreFit> read_tyres(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject root(json, path.string(), "", faults);
  if (json.is_object()) root.schema(kValidationSchema);
  if (!faults.empty()) return input_errors(std::move(faults));
  std::optional<TyreFit> tyres = validation_from_json(root);
  if (faults.empty() && !tyres) {
    faults.push_back({ErrorCode::kMissing, path.string() + ":/tyres",
                      "is missing; use the output of awmr validate --tyres"});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return *std::move(tyres);
}

std::string validation_schema() {
  return json_schema_text(kValidationSchema, "Validation of a model on its trials, logs and claims",
                          describe_validation);
}

}  // namespace awmr
