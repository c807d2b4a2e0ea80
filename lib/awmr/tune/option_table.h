/// Table of the numbers among the options of tune(): key in tune.json, value and permitted range.
/// tune.json, `awmr tune`, Python and tune() take the ranges from here. Private to tune/ and apps/.
///
/// Each function calls field(key, value, rule) for every number of its options, in the order of the
/// documentation. `value` is a double, an int, or an optional number or interval.
#pragma once

#include <algorithm>
#include <optional>

#include "awmr/core/number_rule.h"
#include "awmr/model/ranges.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

inline constexpr NumberRule kDraws{.min = 0.0, .max = 1000.0};
inline constexpr NumberRule kBetweenZeroAndOne{
    .min = 0.0, .max = 1.0, .min_excluded = true, .max_excluded = true};
/// Range of damping ratios and noise_share. A limit below 1e-6 would have no effect.
inline constexpr NumberRule kLimitShare{.min = 1e-6, .max = 1.0};
/// Ranges for a goal: the limit of a metric, and the required share of drawn vehicles.
inline constexpr NumberRule kGoalLimit{.min = 1e-9, .max = 1e9};
inline constexpr NumberRule kGoalShare{.min = 0.5, .max = 0.999};
inline constexpr NumberRule kMassFactor{.min = 0.1, .max = 10.0};
inline constexpr NumberRule kUpToAMillion{.min = 0.0, .max = 1e6, .min_excluded = true};

template <class Options, class Field>
void search_options(Options& options, const Field& field) {
  field("margin", options.margin, kBetweenZeroAndOne);
  field("global_evaluations", options.global_evaluations, NumberRule{.min = 1.0, .max = 1e6});
  field("local_evaluations", options.local_evaluations, NumberRule{.min = 0.0, .max = 1e6});
  field("draws", options.draws, kDraws);
  field("judged_draws", options.evaluation_draws, NumberRule{.min = 0.0, .max = 100'000.0});
  field("tail_share", options.tail_share, NumberRule{.min = 0.0, .max = 1.0, .min_excluded = true});
  field("activity_max", options.activity_max, kUpToAMillion);
}

/// Keys of /limits in tune.json and gains.json.
template <class Limits, class Field>
void limit_options(Limits& limits, const Field& field) {
  field("steering_rate_rms_degps", limits.steering_rate_rms_degps, kUpToAMillion);
  field("damping", limits.damping, kLimitShare);
  field("late_damping", limits.late_damping, kLimitShare);
  field("delayed_damping", limits.delayed_damping, kLimitShare);
  field("noise_share", limits.noise_share, kLimitShare);
}

/// Keys of /weights.
template <class Weights, class Field>
void weight_options(Weights& weights, const Field& field) {
  for (const ObjectiveTerm& term : kObjectiveTerms) {
    field(term.name, weights.*term.weight, NumberRule{.min = 0.0, .max = 1e6});
  }
}

/// True if at least one weight is above 0.
inline bool has_weight(const ObjectiveWeights& weights) {
  bool has = false;
  weight_options(weights, [&](const char*, double weight, const auto&) { has |= weight > 0.0; });
  return has;
}

/// A gain that the search varies.
struct SearchedGain {
  const char* key;  ///< in /bounds of tune.json
  std::optional<Interval> GainBounds::*bounds;
  double& (*at)(Gains<double>& gains);
  double of(Gains<double> gains) const { return at(gains); }
};
/// In the order of a Point (problem.h), which SearchSpace::gains_at() repeats.
inline constexpr SearchedGain kSearchedGains[] = {
    {"lambda", &GainBounds::lambda, [](Gains<double>& g) -> double& { return g.heading.lambda; }},
    {"mu", &GainBounds::mu, [](Gains<double>& g) -> double& { return g.heading.mu; }},
    {"epsilon", &GainBounds::epsilon,
     [](Gains<double>& g) -> double& { return g.heading.epsilon; }},
    {"speed_mu", &GainBounds::speed_mu, [](Gains<double>& g) -> double& { return g.speed.mu; }},
    {"speed_epsilon", &GainBounds::speed_epsilon,
     [](Gains<double>& g) -> double& { return g.speed.epsilon; }}};

/// The gains, each moved to the nearest value within its bounds.
inline Gains<double> clamped(Gains<double> gains, const GainBounds& bounds) {
  for (const SearchedGain& gain : kSearchedGains) {
    const std::optional<Interval>& bound = bounds.*gain.bounds;
    if (bound) gain.at(gains) = std::clamp(gain.of(gains), bound->lo, bound->hi);
  }
  return gains;
}

/// Keys of /bounds in tune.json. The number range applies to both ends of each interval.
template <class Bounds, class Field>
void bound_options(Bounds& bounds, const Field& field) {
  for (const SearchedGain& gain : kSearchedGains) {
    field(gain.key, bounds.*gain.bounds, kUpToAMillion);
  }
}

/// Keys of /observer.
template <class Search, class Field>
void observer_options(Search& observer, const Field& field) {
  field("bandwidth_radps", observer.bandwidth_radps, kObserverBandwidth);
  field("yaw_max_m", observer.yaw_max_m, kObserverLimit);
  field("surge_max", observer.surge_max, kObserverLimit);
}

}  // namespace awmr
