/// Conversions to and from JSON that tune.json and gains.json share. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/model/certificate.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Reads a number of option_table.h. If the key is absent, a required value stays as it is, and an
/// optional number or interval becomes empty.
struct ReadOption {
  JsonObject& json;

  void operator()(const char* key, double& value, const NumberRule& rule) const;
  void operator()(const char* key, std::optional<double>& value, const NumberRule& rule) const;
  void operator()(const char* key, int& value, const NumberRule& rule) const;
  void operator()(const char* key, Interval& value, const NumberRule& rule) const;
  void operator()(const char* key, std::optional<Interval>& value, const NumberRule& rule) const;
};

/// Reads the limits of tune.json or gains.json. Missing keys get their default values.
TuningLimits read_limits(JsonObject& json);

/// Reads `/examined` of gains.json.
ExaminedRange read_examined(JsonObject& json);

/// Reads and writes the unmodelled variation (key `open` of tune.json).
UnmodelledVariation read_open(JsonObject& json);
Json open_json(const UnmodelledVariation& open);

/// Writes `/robust/quantiles` of gains.json, the quantiles of the metrics by mode, then gains.
Json quantiles_json(const std::vector<EvaluatedGains>& evaluated);
/// Writes `/robust/by_scenario` of gains.json, the quantiles by scenario, then mode, then gains.
Json by_scenario_json(const std::vector<EvaluatedGains>& evaluated);
/// `/certificate` of gains.json.
Json certificate_json(const Certificate& certificate);
/// `/trade_off` of gains.json.
Json trade_off_json(const TradeOff& trade_off);
/// `/goals` of gains.json.
Json goals_json(const std::vector<EvaluatedGoal>& goals);

}  // namespace awmr
