#include "awmr/tune/pole_placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

/// Grid of the search for the heading poles -lambda and -k, k = mu/epsilon: 13 ratios lambda/k,
/// each sqrt(1/2) times the one before; for each ratio 54 values of k downwards from 1/T_s, each
/// 2^(-1/4) times the one before.
constexpr int kRatios = 13;
const double kRatioStep = std::sqrt(0.5);
const double kRateStep = std::pow(0.5, 0.25);
constexpr int kRates = 54;
constexpr int kBisections = 6;
/// Factor on the limits of the constraints, so that rounding errors do not violate a limit.
constexpr double kInside = 1.0 - 1e-9;
/// Smallest mu (rad/s^2) and mu_s (m/s^2), used if the vehicle has no resistance.
constexpr double kMinMu = 1e-3;

const ConstraintReport& named(const std::vector<ConstraintReport>& all, std::string_view name) {
  return *std::ranges::find(all, name, &ConstraintReport::name);
}

/// Smallest mu or mu_s that meets the constraint "mu dominates" or "mu_s dominates".
double least_mu(const ConstraintReport& dominates) {
  return std::max(dominates.limit / kInside, kMinMu);
}

/// Returns the speed gains with the fastest pole. `at_one`: the constraints, evaluated with all
/// gains equal to 1. The constraints on the speed loop limit the sum of mu_s/eps_s and the
/// bandwidth of the observer. Their values are proportional to this sum, so the largest sum follows
/// by division.
SpeedGains<double> place_speed_pole(const std::vector<ConstraintReport>& at_one,
                                    double observer_radps) {
  constexpr double kMinRate = 1e-3;
  const ConstraintReport& gain = named(at_one, "speed gain");
  const ConstraintReport& lag = named(at_one, "speed lag");
  const double sum =
      kInside * std::min(gain.limit / gain.value, lag.limit / lag.value) * (1.0 + observer_radps);
  const double rate = std::max(sum - observer_radps, kMinRate);
  const double mu = least_mu(named(at_one, "mu_s dominates"));
  return {mu, mu / rate};
}

/// Finds the heading poles for given speed gains and a given observer.
class HeadingPoles {
 public:
  HeadingPoles(const ConstraintContext& context, const SpeedGains<double>& speed, double mu,
               const ObserverGains<double>& observer)
      : context_(context),
        own_(context),
        last_violating_(context),
        speed_(speed),
        mu_(mu),
        observer_(observer) {
    own_.draws.clear();
    last_violating_.draws.clear();
  }

  Gains<double> fastest() {
    const double largest =
        kInside * context_.margin * (context_.form == ReachingForm::kStrict ? 1.0 : 2.0);
    for (int i = 0; i < kRatios; ++i) look_along(largest * std::pow(kRatioStep, i));
    return found_ ? best_ : nearest_;
  }

 private:
  Gains<double> gains_at(double ratio, double k) const {
    const double lambda = ratio * k;
    return with_friction_width({{lambda, mu_, mu_ / k}, speed_, observer_}, context_);
  }

  bool is_met(const Gains<double>& gains) {
    // To save time, all drawn vehicles are examined only if two vehicles meet all constraints: the
    // nominal vehicle and the drawn vehicle that last violated a constraint.
    double broken = violation(gains, own_);
    if (broken <= 0.0 && !last_violating_.draws.empty()) broken = violation(gains, last_violating_);
    if (broken <= 0.0 && !context_.draws.empty()) broken = violation_of_draws(gains);
    if (broken < least_broken_) {
      least_broken_ = broken;
      nearest_ = gains;
    }
    return broken <= 0.0;
  }

  /// Largest violation on all vehicles. If it is above 0, sets last_violating_.
  double violation_of_draws(const Gains<double>& gains) {
    const double broken = violation(gains, context_);
    for (std::size_t i = 0; broken > 0.0 && i < context_.draws.size(); ++i) {
      last_violating_.draws.assign(1, context_.draws[i]);
      if (violation(gains, last_violating_) > 0.0) break;
    }
    return broken;
  }

  /// Searches the largest k = mu/epsilon, from 1/T_s downwards, that meets every constraint at a
  /// fixed ratio lambda/k. Stops if lambda would not exceed the largest lambda found so far.
  void look_along(double ratio) {
    double k = 1.0 / context_.sample_time_s;
    const auto is_behind = [&](double rate) {
      return found_ && ratio * rate <= best_.heading.lambda;
    };
    for (int i = 0; i < kRates && !is_behind(k); ++i, k *= kRateStep) {
      if (!is_met(gains_at(ratio, k))) continue;
      double too_fast = k / kRateStep;
      for (int j = 0; j < kBisections; ++j) {
        const double middle = std::sqrt(k * too_fast);
        (is_met(gains_at(ratio, middle)) ? k : too_fast) = middle;
      }
      if (is_behind(k)) return;
      best_ = gains_at(ratio, k);
      found_ = true;
      return;
    }
  }

  const ConstraintContext& context_;
  ConstraintContext own_;  ///< the nominal vehicle without the drawn ones
  /// The nominal vehicle and the drawn vehicle that last violated a constraint.
  ConstraintContext last_violating_;
  SpeedGains<double> speed_;
  double mu_;
  ObserverGains<double> observer_;
  bool found_ = false;
  Gains<double> best_{};
  Gains<double> nearest_{};
  double least_broken_ = std::numeric_limits<double>::infinity();
};

/// Returns gains with the same poles and wider boundary layers, which contain the errors at the
/// start of a scenario: S = lambda e (e: the largest heading step) and the speed error u_d. Then
/// only the actuators saturate, not the control laws. With k = mu/epsilon and k_s = mu_s/epsilon_s,
/// the conditions are
///   mu >= lambda k e,   mu_s >= k_s u_d
Gains<double> with_wide_layers(Gains<double> gains, const ConstraintContext& context) {
  const double k = gains.heading.mu / gains.heading.epsilon;
  const double k_s = gains.speed.mu / gains.speed.epsilon;
  gains.heading.mu = std::max(gains.heading.mu, gains.heading.lambda * k * context.step_rad);
  gains.heading.epsilon = gains.heading.mu / k;
  gains.speed.mu = std::max(gains.speed.mu, k_s * context.speed_mps);
  gains.speed.epsilon = gains.speed.mu / k_s;
  return gains;
}

}  // namespace

Gains<double> place_poles(const ConstraintContext& context, const ObserverGains<double>& observer) {
  const Gains<double> one{{1.0, 1.0, 1.0}, {1.0, 1.0}, observer};
  const std::vector<ConstraintReport> at_one = constraints_of(one, context);
  return HeadingPoles(context, place_speed_pole(at_one, observer.bandwidth_radps),
                      least_mu(named(at_one, "mu dominates")), observer)
      .fastest();
}

Gains<double> slowed(Gains<double> gains, double share) {
  gains.heading.lambda *= share;
  gains.heading.epsilon *= share;
  gains.heading.mu *= share * share;
  return gains;
}

std::array<Gains<double>, 2> starting_poles(const ConstraintContext& context,
                                            const ObserverGains<double>& observer) {
  const Gains<double> narrow = place_poles(context, observer);
  return {with_wide_layers(narrow, context), narrow};
}

}  // namespace awmr
