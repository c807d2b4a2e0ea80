#include "awmr/tune/relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/tune/option_table.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/search.h"

namespace awmr {
namespace {

/// A limit of tune.json with the constraints that it sets.
struct Limit {
  const char* key;
  double& (*of)(ConstraintContext& context);
  NumberRule rule;
  std::vector<std::string> constraints;
  bool relaxed_by_less;  ///< true: a smaller number permits more gains
};

const std::vector<Limit>& limits() {
  static const std::vector<Limit> table{
      {"margin",
       [](ConstraintContext& c) -> double& { return c.margin; },
       kBetweenZeroAndOne,
       {"T2 < T1 (paper)", "T2 < T1 (strict)"},
       false},
      {"limits/damping",
       [](ConstraintContext& c) -> double& { return c.limits.damping; },
       kLimitShare,
       {"heading damping", "speed lag"},
       true},
      {"limits/late_damping",
       [](ConstraintContext& c) -> double& { return c.limits.late_damping; },
       kLimitShare,
       {"late damping"},
       true},
      {"limits/delayed_damping",
       [](ConstraintContext& c) -> double& { return c.limits.delayed_damping; },
       kLimitShare,
       {"delay margin"},
       true},
      {"limits/noise_share",
       [](ConstraintContext& c) -> double& { return c.limits.noise_share; },
       kLimitShare,
       {"noise gain"},
       false},
      {"limits/steering_rate_rms_degps",
       [](ConstraintContext& c) -> double& { return *c.limits.steering_rate_rms_degps; },
       kUpToAMillion,
       {kSteeringRate},
       false}};
  return table;
}

/// Number of the limit at which gains with these constraints just meet the constraints that it
/// sets, rounded to two digits towards more permitted gains. The limit of the speed lag is
/// 1/(4 zeta^2); all others are proportional to their number in tune.json.
double just_met(const Limit& limit, double number, const std::vector<ConstraintReport>& all) {
  double ratio = 1.0;
  for (const ConstraintReport& c : all) {
    const bool is_set_by = std::ranges::find(limit.constraints, c.name) != limit.constraints.end();
    if (!c.required || !is_set_by) continue;
    const double its = c.name == "speed lag" ? std::sqrt(c.limit / c.value) : c.value / c.limit;
    ratio = limit.relaxed_by_less ? std::min(ratio, its) : std::max(ratio, its);
  }
  const double needed = number * ratio;
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(needed))) - 1.0);
  return digit * (limit.relaxed_by_less ? std::floor(needed / digit) : std::ceil(needed / digit));
}

/// A range of the gains in tune.json.
struct Bound {
  const char* key;
  std::optional<Interval> GainBounds::*range;
  double (*gain)(const Gains<double>& gains);
};
constexpr Bound kBounds[] = {
    {"lambda", &GainBounds::lambda, [](const Gains<double>& g) { return g.heading.lambda; }},
    {"mu", &GainBounds::mu, [](const Gains<double>& g) { return g.heading.mu; }},
    {"epsilon", &GainBounds::epsilon, [](const Gains<double>& g) { return g.heading.epsilon; }},
    {"speed_mu", &GainBounds::speed_mu, [](const Gains<double>& g) { return g.speed.mu; }},
    {"speed_epsilon", &GainBounds::speed_epsilon,
     [](const Gains<double>& g) { return g.speed.epsilon; }}};

}  // namespace

std::string advice_on(const std::string& constraint) {
  for (const Limit& limit : limits()) {
    if (std::ranges::find(limit.constraints, constraint) != limit.constraints.end()) {
      return fmt::format("relax `{}` of tune.json", limit.key);
    }
  }
  return constraint == "speed gain" ? "give a vehicle file with a shorter sample_time_s"
                                    : "widen `bounds` of tune.json, or give slower scenarios";
}

std::vector<std::string> single_changes(const Gains<double>& nearest,
                                        const ConstraintContext& context,
                                        const TuneOptions& requested,
                                        std::span<const Gains<double>> poles) {
  TuneOptions options = requested;
  bound_around(poles, options.bounds);
  std::vector<std::string> changes;
  for (const Limit& limit : limits()) {
    ConstraintContext changed = context;
    if (limit.constraints.front() == kSteeringRate && !context.limits.steering_rate_rms_degps) {
      continue;
    }
    const auto gains = least_relaxed(options, context, nearest, limit.constraints);
    if (!gains) continue;
    double& number = limit.of(changed);
    number = just_met(limit, number, constraints_of(*gains, context));
    if (!allows(limit.rule, number)) continue;
    if (!least_relaxed(options, changed, *gains, {})) continue;
    changes.push_back(fmt::format("`{}` {:g}", limit.key, number));
  }
  if (context.form == ReachingForm::kStrict) {
    ConstraintContext changed = context;
    changed.form = ReachingForm::kPaper;
    if (least_relaxed(options, changed, nearest, {})) changes.push_back("`form` \"paper\"");
  }
  for (const Bound& bound : kBounds) {
    if (!(requested.bounds.*bound.range)) continue;
    TuneOptions wider = requested;
    wider.bounds.*bound.range = std::nullopt;
    bound_around(poles, wider.bounds);
    const auto gains = least_relaxed(wider, context, nearest, {});
    if (!gains) continue;
    changes.push_back(
        fmt::format("`bounds/{}` that contain {:.3g}", bound.key, bound.gain(*gains)));
  }
  return changes;
}

}  // namespace awmr
