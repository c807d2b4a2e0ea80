#include "awmr/identify/logs/choice/delays.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/identify/logs/choice/exchanged_lags.h"
#include "awmr/identify/logs/choice/further_terms.h"
#include "awmr/identify/logs/choice/log_terms.h"
#include "awmr/identify/logs/choice/term_trials.h"
#include "awmr/identify/logs/simulation/steering_linkage.h"
#include "awmr/trials/log_start.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

}  // namespace

std::vector<CandidateTerm> candidate_terms(const LogProblem& problem, const SearchPoint& point) {
  constexpr double kWorthATry = 3.0;
  const std::vector<FreeQuantity> channels = further_terms(problem);
  const std::vector<ScoreTest> tests = score_test(problem, point, channels);
  std::vector<CandidateTerm> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double value = tests[i].value;
    const bool is_positive = channels[i].may_be_zero() || channels[i].kind == Kind::kParameter;
    if (is_positive && !(value > 0.0)) continue;
    const double significance = std::abs(value) / tests[i].noise_error;
    if (significance > kWorthATry) {
      found.push_back({channels[i], value, significance, tests[i].gain});
    }
  }
  std::ranges::stable_sort(found, std::greater{}, &CandidateTerm::significance);
  return found;
}

namespace {

/// The candidate, followed by terms that make sense only together with it, for example the speed
/// scale of Stribeck friction.
std::vector<FreeTerm> with_companion(const LogProblem& problem, const CandidateTerm& candidate) {
  std::vector<FreeTerm> terms{{candidate.quantity, candidate.value}};
  for (const auto& [force, channel] : {std::pair(ExtraForce::kSurgeStribeck, LogChannel::kSpeed),
                                       std::pair(ExtraForce::kYawStribeck, LogChannel::kYawRate)}) {
    if (!candidate.quantity.is(force)) continue;
    terms.push_back(stribeck_speed_term(force, fastest_of(problem, channel)));
  }
  if (candidate.quantity.is(ExtraForce::kTurnDrag)) {
    terms.push_back({extra_force(ExtraForce::kTurnDragExponent), 1.0});
    terms.push_back({extra_force(ExtraForce::kTurnDragSpeedExponent), 0.5});
  }
  const auto add_partner = [&](const FreeQuantity& part, const FreeQuantity& partner) {
    const bool is_part = candidate.quantity.name() == part.name();
    if (is_part && !has(problem.model.quantities, partner.name())) terms.push_back({partner, 0.0});
  };
  for (const auto& [one, other] :
       {std::pair(extra_force(ExtraForce::kSlopeX), extra_force(ExtraForce::kSlopeY)),
        std::pair(free_term(Kind::kPositionAhead), free_term(Kind::kPositionLeft)),
        std::pair(free_term(Kind::kCompassSin), free_term(Kind::kCompassCos)),
        std::pair(free_term(Kind::kCompassSin2), free_term(Kind::kCompassCos2))}) {
    add_partner(one, other);
    add_partner(other, one);
  }
  for (const FreeQuantity& partner : partners_of(candidate.quantity, problem)) {
    terms.push_back({partner, 0.0});
  }
  if (candidate.quantity.kind == Kind::kForceSaturation) {
    const FreeQuantity sharpness = free_term(Kind::kSaturationSharpness);
    terms.push_back({sharpness, to_coordinate(sharpness.scale, kDefaultSharpness)});
  }
  return terms;
}

/// Smallest accepted exponent of the yaw rate in the drag in turns (ExtraForce::kTurnDrag). If the
/// exponent is smaller, this drag hardly depends on the yaw rate. It is then Coulomb friction of
/// the surge resistance, which a resistance family describes better.
constexpr double kFlattestTurnDrag = 0.2;

/// True if the fit has a drag in turns with an exponent below kFlattestTurnDrag.
bool is_turn_drag_of_any_rate(const NoiseIteration& fit) {
  const std::vector<FreeQuantity>& quantities = fit.problem.model.quantities;
  const auto i = place_of(quantities, ExtraForce::kTurnDragExponent);
  return i && fit.point.coordinates[*i] < kFlattestTurnDrag;
}

/// True if a term that `fit` has in addition to those of `settled` does not mean what its name
/// says: a drag in turns of any rate, or a very fast ramp of the forces (kShortestRamp_s).
bool has_wrong_term(const NoiseIteration& fit, const NoiseIteration& settled) {
  const std::vector<FreeQuantity>& quantities = fit.problem.model.quantities;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const FreeQuantity& q = quantities[i];
    const bool is_new_ramp = q.is_ramp() && !has(settled.problem.model.quantities, q.kind);
    if (is_new_ramp && fit.point.coordinates[i] < kShortestRamp_s) return true;
  }
  return is_turn_drag_of_any_rate(fit);
}

/// A filter is kept only if its AIC is lower than that of the best fit so far by more than this.
constexpr double kLikelierFilter = 10.0;
/// A candidate term is tried only if its significance is at least this fraction of that of the most
/// significant candidate. Weaker candidates wait, to save time: the search tests them again after
/// it has added the best term.
constexpr double kComparable = 0.2;
constexpr double kBeyondDoubt = 20.0;
/// Decrease of AIC by which a trial is so much better that others need not be tried.
constexpr double kClear = 100.0;

/// Returns slip of the speed and slip of the yaw rate, two terms with the form of `of_speed` (slip
/// speed or slip ratio). Empty if this form of slip of the yaw rate is not a candidate.
std::optional<std::vector<FreeTerm>> with_slip_of_yaw(const std::vector<CandidateTerm>& terms,
                                                      const CandidateTerm& of_speed) {
  const FreeQuantity yaw = wheel_slip_of(LogChannel::kYawRate, of_speed.quantity.is_ratio);
  const auto found = std::ranges::find_if(
      terms, [&](const CandidateTerm& term) { return term.quantity.name() == yaw.name(); });
  if (found == terms.end()) return std::nullopt;
  return std::vector<FreeTerm>{{of_speed.quantity, of_speed.value}, {yaw, found->value}};
}

/// Short fits (one round) of `settled` with each of the candidate terms, most significant first.
class TermTrials {
 public:
  TermTrials(const NoiseIteration& settled, const std::vector<CandidateTerm>& terms)
      : settled_(settled), terms_(terms), start_(tried(settled, {})), lowest_(settled) {}

  /// Makes the trials, and returns the fit with the lowest AIC. If no term lowers AIC, returns the
  /// fit with the most significant candidate if its score test exceeds 20 standard errors
  /// (kBeyondDoubt), else empty. Reason: in one round, AIC may rise although the term has a large
  /// effect, because the drift of the noise model had absorbed this effect before.
  std::optional<NoiseIteration> likeliest() {
    for (const CandidateTerm& candidate : terms_) {
      if (lowest_.best() && is_weak(candidate)) break;
      consider(candidate);
      if (is_clear_friction(candidate)) return std::move(lowest_.best());
    }
    if (!lowest_.best()) consider_differences_together();
    const bool is_clear = consider_lag_and_delays();
    if (!is_clear) consider_filters();
    if (delay_s_ > 0.0) consider_filters_of_both();
    if (!is_clear) consider_smoothing();
    return lowest_.best() ? std::move(lowest_.best()) : std::move(strongest_);
  }

  /// Adds further terms to `fit`, the result of likeliest(), one at a time: the most significant
  /// candidate of `fit` that lowered AIC in its own trial, as long as it lowers AIC here too. Terms
  /// with independent effects, such as a delay and the bias of a gyroscope, are thus found in one
  /// search.
  NoiseIteration with_independent_terms(NoiseIteration fit) const {
    while (true) {
      const std::vector<CandidateTerm> candidates = candidate_terms(fit.problem, fit.point);
      const auto next = std::ranges::find_if(candidates, [&](const CandidateTerm& one) {
        return contains(useful_, one.quantity.name());
      });
      if (next == candidates.end()) return fit;
      NoiseIteration more = tried(fit, with_companion(fit.problem, *next));
      if (!(akaike_of(fit) - akaike_of(more) > kTermAicThreshold)) return fit;
      fit = std::move(more);
    }
  }

 private:
  NoiseIteration trial(const std::vector<FreeTerm>& terms) const { return tried(start_, terms); }

  /// The likelier of two trials, one from the optimum of `settled`. The other start may lie in the
  /// basin of a wrong optimum, because without the term other quantities have imitated it.
  NoiseIteration trial_from_both(const std::vector<FreeTerm>& terms) const {
    NoiseIteration one = tried(settled_, terms);
    NoiseIteration other = trial(terms);
    return akaike_of(one) < akaike_of(other) ? one : other;
  }

  void consider(const CandidateTerm& candidate) {
    const FreeQuantity& more = candidate.quantity;
    const bool is_sensor = more.kind == Kind::kSensorDelay;
    const bool is_tried = contains(partners_, more.name()) || (is_sensor && has_sensor_delay_);
    if (is_tried || more.kind == Kind::kSmoothing) return;  // consider_smoothing()
    const std::vector<FreeTerm> added = with_companion(settled_.problem, candidate);
    if (added.size() == 2 || more.log != 0) {
      for (const FreeTerm& partner : added) partners_.push_back(partner.quantity.name());
    }
    const bool is_first = &candidate == &terms_.front();
    NoiseIteration fit = is_first ? trial_from_both(added) : trial(added);
    const bool may_be_wrong = more.is(ExtraForce::kTurnDrag) || more.is_ramp();
    if (may_be_wrong && has_wrong_term(fit, settled_)) return;
    if (akaike_of(settled_) - akaike_of(fit) > kTermAicThreshold && !may_be_wrong) {
      useful_.push_back(more.name());
    }
    const double found_s = fit.point.coordinates.back();
    consider_angle_beyond_stop(candidate, fit);
    if (is_beyond_doubt(candidate)) strongest_ = fit;
    has_sensor_delay_ |= lowest_.consider(std::move(fit)) && is_sensor;
    consider_slip_of_both(candidate);
    if (more.kind == Kind::kDelay) {
      consider_motor_lag(found_s);
      delay_s_ = found_s;
    }
    const bool is_averaged =
        has_kind(settled_.problem.model.quantities, Kind::kAveraging, more.channel);
    if (found_s > 0.0 && is_sensor && is_often_filtered(more.channel) && !is_averaged) {
      filters_.emplace_back(more.channel, found_s);
    }
  }

  /// True if the candidate is clearly less significant than the first one (kComparable).
  bool is_weak(const CandidateTerm& candidate) const {
    return candidate.significance < kComparable * terms_.front().significance;
  }

  /// Initial guess of a term that is tried together with a candidate: the value that its own score
  /// test predicts, or 0 if it is no candidate.
  double value_of(const FreeQuantity& term) const {
    const auto found = std::ranges::find_if(
        terms_, [&](const CandidateTerm& one) { return one.quantity.name() == term.name(); });
    return found == terms_.end() ? 0.0 : found->value;
  }

  /// Tries several kinds of terms of single logs together if they are candidates. Logs of different
  /// days often differ in several ways (battery, clock, bias of the gyroscope), and then a single
  /// one may not lower AIC, because the errors due to the others remain. Scales of forces and of
  /// resistances have similar effects, so only the more significant one of the two is tried.
  void consider_differences_together() {
    std::vector<FreeTerm> together;
    const auto is_in_it = [&](Kind kind) {
      return std::ranges::any_of(together, [&](const auto& t) { return t.quantity.kind == kind; });
    };
    int kinds = 0;
    for (const CandidateTerm& candidate : terms_) {
      const Kind kind = candidate.quantity.kind;
      if (is_weak(candidate)) break;
      if (candidate.quantity.log == 0 || is_in_it(kind)) continue;
      if (kind == Kind::kForceScale && is_in_it(Kind::kResistanceScale)) continue;
      if (kind == Kind::kResistanceScale && is_in_it(Kind::kForceScale)) continue;
      for (FreeTerm& term : with_companion(settled_.problem, candidate)) {
        term.begin = value_of(term.quantity);
        together.push_back(std::move(term));
      }
      ++kinds;
    }
    if (kinds < 2) return;
    NoiseIteration fit = trial_from_both(together);
    if (terms_.front().quantity.log != 0 && is_beyond_doubt(terms_.front())) strongest_ = fit;
    lowest_.consider(std::move(fit));
  }

  /// If several sensors seem delayed, tries all of their delays together: with a motor lag as long
  /// as the shortest delay, by which the others become shorter, and without one. Alone, none of
  /// these terms describes the logs, and a filter of one sensor could be the best substitute.
  /// Returns true if the AIC is lower by more than kClear than that of all trials before.
  bool consider_lag_and_delays() {
    std::vector<FreeTerm> delays;
    double shortest_s = std::numeric_limits<double>::infinity();
    for (const CandidateTerm& candidate : terms_) {
      if (candidate.quantity.kind != Kind::kSensorDelay || !(candidate.value > 0.0)) continue;
      delays.push_back({candidate.quantity, candidate.value});
      shortest_s = std::min(shortest_s, candidate.value);
    }
    if (delays.size() < 2) return false;
    LowestAic together = lowest_;
    together.consider(trial(delays), kLikelierFilter);
    if (!has_motor_lag(settled_.problem.model)) {
      std::erase_if(delays, [&](const FreeTerm& delay) { return delay.begin <= shortest_s; });
      for (FreeTerm& delay : delays) delay.begin -= shortest_s;
      delays.push_back({free_term(Kind::kMotorLag), shortest_s});
      together.consider(trial(delays), kLikelierFilter);
    }
    const bool is_clear = together.criterion() < lowest_.criterion() - kClear;
    lowest_ = std::move(together);
    return is_clear;
  }

  /// True if the candidate is the most significant one, and is Coulomb friction whose trial lowers
  /// AIC by more than kClear. It is then added before all other terms, because these could imitate
  /// it. If the true resistance has no Coulomb friction, the comparison of families finds that
  /// later.
  bool is_clear_friction(const CandidateTerm& candidate) {
    return &candidate == &terms_.front() && candidate.quantity.kind == Kind::kParameter &&
           lowest_.best() && akaike_of(settled_) - akaike_of(*lowest_.best()) > kClear;
  }

  /// True for the most significant candidate, if its significance is above kBeyondDoubt.
  bool is_beyond_doubt(const CandidateTerm& candidate) const {
    return &candidate == &terms_.front() && candidate.significance > kBeyondDoubt;
  }

  /// `fit` is a trial with an error of the steering linkage, in which the stop limits the angle. If
  /// the logs have commands near the stop, tries the same error with a stop that limits the
  /// command.
  void consider_angle_beyond_stop(const CandidateTerm& candidate, const NoiseIteration& fit) {
    FreeTerm term{candidate.quantity, candidate.value};
    if (!term.quantity.is_of_linkage() || !is_stop_reached(fit.problem, fit.point)) return;
    term.quantity.is_beyond_stop = true;
    lowest_.consider(trial({term}));
  }

  /// If the candidate is slip of the speed, also tries slip of speed and yaw rate together, because
  /// the same wheel encoders often measure both.
  void consider_slip_of_both(const CandidateTerm& candidate) {
    const FreeQuantity& quantity = candidate.quantity;
    if (quantity.kind != Kind::kWheelSlip || quantity.channel != LogChannel::kSpeed) return;
    if (const auto both = with_slip_of_yaw(terms_, candidate)) lowest_.consider(trial(*both));
  }

  /// `found_s`: command delay, s, of the trial that has a delay but no motor lag. Makes up to two
  /// more trials, because a motor lag may have caused this delay: one with a motor lag and a delay,
  /// and, if `found_s` is positive, one with a motor lag alone. (A delay is negative if the time
  /// stamps of the commands are late.) With back-EMF, also one in which the force decays with the
  /// lag after a command of 0 (kRunOn).
  void consider_motor_lag(double found_s) {
    if (has_motor_lag(settled_.problem.model)) return;
    const FreeQuantity delay = free_term(Kind::kDelay);
    const FreeQuantity lag = free_term(Kind::kMotorLag);
    const double lag_s = 0.5 * std::abs(found_s);
    lowest_.consider(trial({{delay, found_s - lag_s}, {lag, lag_s}}));
    if (!(found_s > 0.0)) return;
    lowest_.consider(trial({{lag, found_s}}));
    if (!has(settled_.problem.model.quantities, ParameterId::kBackEmf)) return;
    lowest_.consider(trial({{lag, found_s}, run_on_term()}), kLikelierFilter);
  }

  /// True if a mean with this delay, half of the averaging time, is plausible (may_be_mean()).
  bool is_often_averaged(LogChannel channel, double delay_s) const {
    return is_often_counted(channel) && may_be_mean(settled_.problem.model, delay_s);
  }

  /// Tries a low-pass filter in place of the delay of each channel in filters_, with the same delay
  /// as the initial guess. Each channel gets four trials: filters of first and of second order,
  /// both continuous or with a step per row. Before them, averaging over twice the delay is tried:
  /// it has as many parameters as the delay, so the likelier of both is used.
  void consider_filters() {
    // If the speed is the only channel, its filter has the same effect as a motor lag, which is
    // more common and therefore preferred.
    if (channels_of(settled_.problem.model.noise).size() <= 1) return;
    for (const auto& [channel, lag_s] : filters_) {
      if (is_often_averaged(channel, lag_s)) {
        const FreeQuantity averaging = free_term(Kind::kAveraging, channel);
        lowest_.consider(trial({{averaging, 2.0 * lag_s}}));
      }
      NoiseIteration best = trial({{sensor_lag_of(channel), lag_s}});
      for (const std::vector<FreeTerm>& other :
           {std::vector<FreeTerm>{{sensor_lag_of(channel, true), lag_s}},
            second_order_lag_of(channel, lag_s), second_order_lag_of(channel, lag_s, true)}) {
        NoiseIteration fit = trial(other);
        if (akaike_of(fit) < akaike_of(best)) best = std::move(fit);
      }
      lowest_.consider(std::move(best), kLikelierFilter);
    }
  }

  /// Tries filters of second order of speed and yaw rate together in place of a delay of the
  /// commands, because one program (an odometry or tracking filter) often computes both; also
  /// averaging of both. A filter of only one of them cannot replace a delay that both show.
  void consider_filters_of_both() {
    std::vector<FreeTerm> filters;
    std::vector<FreeTerm> filters_at_rows;
    std::vector<FreeTerm> averaging;
    const LogModel& model = settled_.problem.model;
    for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
      if (!has_channel(model.noise, channel)) return;
      if (has_kind(model.quantities, Kind::kSensorLag, channel)) return;
      if (has_kind(model.quantities, Kind::kAveraging, channel)) return;
      append(filters, second_order_lag_of(channel, delay_s_));
      append(filters_at_rows, second_order_lag_of(channel, delay_s_, true));
      averaging.push_back({free_term(Kind::kAveraging, channel), 2.0 * delay_s_});
    }
    if (may_be_mean(model, delay_s_)) lowest_.consider(trial(averaging), kLikelierFilter);
    for (const auto& both : {filters, filters_at_rows}) {
      lowest_.consider(trial(both), kLikelierFilter);
    }
  }

  /// Tries smoothing of the channels whose smoothing is a candidate term: of all these channels
  /// together, because one program often smooths several channels, and of only the most significant
  /// one. Makes each trial with a Gaussian kernel and with a moving average.
  void consider_smoothing() {
    for (const bool is_mean : {false, true}) {
      std::vector<FreeTerm> smoothing;
      for (const CandidateTerm& term : terms_) {
        if (term.quantity.kind != Kind::kSmoothing) continue;
        if (term.significance < kComparable * terms_.front().significance) break;
        smoothing.push_back({smoothing_of(term.quantity.channel, is_mean), term.value});
      }
      if (smoothing.empty()) return;
      const CandidateTerm& first = terms_.front();
      const bool is_first = first.quantity.kind == Kind::kSmoothing;
      NoiseIteration all = trial_from_both(smoothing);
      if (!is_mean && is_first && is_beyond_doubt(first)) strongest_ = all;
      lowest_.consider(std::move(all));
      if (smoothing.size() > 1) lowest_.consider(trial({smoothing.front()}));
    }
    consider_averaging();
  }

  /// Tries averaging in place of a smoothing with the same variance L^2/12. A delay of the channel
  /// starts lower by L/2, the delay of the mean.
  void consider_averaging() {
    for (const CandidateTerm& term : terms_) {
      const LogChannel channel = term.quantity.channel;
      if (term.quantity.kind != Kind::kSmoothing) continue;
      if (term.significance < kComparable * terms_.front().significance) return;
      const double averaging_s = std::sqrt(12.0 * term.value);
      if (!is_often_averaged(channel, 0.5 * averaging_s)) continue;
      const std::vector<FreeQuantity>& quantities = start_.problem.model.quantities;
      NoiseIteration from = start_;
      if (const auto i = place_of(quantities, free_term(Kind::kSensorDelay, channel).name())) {
        double& delay_s = from.point.coordinates[*i];
        delay_s = std::max(0.0, delay_s - 0.5 * averaging_s);
      }
      lowest_.consider(tried(from, {{free_term(Kind::kAveraging, channel), averaging_s}}));
    }
  }

  const NoiseIteration& settled_;
  const std::vector<CandidateTerm>& terms_;  ///< not empty
  NoiseIteration start_;                     ///< without a further term
  LowestAic lowest_;
  std::optional<NoiseIteration> strongest_;  ///< trial of the candidate that is_beyond_doubt()
  std::vector<std::string> useful_;          ///< candidates that lowered AIC in their trials
  std::vector<std::string> partners_;  ///< terms that were tried together with another candidate
  bool has_sensor_delay_ = false;      ///< true: a trial with a sensor's delay lowered AIC
  double delay_s_ = 0.0;               ///< command delay of its trial
  std::vector<std::pair<LogChannel, double>> filters_;  ///< channels with a delay, s
};

bool is_of_turning(const FreeQuantity& q) {
  return q.kind == Kind::kSteeringTrim || q.kind == Kind::kForceImbalance;
}

/// Makes both steering trim and force imbalance free if one of them is free and the commands allow
/// an estimate of both. Their effects are nearly the same, so the interval of one is valid only if
/// the other is free too.
Extended with_both_of_turning(NoiseIteration fit) {
  const std::vector<FreeQuantity>& quantities = fit.problem.model.quantities;
  std::vector<FreeQuantity> other;
  if (std::ranges::any_of(quantities, is_of_turning)) {
    std::ranges::copy_if(further_terms(fit.problem), std::back_inserter(other), is_of_turning);
  }
  return extended(std::move(fit.problem), std::move(fit.point), other,
                  std::vector<double>(other.size(), 0.0));
}

/// Returns a converged fit with one or more further free terms, selected by trials. Empty if no
/// term lowers AIC enough (settled_if_better()), or if a term is rejected (has_wrong_term()). For
/// long logs, the trials first use a sample of the windows, to save time.
std::optional<NoiseIteration> with_more_terms(const NoiseIteration& settled) {
  const std::vector<CandidateTerm> terms = candidate_terms(settled.problem, settled.point);
  if (terms.empty()) return std::nullopt;
  const auto tested = [&](std::optional<NoiseIteration> more) -> std::optional<NoiseIteration> {
    if (!more) return std::nullopt;
    more = settled_if_better(settled, with_both_of_turning(*std::move(more)));
    return more && !has_wrong_term(*more, settled) ? std::move(more) : std::nullopt;
  };
  if (is_long(settled.problem)) {
    const NoiseIteration sample = sample_of(settled);
    if (const auto found = TermTrials(sample, terms).likeliest()) {
      if (auto more = tested(with_all_windows(settled, *found))) return more;
    }
  }
  TermTrials trials(settled, terms);
  const auto found = trials.likeliest();
  if (!found) return std::nullopt;
  const NoiseIteration several = trials.with_independent_terms(*found);
  if (several.problem.model.quantities.size() > found->problem.model.quantities.size()) {
    if (auto more = tested(several)) return more;
  }
  return tested(found);
}

/// Returns a fit in which averaging replaces the filters of speed and yaw rate, with one more term
/// if that is necessary to lower AIC. Reason: the search may add a filter before it has found the
/// other delays of the fit, with which averaging alone suffices. Empty if AIC does not decrease.
std::optional<NoiseIteration> with_averaging(const NoiseIteration& settled) {
  std::optional<NoiseIteration> fit = with_averaging_for_filters(settled);
  const auto is_likelier = [&] { return akaike_of(*fit) < akaike_of(settled); };
  if (fit && !is_likelier()) fit = with_more_terms(*fit);
  if (fit && !is_likelier()) return std::nullopt;
  return fit;
}

/// Returns a fit with further free terms: candidates of the score tests, else a slower servo, else
/// a motor lag, else averaging or a delay in place of filters, else exchanged time constants. Empty
/// if none of them lowers AIC enough.
std::optional<NoiseIteration> with_next_term(const NoiseIteration& settled) {
  if (auto more = with_more_terms(settled)) return more;
  if (auto more = with_slower_servo(settled)) return more;
  if (auto more = with_motor_lag_and_delay(settled)) return more;
  if (auto more = with_averaging(settled)) return more;
  if (auto other = with_delay_for_filter(settled)) return other;
  return with_exchanged_lag(settled);
}

/// True if `fit` has a lag (Kind::kMotorLag or kSensorLag) that `before` does not have.
bool has_new_lag(const NoiseIteration& fit, const NoiseIteration& before) {
  return std::ranges::any_of(fit.problem.model.quantities, [&](const FreeQuantity& q) {
    const bool is_lag = q.kind == Kind::kMotorLag || q.kind == Kind::kSensorLag;
    return is_lag && !has(before.problem.model.quantities, q.name());
  });
}

}  // namespace

NoiseIteration find_delays_and_errors(NoiseIteration settled,
                                      const std::function<bool(const NoiseIteration&)>& ends) {
  while (auto more = with_next_term(settled)) {  // each step lowers AIC
    const bool is_lagged = has_new_lag(*more, settled);
    settled = std::move(*more);
    if (is_lagged) {
      if (auto other = with_exchanged_lag(settled)) settled = *std::move(other);
    }
    if (auto lag = with_motor_lag_for_filters(settled)) settled = std::move(*lag);
    if (auto other = with_other_stop(settled)) settled = *std::move(other);
    if (ends && ends(settled)) break;
  }
  return settled;
}

}  // namespace awmr
