/// Converts gains to and from the JSON of gains.json. Not installed; include from .cpp files only.
#pragma once

#include <string>

#include "awmr/core/json/json.h"
#include "awmr/model/gains.h"

namespace awmr {

inline constexpr std::string_view kGainsSchema = "awmr.gains/1";

/// Returns {"heading": {lambda, mu, epsilon}, "speed": {mu, epsilon}}. "heading" also has the keys
/// "friction_width_radps" and "combined_friction_width_radps" for values other than the defaults.
/// An observer adds "observer": {bandwidth_radps, yaw_max_m, surge_max}.
inline Json gains_to_json(const Gains<double>& gains) {
  Json json = {{"heading",
                {{"lambda", gains.heading.lambda},
                 {"mu", gains.heading.mu},
                 {"epsilon", gains.heading.epsilon}}},
               {"speed", {{"mu", gains.speed.mu}, {"epsilon", gains.speed.epsilon}}}};
  if (gains.heading.friction_width_radps > feed_forward_rest_speed<double>()) {
    json["heading"]["friction_width_radps"] = gains.heading.friction_width_radps;
  }
  if (gains.heading.combined_friction_width_radps > 0.0) {
    json["heading"]["combined_friction_width_radps"] = gains.heading.combined_friction_width_radps;
  }
  if (gains.observer.is_on()) {
    json["observer"] = {{"bandwidth_radps", gains.observer.bandwidth_radps},
                        {"yaw_max_m", gains.observer.yaw_max_m},
                        {"surge_max", gains.observer.surge_max}};
  }
  return json;
}

/// Reads `heading`, `speed` and, if present, `observer`. Missing keys and gains out of range
/// (ranges.h) are added to the faults of `root`.
Gains<double> gains_from_json(JsonObject& root);

/// SHA-256 of the gains in a document of gains.json: of its keys `heading`, `speed` and `observer`,
/// those in `modes` included.
std::string sha256_of_gains(const Json& document);

/// True if the gains of this document of gains.json are not those of its certificate, because
/// `/certificate/gains_sha256` is not their hash. False if the document has no such hash.
bool has_changed_gains(const Json& document);

}  // namespace awmr
