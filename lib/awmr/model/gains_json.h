/// Gains as the JSON of gains.json. Not installed; include from .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/model/gains.h"

namespace awmr {

inline constexpr std::string_view kGainsSchema = "awmr.gains/1";

/// {"heading": {lambda, mu, epsilon}, "speed": {mu, epsilon}}
inline Json gains_to_json(const Gains<double>& gains) {
  return {{"heading",
           {{"lambda", gains.heading.lambda},
            {"mu", gains.heading.mu},
            {"epsilon", gains.heading.epsilon}}},
          {"speed", {{"mu", gains.speed.mu}, {"epsilon", gains.speed.epsilon}}}};
}

/// Reads `heading` and `speed`.
Gains<double> gains_from_json(JsonObject& root);

}  // namespace awmr
