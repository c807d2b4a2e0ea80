/// Conversions to and from JSON that tune.json, gains.json and the shards of an evaluation
/// (tune_shard.h) share. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/certificate.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// A limit of TuningLimits in (0, 1], with its key in tune.json and gains.json.
struct LimitKey {
  const char* name;
  double TuningLimits::*limit;
};
inline constexpr LimitKey kLimitKeys[] = {{"damping", &TuningLimits::damping},
                                          {"late_damping", &TuningLimits::late_damping},
                                          {"delayed_damping", &TuningLimits::delayed_damping},
                                          {"noise_share", &TuningLimits::noise_share}};

/// Reads the limits of tune.json or gains.json; missing ones get their default.
TuningLimits read_limits(JsonObject json);

/// Reads `/examined` of gains.json.
ExaminedRange read_examined(JsonObject json);

/// Reads and writes a goal, as in tune.json.
TuningGoal read_goal(JsonObject json);
Json goal_json(const TuningGoal& goal);

/// Reads and writes the unmodelled variation, as in tune.json.
UnmodelledVariation read_open(JsonObject json);
Json open_json(const UnmodelledVariation& open);

/// `/robust/quantiles` of gains.json: by mode, then gains.
Json quantiles_json(const std::vector<EvaluatedGains>& evaluated);
/// `/robust/by_scenario` of gains.json: the quantiles by scenario, then mode, then gains.
Json by_scenario_json(const std::vector<EvaluatedGains>& evaluated);
/// `/certificate` of gains.json.
Json certificate_json(const Certificate& certificate);
/// `/trade_off` of gains.json.
Json trade_off_json(const TradeOff& trade_off);
/// `/goals` of gains.json.
Json goals_json(const std::vector<EvaluatedGoal>& goals);

}  // namespace awmr
