#include "awmr/model/gains_file.h"

#include <utility>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/json/json_document.h"
#include "awmr/model/gains_json.h"
#include "awmr/model/observer_rate.h"
#include "awmr/model/ranges.h"

namespace awmr {

namespace {

HeadingGains<double> heading_from_json(JsonObject& json) {
  return {.lambda = json.number("lambda", kGain),
          .mu = json.number("mu", kGain),
          .epsilon = json.number("epsilon", kGain),
          .friction_width_radps = json.optional_number("friction_width_radps", kFrictionWidth_radps)
                                      .value_or(feed_forward_rest_speed<double>()),
          .combined_friction_width_radps =
              json.optional_number("combined_friction_width_radps", kFrictionWidth_radps)
                  .value_or(0.0)};
}

SpeedGains<double> speed_from_json(JsonObject& json) {
  return {.mu = json.number("mu", kGain), .epsilon = json.number("epsilon", kGain)};
}

ObserverGains<double> observer_from_json(JsonObject& json) {
  return {.bandwidth_radps = json.number("bandwidth_radps", kObserverBandwidth),
          .yaw_max_m = json.number("yaw_max_m", kObserverLimit),
          .surge_max = json.number("surge_max", kObserverLimit)};
}

}  // namespace

Gains<double> gains_from_json(JsonObject& root) {
  return {
      .heading = root.object("heading", heading_from_json),
      .speed = root.object("speed", speed_from_json),
      .observer =
          root.optional_object("observer", observer_from_json).value_or(ObserverGains<double>{})};
}

namespace {

/// Reads one set of gains. Of the results of its tuning, only the type is checked: an object, or a
/// list of objects. Other keys are rejected.
Gains<double> gains_with_results(JsonObject& json) {
  const Gains<double> gains = gains_from_json(json);
  for (const std::string_view key :
       {"time_constants", "limits", "certificate", "trade_off", "examined", "objective", "metrics",
        "robust", "search", "baseline"}) {
    json.optional_object(key);
  }
  for (const std::string_view key : {"constraints", "goals"}) json.optional_objects(key);
  json.reject_unknown_keys();
  return gains;
}

/// Reads the gains of all modes. Keys that are not part of the format are rejected.
ModeGains gains_from_file(JsonObject& root) {
  root.schema(kGainsSchema);
  std::optional<JsonObject> modes = root.optional_object("modes");
  for (const std::string_view key : {"command", "version", "mode", "options", "inputs", "findings",
                                     "sensitivity"}) {  // the last key: only in older files
    root.ignore(key);
  }
  ModeGains gains = gains_with_results(root);
  for (const YawMode mode : kYawModes) {
    if (!modes || !modes->has(name_of(mode))) continue;
    JsonObject own = modes->object(name_of(mode));
    gains.set(mode, gains_with_results(own));
  }
  if (modes) modes->reject_unknown_keys();
  if (modes && root.has("mode")) {
    root.fault(ErrorCode::kConflict, "modes",
               "gains for one mode only (`mode`) cannot have gains of other modes; remove one of "
               "the two keys");
  }
  return gains;
}

}  // namespace

Result<ModeGains> read_mode_gains(const std::filesystem::path& path) {
  return read_json_object(path, gains_from_file);
}

Result<Gains<double>> read_gains(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const ModeGains gains, read_mode_gains(path));
  return gains.common();
}

Result<std::optional<CertifiedGains>> read_certificate(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject root(json, path.string(), "", faults);
  std::optional<JsonObject> object = root.optional_object("certificate");
  if (!object) return std::nullopt;
  CertifiedGains certificate{.set = object->string("set"),
                             .latency_s = object->number("latency_s", kNonNegative),
                             .modes = {}};
  JsonObject modes = object->object("modes");
  const std::vector<std::string> names = modes.keys();
  for (const std::string& name : names) {
    JsonObject mode = modes.object(name);
    const auto margin_s = mode.object("delay_margin").nullable_number("min_s", kNonNegative);
    certificate.modes.push_back(
        {.mode = name,
         .damping_min = mode.object("damping").number("min", {.min = -1.0, .max = 1.0}),
         .delay_margin_s = margin_s.value_or(std::numeric_limits<double>::infinity())});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return certificate;
}

namespace {

/// The keys of one set of gains.
Json gains_alone(const Json& set) {
  Json gains = Json::object();
  for (const char* const key : {"heading", "speed", "observer"}) {
    if (set.contains(key)) gains[key] = set[key];
  }
  return gains;
}

}  // namespace

std::string sha256_of_gains(const Json& document) {
  Json gains = gains_alone(document);
  if (document.contains("modes")) {
    for (const auto& [mode, own] : document["modes"].items()) {
      gains["modes"][mode] = gains_alone(own);
    }
  }
  return sha256_hex(to_text(gains));
}

bool has_changed_gains(const Json& document) {
  const Json::json_pointer place("/certificate/gains_sha256");
  return document.contains(place) && document[place] != sha256_of_gains(document);
}

std::string pointer_of(const ModeGains& gains, YawMode mode) {
  return gains.has_own(mode) ? "/modes/" + std::string(name_of(mode)) : std::string();
}

Status check_gains_text(std::string_view text, const std::string& file) {
  return check_json_object(text, file, gains_from_file);
}

Result<ModeGains> read_gains_for(const std::filesystem::path& path, double sample_time_s) {
  AWMR_ASSIGN_OR_RETURN(const ModeGains gains, read_mode_gains(path));
  for (const YawMode mode : kYawModes) {
    AWMR_RETURN_IF_ERROR(check_observer_rate(
        gains.in(mode).observer.bandwidth_radps, sample_time_s,
        path.string() + ":" + pointer_of(gains, mode) + "/observer/bandwidth_radps"));
  }
  return gains;
}

Status write_gains(const Gains<double>& gains, const std::filesystem::path& path) {
  Json json;
  json["schema"] = kGainsSchema;
  json.update(gains_to_json(gains));
  return write_file(path, to_text(json), check_gains_text);
}

}  // namespace awmr
