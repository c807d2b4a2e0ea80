#include "awmr/tune/relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "awmr/core/containers.h"
#include "awmr/tune/feasible_gains.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/problem.h"

namespace awmr {
namespace {

/// A limit of tune.json, with the constraints whose bounds depend on it.
struct Limit {
  const char* key;
  double& (*of)(ConstraintContext& context);
  NumberRule rule;
  std::vector<std::string> constraints;
  bool relaxed_by_less;  ///< true: the limit is less strict if its number is smaller
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
       {"delayed damping"},
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

/// True if the constraint's bound depends on the limit.
bool sets(const Limit& limit, std::string_view constraint) {
  return contains(limit.constraints, constraint);
}

/// Returns the limit on which a constraint's bound depends; null if there is none.
const Limit* limit_of(std::string_view constraint) {
  const auto found =
      std::ranges::find_if(limits(), [&](const Limit& limit) { return sets(limit, constraint); });
  return found == limits().end() ? nullptr : &*found;
}

/// Returns the value of a limit with which given gains just meet the constraints that depend on it.
/// `number`: present value of the limit; `all`: the constraints of these gains, evaluated with the
/// present value. The bound of the speed lag is 1/(4 zeta^2), where zeta is the limit. All other
/// bounds are proportional to their limit.
double just_met(const Limit& limit, double number, const std::vector<ConstraintReport>& all) {
  double ratio = 1.0;
  for (const ConstraintReport& c : all) {
    if (!c.required || !sets(limit, c.name)) continue;
    const double its = c.name == "speed lag" ? std::sqrt(c.limit / c.value) : c.value / c.limit;
    ratio = limit.relaxed_by_less ? std::min(ratio, its) : std::max(ratio, its);
  }
  return number * ratio;
}

/// Rounds a limit to two digits, in the direction that makes it less strict.
double in_two_digits(const Limit& limit, double number) {
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 1.0);
  return digit * (limit.relaxed_by_less ? std::floor(number / digit) : std::ceil(number / digit));
}

/// Less strict values of the limit of the steering rate, ascending; relaxed_limits() has the rule.
std::vector<double> relaxed_steering_rates(const ConstraintContext& context) {
  constexpr double kFactors[] = {1.2, 2.0, 5.0, 20.0};
  constexpr double kMaxOfServo = 2.0;
  constexpr double kSharesOfServo[] = {0.1, 0.3, 0.9};
  const auto& rate = context.limits.steering_rate_rms_degps;
  if (!rate || !context.steers() || !std::isfinite(context.servo_rate_degps)) return {};
  std::vector<double> numbers;
  const auto add = [&](double number) {
    if (std::ceil(number) > std::max(*rate, numbers.empty() ? 0.0 : numbers.back())) {
      numbers.push_back(std::ceil(number));
    }
  };
  for (const double factor : kFactors) {
    if (factor * *rate <= kMaxOfServo * context.servo_rate_degps) add(factor * *rate);
  }
  for (const double share : kSharesOfServo) add(share * context.servo_rate_degps);
  return numbers;
}

/// Less strict values of another limit, strictest first; relaxed_limits() has the rule. `strict`:
/// its present value, `loose`: its default.
std::vector<double> relaxed_numbers(const Limit& limit, double strict, double loose) {
  constexpr double kShares[] = {0.25, 0.5, 0.75, 1.0};
  constexpr double kBeyond[] = {1.4, 2.0};
  std::vector<double> numbers;
  for (const double share : kShares) {
    const double number = in_two_digits(limit, strict + share * (loose - strict));
    if (limit.relaxed_by_less ? number < strict : number > strict) numbers.push_back(number);
  }
  // The margin of T2 < T1 is not relaxed beyond its default.
  if (sets(limit, "T2 < T1 (strict)")) return numbers;
  for (const double factor : kBeyond) {
    const double number =
        limit.relaxed_by_less ? std::min(strict, loose) / factor : std::max(strict, loose) * factor;
    numbers.push_back(in_two_digits(limit, number));
  }
  return numbers;
}

/// Returns gains from which tune() could start its search. They are feasible (violation of at most
/// 0) if kFewStarts initial guesses suffice to find such gains.
Candidate start_with(TuneOptions options, const ConstraintContext& context) {
  const std::array<Gains<double>, 2> poles = starting_poles(context);
  bound_around(poles, options.bounds);
  return feasible_gains(options, context, poles[0], kFewStarts);
}

/// Returns gains that meet all limits of `context` except `limit`, and violate `limit` as little as
/// possible. Empty if no such gains are found. `loosest`: the same context, but with the least
/// strict value of `limit`.
std::optional<Gains<double>> start_without(const Limit& limit, TuneOptions options,
                                           const ConstraintContext& context,
                                           const ConstraintContext& loosest,
                                           const Gains<double>& nearest) {
  const std::array<Gains<double>, 2> poles = starting_poles(loosest);
  bound_around(poles, options.bounds);
  const auto found = least_relaxed(options, context, poles[0], limit.constraints);
  return found ? found : least_relaxed(options, context, nearest, limit.constraints);
}

/// Returns a less strict value of `limit` with which tune() finds gains to start its search. Empty
/// if there is none. First tries the value that some gains just meet. The search for a start can
/// fail with this value, because the default bounds of the gains depend on the limit. Then tries
/// less strict values (kSteps) until the search succeeds.
std::optional<double> number_that_permits(const Limit& limit, const ConstraintContext& context,
                                          const Gains<double>& nearest,
                                          const TuneOptions& requested) {
  constexpr double kSteps[] = {1.0, 1.1, 1.3, 2.0, 5.0, 20.0};
  ConstraintContext changed = context;
  double& number = limit.of(changed);
  const double strict = number;
  number = limit.relaxed_by_less ? limit.rule.min : 0.999 * limit.rule.max;
  const auto gains = start_without(limit, requested, context, changed, nearest);
  if (!gains) return std::nullopt;
  const double needed = just_met(limit, strict, constraints_of(*gains, context));
  for (const double step : kSteps) {
    number = in_two_digits(limit, limit.relaxed_by_less ? needed / step : needed * step);
    if (!allows(limit.rule, number) || number == strict) continue;
    if (start_with(requested, changed).violation <= 0.0) return number;
  }
  return std::nullopt;
}

}  // namespace

std::string advice_on(const std::string& constraint) {
  if (const Limit* limit = limit_of(constraint)) {
    return fmt::format("relax `{}` of tune.json", limit->key);
  }
  return constraint == "speed gain" ? "give a vehicle file with a shorter sample_time_s"
                                    : "widen `bounds` of tune.json, or give slower scenarios";
}

std::string pointer_to(const std::string& constraint) {
  const Limit* limit = limit_of(constraint);
  return limit ? fmt::format("/{}", limit->key) : "/bounds";
}

std::vector<std::vector<RelaxedLimit>> relaxed_limits(const ConstraintContext& context) {
  ConstraintContext given = context;
  ConstraintContext by_default;
  std::vector<std::vector<RelaxedLimit>> all;
  for (const Limit& limit : limits()) {
    const bool is_rate = sets(limit, kSteeringRate);
    std::vector<RelaxedLimit> relaxed;
    for (const double number :
         is_rate ? relaxed_steering_rates(context)
                 : relaxed_numbers(limit, limit.of(given), limit.of(by_default))) {
      relaxed.push_back(
          {.key = limit.key, .number = number, .is_steering_rate = is_rate, .context = context});
      limit.of(relaxed.back().context) = number;
    }
    if (!relaxed.empty()) all.push_back(std::move(relaxed));
  }
  return all;
}

std::vector<std::string> single_changes(const Gains<double>& nearest,
                                        const ConstraintContext& context,
                                        const TuneOptions& requested) {
  std::vector<std::string> changes;
  for (const Limit& limit : limits()) {
    const bool is_rate = sets(limit, kSteeringRate);
    if (is_rate && !context.limits.steering_rate_rms_degps) continue;
    if (const auto number = number_that_permits(limit, context, nearest, requested)) {
      changes.push_back(fmt::format("`{}` {:g}", limit.key, *number));
    }
  }
  if (context.form == ReachingForm::kStrict) {
    ConstraintContext changed = context;
    changed.form = ReachingForm::kPaper;
    if (start_with(requested, changed).violation <= 0.0) changes.push_back("`form` \"paper\"");
  }
  for (const SearchedGain& gain : kSearchedGains) {
    if (!(requested.bounds.*gain.bounds)) continue;
    TuneOptions wider = requested;
    wider.bounds.*gain.bounds = std::nullopt;
    const Candidate start = start_with(wider, context);
    if (start.violation > 0.0) continue;
    changes.push_back(
        fmt::format("`bounds/{}` that contain {:.3g}", gain.key, gain.of(start.gains)));
  }
  return changes;
}

}  // namespace awmr
