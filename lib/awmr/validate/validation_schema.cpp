// Reader of validation.json. Makes the JSON Schema of the whole file, and reads `/tyres` from one.
#include <limits>
#include <string>

#include "awmr/core/json/json.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/ranges.h"
#include "awmr/validate/validate.h"

namespace awmr {
namespace {

constexpr const char* kValidationSchema = "awmr.validation/1";
constexpr long kMax = std::numeric_limits<int>::max();
const std::string kVerdicts[] = {"reproduced", "not-reproduced"};

void describe_trial(JsonObject& trial) {
  trial.choice("kind", kTrialKindNames);
  trial.string("file");
  trial.integer("line", 0, kMax);
  trial.string("unit");
  trial.number("measured");
  trial.nullable_number("predicted");
  trial.nullable_number("relative_error");
}

void describe_log(JsonObject& log) {
  log.string("file");
  log.number("horizon_s", kPositive);
  log.boolean("passed");
  log.object("channels").values([](JsonObject& channel) {
    channel.string("unit");
    channel.integer("samples", 0, kMax);
    const auto describe_error = numbers_at({"nrmse", "r2", "rmse"});
    channel.object("one_step", describe_error);
    channel.object("long_horizon", describe_error);
    channel.optional_object("series", [](JsonObject& series) {
      for (const char* key : {"t_s", "measured", "predicted"}) series.numbers(key);
    });
  });
}

Estimate read_estimate(JsonObject& json) {
  Estimate estimate;
  estimate.value = json.number("value", kPositive);
  estimate.std_error = json.number("std_error", kPositive);
  estimate.ci95 = json.interval("ci95");
  return estimate;
}

TyreFit tyres_from_json(JsonObject& json) {
  TyreFit fit;
  fit.tyres.friction = json.number("friction", kTyreFrictionRule);
  fit.tyres.cornering_per_rad =
      json.number("cornering_stiffness_per_rad", kCorneringStiffnessRule_per_rad);
  json.object("estimates", [&](JsonObject& estimates) {
    fit.friction = estimates.optional_object("friction", read_estimate);
    fit.cornering_per_rad = estimates.optional_object("cornering_stiffness_per_rad", read_estimate);
  });
  fit.windows = static_cast<int>(json.integer("windows", kMinTyreWindows, kMax));
  JsonObject channels = json.object("held_out");
  for (const std::string& channel : channels.keys()) {
    channels.object(channel, [&](JsonObject& error) {
      fit.held_out.push_back({.channel = channel,
                              .model_rms = error.number("model_rms", kNonNegative),
                              .four_wheel_rms = error.number("four_wheel_rms", kNonNegative)});
    });
  }
  std::vector<std::string> plants = names_in(kPlantKindNames);
  plants.emplace_back(kUndecidedPlant);
  fit.better = value_in(kPlantKindNames, plants[json.choice("better", plants)]);
  return fit;
}

void describe_drive(JsonObject& drive) {
  drive.string("file");
  drive.string("scenario");
  drive.choice("mode", kYawModeNames);
  drive.number("from_s");
  drive.number("duration_s", kPositive);
  drive.integer("draws", 39, 10000);
  drive.number("p_value", {.min = 0.0, .max = 1.0});
  drive.boolean("inside");
  drive.object("channels").values([](JsonObject& channel) {
    channel.string("unit");
    channel.integer("samples", 1, kMax);
    channel.number("noise");
    channel.boolean("noise_from_log");
    for (const char* key : {"distance", "allowed", "difference"}) channel.number(key);
    channel.boolean("inside");
    channel.nullable_number("outside_since_s");
  });
  drive.objects("suspects", [](JsonObject& hypothesis) {
    hypothesis.string("what");
    hypothesis.number("value");
    hypothesis.string("unit");
    hypothesis.number("explained", {.min = 0.0, .max = 1.0});
  });
}

void describe_case(JsonObject& one) {
  one.choice("allocation", kAllocationFormNames);
  one.interval("wheel_force");
  one.number("mass_factor", kPositive);
  one.choice("split", kCombinedSplitNames);
  one.choice("verdict", kVerdicts);
  one.optional_string("mode");
}

void describe_claim(JsonObject& claim) {
  for (const char* key : {"id", "statement", "figure", "tolerance", "why"}) claim.string(key);
  claim.choice("verdict", kVerdicts);
  if (auto modes = claim.optional_object("modes")) {
    for (const std::string& mode : modes->keys()) modes->choice(mode, kVerdicts);
  }
  claim.optional_objects("cases", describe_case);
  claim.optional_string("decided_by");
}

/// Reads the whole file. Returns its tyres, the only part that other commands use.
std::optional<TyreFit> validation_from_json(JsonObject& json) {
  json.schema(kValidationSchema);
  read_provenance(json);
  json.boolean("passed");
  json.string("verdict");
  json.object("rms_relative_error", [](JsonObject& errors) {
    for (const char* kind : {"surge", "turning", "coastdown"}) errors.nullable_number(kind);
  });
  json.objects("trials", describe_trial);
  json.objects("logs", describe_log);
  std::optional<TyreFit> tyres = json.optional_object("tyres", tyres_from_json);
  json.optional_objects("drives", describe_drive);
  json.objects("claims", describe_claim);
  read_findings(json);
  json.reject_unknown_keys();
  return tyres;
}

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
                          [](JsonObject& json) { validation_from_json(json); });
}

}  // namespace awmr
