#include "awmr/identify/logs/choice/family_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/identify/logs/choice/delays.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

bool is_of_yaw(ParameterId term) {
  return term == ParameterId::kYawCoulomb || term == ParameterId::kYawQuadratic;
}

/// Largest decrease of -2 ln L that a score test predicts for one more of the terms for which
/// `counts` is true. 0 if no such term was tested.
template <class Predicate>
double largest_gain(const LogFit& fit, const std::vector<ParameterId>& candidate_terms,
                    const Predicate& counts) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(candidate_terms.size(), fit.candidate_gain.size()); ++i) {
    if (counts(candidate_terms[i])) most = std::max(most, fit.candidate_gain[i]);
  }
  return most;
}

/// largest_gain() of the terms in the resistance of an axis (yaw if `of_yaw`, else surge).
double largest_gain_of_axis(const LogFit& fit, const std::vector<ParameterId>& candidate_terms,
                            bool of_yaw) {
  return largest_gain(fit, candidate_terms, [of_yaw](ParameterId term) {
    return term != ParameterId::kBackEmf && is_of_yaw(term) == of_yaw;
  });
}

/// True if a resistance family with more terms may be better (FamilyContest::only_candidates). A
/// slow drift can hide the effect of a missing term. `of_yaw`: true for terms of yaw, false for
/// surge.
bool suspicious(const LogFit& fit, const std::vector<ParameterId>& candidate_terms, bool of_yaw) {
  constexpr double kWorthATry = 4.0;  // smallest predicted decrease of -2 ln L that is worth a fit
  if (!fit.usable || largest_gain_of_axis(fit, candidate_terms, of_yaw) > kWorthATry) return true;
  const auto drifts = [&](LogChannel channel) {
    return any_sensor(fit.noise, channel, &ChannelNoise::has_slow_drift);
  };
  return of_yaw ? drifts(LogChannel::kYawRate) || drifts(LogChannel::kHeading)
                : drifts(LogChannel::kSpeed) || drifts(LogChannel::kX);
}

/// Name of the parameter that differs most between two fits, and the difference in standard errors.
std::pair<double, std::string> largest_difference(const LogFit& a, const LogFit& b) {
  std::pair<double, std::string> largest{0.0, ""};
  for (std::size_t i = 0; i < a.quantities.size(); ++i) {
    const EstimatorParameter& mine = a.report.parameters[i];
    for (const EstimatorParameter& other : b.report.parameters) {
      if (other.name != mine.name || !mine.std_error || !other.std_error) continue;
      const double size =
          std::abs(mine.value - other.value) / std::hypot(*mine.std_error, *other.std_error);
      if (size > largest.first) largest = {size, mine.name};
    }
  }
  return largest;
}

/// Returns the best of the fits that have a power law on one axis (yaw if `of_yaw`, else surge). If
/// all of them gave up early, this is the fit with the smallest error. Null if there is no such
/// fit.
const FamilyFit* with_power_law(const std::vector<FamilyFit>& fits, bool of_yaw) {
  const FamilyFit* best = nullptr;
  for (const FamilyFit& one : fits) {
    if ((of_yaw ? one.yaw : one.surge) != Family::kPower) continue;
    const bool is_better =
        !best || aic_lead(one.fit, best->fit) > 0.0 ||
        (one.fit.gave_up && best->fit.gave_up && one.fit.relative_error < best->fit.relative_error);
    if (is_better) best = &one;
  }
  return best;
}

/// The finding `power-law-inadequate` if another family replaces the power law on an axis.
std::optional<Finding> power_law_inadequate(const std::string& file, const BestFamily& result,
                                            const OpenAxes& open) {
  const FamilyFit& best = result.best;
  std::vector<std::string> reasons;
  for (const bool of_yaw : {false, true}) {
    if (!open.has(of_yaw) || (of_yaw ? best.yaw : best.surge) == Family::kPower) continue;
    const FamilyFit* power = with_power_law(result.others, of_yaw);
    if (!power || !(aic_lead(best.fit, power->fit) > kFamilyAicThreshold)) continue;
    const auto in_words = [&](const FamilyFit& fit) {
      const bool is_yaw_clear = fit.yaw != Family::kPower || best.yaw == Family::kPower;
      return families_in_words(fit.surge, fit.yaw) + (is_yaw_clear ? "" : ", yaw power");
    };
    const std::string with = in_words(best);
    const std::string without = in_words(*power);
    reasons.push_back(
        power->fit.usable ? fmt::format("the AIC of {} is lower by {} than that of {}", with,
                                        aic_decrease_text(aic_lead(best.fit, power->fit)), without)
        : power->fit.gave_up
            ? fmt::format("the errors of {} are {:.2g} times those of {}", without,
                          std::sqrt(power->fit.relative_error / best.fit.relative_error), with)
            : fmt::format("the fit of {} did not converge, but that of {} did", without, with));
  }
  if (reasons.empty()) return std::nullopt;
  return Finding{file, 0, Severity::kWarning, "power-law-inadequate",
                 fmt::format("the fit uses another resistance family (form of the resistance law), "
                             "because a power law does not describe these logs: {}",
                             fmt::join(reasons, "; "))};
}

/// The finding `family-undecided`. It needs two conditions: the AIC of the alternative is lower
/// than that of the selected family, but not significantly, and a parameter differs between the two
/// fits by more than two standard errors.
std::optional<Finding> undecided(const std::string& file, const FamilyFit& best,
                                 const FamilyFit& alternative) {
  constexpr double kApart = 2.0;
  const double gain = aic_lead(alternative.fit, best.fit);
  const auto [apart, name] = largest_difference(best.fit, alternative.fit);
  if (!alternative.fit.usable || !(gain > 0.0) || !(apart > kApart)) return std::nullopt;
  return Finding{file, 0, Severity::kWarning, "family-undecided",
                 fmt::format("these logs do not decide between the resistance families {} and "
                             "{}. The AIC of the second is lower by {:.1f}, which is not "
                             "significant, but it changes {} by {:.1f} standard errors. The "
                             "intervals are valid for {} only; record a log at more different "
                             "speeds",
                             families_in_words(best.surge, best.yaw),
                             families_in_words(alternative.surge, alternative.yaw), gain, name,
                             apart, families_in_words(best.surge, best.yaw))};
}

/// If the limit of work or time is reached, notes it in `result`, with a finding. `before`: step
/// that the search did not reach, in words. `fit`: the best fit so far.
void note_limit(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                std::string_view before, const FamilyFit& fit, BestFamily& result) {
  if (!is_over(power_law)) return;
  result.is_out_of_time = true;
  result.findings.push_back(
      {logs.front().file, 0, Severity::kWarning, "families-not-compared",
       fmt::format("the search for the resistance family reached its limit of computation or time "
                   "before {} with {}, so no intervals are given. Select the family yourself with "
                   "{}, or use a part of the logs",
                   before, families_in_words(fit.surge, fit.yaw),
                   option_text("family surge=..."))});
}

/// Index of the selected fit. The fit with a power law on the axis (yaw if `of_yaw`, else surge) is
/// selected if its AIC is at most `lead` above the lowest AIC. Otherwise the fit with the lowest
/// AIC is.
std::size_t selected(const std::vector<FamilyFit>& fits, bool of_yaw, double lead) {
  std::size_t best = 0;
  std::optional<std::size_t> power;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (aic_lead(fits[i].fit, fits[best].fit) > 0.0) best = i;
    if ((of_yaw ? fits[i].yaw : fits[i].surge) == Family::kPower && fits[i].fit.usable) power = i;
  }
  return power && aic_lead(fits[best].fit, fits[*power].fit) <= lead ? *power : best;
}

/// Fits the families `others` of one axis (yaw if `of_yaw`, else surge), and stores the best family
/// in `result.best`. If another family is better than the previous best one, the previous best one
/// is first fitted again (searched_again()), because its search may have failed.
void compete(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law, bool of_yaw,
             const std::vector<Families>& others, double lead, BestFamily& result) {
  std::vector<FamilyFit> fits;
  fits.push_back(std::move(result.best));
  std::size_t best = 0;
  LogFitOptions limited = with_limits_of(fits[best], logs, power_law);
  for (const Families& other : others) {
    if (is_over(power_law)) break;
    LogFitOptions options = limited;
    // A power law is always fitted completely, because `power-law-inadequate` compares AIC with it.
    const bool is_power_law = (of_yaw ? other.yaw : other.surge) == Family::kPower;
    if (is_power_law) options.best_so_far.reset();
    fits.push_back(fit_from(logs, options, fits[best], other.surge, other.yaw));
    if (!(aic_lead(fits.back().fit, fits[best].fit) > 0.0)) continue;
    best = fits.size() - 1;
    limited = with_limits_of(fits[best], logs, std::move(limited));
  }
  if (best != 0) {
    fits.front() = searched_again(logs, limited, std::move(fits.front()), fits[best]);
  }
  note_limit(logs, power_law, "every resistance family was compared", fits.front(), result);
  std::swap(fits.front(), fits[selected(fits, of_yaw, lead)]);
  result.best = std::move(fits.front());
  std::move(fits.begin() + 1, fits.end(), std::back_inserter(result.others));
}

std::set<std::string> names_of_terms(const LogFit& fit) {
  std::set<std::string> names;
  for (const FreeQuantity& q : fit.quantities) {
    if (q.kind != FreeQuantity::Kind::kParameter) names.insert(q.name());
  }
  return names;
}

/// Fits Stribeck friction of one axis (yaw if `of_yaw`, else surge) together with Coulomb and
/// linear friction. Keeps this fit if it is significantly better than `result.best`. A score test
/// would not predict this gain, because a power law with Coulomb friction resembles Stribeck
/// friction.
void compete_with_stribeck(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           bool of_yaw, BestFamily& result) {
  if (!result.best.fit.usable || result.is_out_of_time) return;
  const LogFitOptions limited = with_limits_for_gain(result.best, logs, power_law);
  FamilyFit stribeck = fit_stribeck(logs, limited, result.best, of_yaw);
  if (!(aic_lead(stribeck.fit, result.best.fit) > kFamilyAicThreshold)) return;
  std::swap(stribeck, result.best);
  result.others.push_back(std::move(stribeck));
}

/// Fits Coulomb friction of the surge resistance together with a dead zone if the best fit has a
/// dead zone, or if it has Coulomb friction and a score test predicts that a dead zone is
/// significant. The fit becomes the best one if its AIC is significantly lower.
void compete_with_dead_zone_and_coulomb(const std::vector<DrivingLog>& logs,
                                        const LogFitOptions& power_law, BestFamily& result) {
  const FamilyFit& best = result.best;
  const FamilyTerms terms = terms_of(best.surge);
  if (!best.fit.usable || result.is_out_of_time || terms.coulomb == terms.dead_zone) return;
  const double gain = largest_gain(best.fit, power_law.candidate_terms, [](ParameterId term) {
    return term == ParameterId::kWheelDeadZone;
  });
  if (!terms.dead_zone && !(gain > kFamilyAicThreshold)) return;
  const LogFitOptions limited = with_limits_for_gain(best, logs, power_law);
  FamilyFit both = fit_from(logs, limited, best, Family::kDeadZoneCoulomb, best.yaw);
  if (aic_lead(both.fit, best.fit) > kFamilyAicThreshold) std::swap(both, result.best);
  result.others.push_back(std::move(both));
}

/// Searches delays, lags and command errors again for the best resistance families
/// (with_new_terms()), and keeps the new fit if it is better.
void search_terms_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        BestFamily& result) {
  FamilyFit& best = result.best;
  if (!best.fit.usable || result.is_out_of_time) return;
  FamilyFit own = with_new_terms(logs, power_law, best);
  note_limit(logs, power_law, "it had looked for delays, lags and command errors", best, result);
  if (aic_lead(own.fit, best.fit) > 0.0) best = std::move(own);
}

/// Returns the families of one axis (yaw if `of_yaw`, else surge) to compare again, and removes
/// them from `others`. `winner`: the fit that was first selected on this axis. `best`: the best fit
/// now, after the choice of the other axis and of the delays. A family is compared again for one of
/// two reasons:
///   - The AIC has decreased from `winner` to `best`, and that of the family was higher than that
///     of `winner` by less than this decrease, or is unknown, because its fit gave up early.
///   - Its fit had other delays, lags or command errors than `best`. With wrong terms, the AIC of
///     the true family can be too high by any amount.
std::vector<Families> to_compare_again(const LogFit& winner, bool of_yaw, const FamilyFit& best,
                                       std::vector<FamilyFit>& others) {
  const double improved = aic_lead(best.fit, winner);
  const std::set<std::string> terms = names_of_terms(best.fit);
  std::vector<Families> again;
  std::erase_if(others, [&](const FamilyFit& other) {
    const bool is_of_axis = of_yaw ? other.yaw != best.yaw : other.surge != best.surge;
    if (!is_of_axis || !(other.fit.usable || other.fit.gave_up)) return false;
    const bool is_close =
        improved > 0.0 && (other.fit.gave_up || aic_lead(winner, other.fit) < improved);
    if (!is_close && names_of_terms(other.fit) == terms) return false;
    again.push_back(of_yaw ? Families{best.surge, other.yaw} : Families{other.surge, best.yaw});
    return true;
  });
  return again;
}

/// Largest decrease of -2 ln L, >= 0, that score tests predict for `fit` with one more delay, lag,
/// force or error of command or sensor.
double further_term_gain(const std::vector<DrivingLog>& logs, const FamilyFit& fit) {
  double most = 0.0;
  if (const auto solution = solution_of(logs, fit)) {
    for (const CandidateTerm& term : candidate_terms(solution->problem, solution->point)) {
      most = std::max(most, term.gain);
    }
  }
  return most;
}

/// A fit of other families may be worse than `result.best` only because it lacks a delay, a lag, a
/// force or an error of command or sensor, whose effect the resistance of `result.best` imitates.
/// If the score tests predict that such a term lowers the AIC of another fit by kFamilyAicThreshold
/// below that of the best one, searches the terms of that fit. (Effects that no term describes give
/// both fits the same predictions, so only the difference of the predictions counts.) The new fit
/// becomes the best one if its AIC is lower; with power laws, if it is at most `lead` higher; in
/// place of power laws, if it is lower by `lead`.
void search_terms_of_others(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                            double lead, BestFamily& result) {
  if (!result.best.fit.usable || result.is_out_of_time || is_over(power_law)) return;
  FamilyFit* other = nullptr;
  double largest_lead = kFamilyAicThreshold;
  const double gain_of_best = result.others.empty() ? 0.0 : further_term_gain(logs, result.best);
  for (FamilyFit& one : result.others) {
    if (!one.fit.usable) continue;
    const double gain = further_term_gain(logs, one) - gain_of_best;
    const double predicted_lead = aic_lead(one.fit, result.best.fit) + gain;
    if (!(predicted_lead > largest_lead)) continue;
    largest_lead = predicted_lead;
    other = &one;
  }
  if (!other) return;
  LogFitOptions options = from_optimum(other->options, *other);
  options.finds_delays = true;
  FamilyFit own = fit_with(logs, std::move(options), other->surge, other->yaw);
  note_limit(logs, power_law, "it had looked for terms of the other families", result.best, result);
  if (aic_lead(own.fit, other->fit) > 0.0) *other = std::move(own);
  const auto is_power_law = [](const FamilyFit& fit) {
    return fit.surge == Family::kPower && fit.yaw == Family::kPower;
  };
  const double needed = is_power_law(*other) ? -lead : is_power_law(result.best) ? lead : 0.0;
  if (aic_lead(other->fit, result.best.fit) > needed) std::swap(*other, result.best);
}

/// Findings of undecided() for each axis, compared with the best alternative family of this axis.
std::vector<Finding> undecided_axes(const std::string& file, const BestFamily& result) {
  std::vector<Finding> findings;
  for (const bool of_yaw : {false, true}) {
    const FamilyFit* best = nullptr;
    for (const FamilyFit& other : result.others) {
      const bool is_of_axis =
          of_yaw ? other.yaw != result.best.yaw && other.surge == result.best.surge
                 : other.surge != result.best.surge && other.yaw == result.best.yaw;
      if (!is_of_axis) continue;
      if (!best || aic_lead(other.fit, best->fit) > 0.0) best = &other;
    }
    if (!best) continue;
    if (const auto finding = undecided(file, result.best, *best)) findings.push_back(*finding);
  }
  return findings;
}

/// True if the families of one axis (yaw if `of_yaw`, else surge) have to be compared. `fit`: best
/// fit so far.
bool is_contested(const LogFitOptions& power_law, const FamilyFit& fit,
                  const FamilyContest& contest, bool of_yaw) {
  if (!contest.open.has(of_yaw)) return false;
  return !contest.only_candidates || (of_yaw ? fit.yaw : fit.surge) != Family::kPower ||
         suspicious(fit.fit, power_law.candidate_terms, of_yaw);
}

}  // namespace

std::vector<EstimatorReport> reports_of(const std::vector<FamilyFit>& fits,
                                        const FamilyFit& reference) {
  std::vector<EstimatorReport> reports;
  for (const FamilyFit& one : fits) {
    reports.push_back(one.fit.report);
    if (one.fit.usable && reference.fit.usable) {
      reports.back().aicc = aic_under(reference.fit.noise, one.fit);
    }
  }
  return reports;
}

std::size_t contender_count(const LogFitOptions& power_law, const FamilyFit& first,
                            const FamilyContest& contest) {
  std::size_t count = 0;
  for (const bool of_yaw : {false, true}) {
    if (!is_contested(power_law, first, contest, of_yaw)) continue;
    count += other_families({first.surge, first.yaw}, of_yaw).size();
  }
  return count;
}

namespace {

struct FamilyComparison {
  const std::vector<DrivingLog>& logs;
  const LogFitOptions& power_law;
  const FamilyContest& contest;
  BestFamily result;
  std::map<bool, LogFit> winners;  ///< fit first selected on each axis (key: true for yaw)

  Families families() const { return {result.best.surge, result.best.yaw}; }

  /// Fits the families `others` of one axis (yaw if `of_yaw`, else surge). If the best fit changes,
  /// searches delays, lags and command errors again.
  void compare(bool of_yaw, const std::vector<Families>& others) {
    const Families before = families();
    const std::set<std::string> terms = names_of_terms(result.best.fit);
    compete(logs, power_law, of_yaw, others, contest.lead, result);
    if (winners.try_emplace(of_yaw, result.best.fit).second) {
      compete_with_stribeck(logs, power_law, of_yaw, result);
    }
    const bool is_changed = families() != before || names_of_terms(result.best.fit) != terms;
    if (is_changed) search_terms_again(logs, power_law, result);
  }

  /// The same for Coulomb friction of the surge resistance together with a dead zone.
  void compare_dead_zone_with_coulomb() {
    const Families before = families();
    compete_with_dead_zone_and_coulomb(logs, power_law, result);
    if (families() != before) search_terms_again(logs, power_law, result);
  }
};

}  // namespace

BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest) {
  // First compare the families of one axis (surge or yaw), then those of the other. The first axis
  // is the one with the larger decrease of -2 ln L that the score tests predict for an additional
  // resistance term. If the resistance of this axis has a wrong form, it may also cause the errors
  // of the other axis.
  const bool yaw_first = largest_gain_of_axis(first.fit, power_law.candidate_terms, true) >
                         largest_gain_of_axis(first.fit, power_law.candidate_terms, false);
  FamilyComparison comparison{logs, power_law, contest, {std::move(first), {}, {}, false}, {}};
  BestFamily& result = comparison.result;
  for (const bool of_yaw : {yaw_first, !yaw_first, yaw_first}) {
    // The errors of a wrong surge resistance can hide those of a wrong yaw resistance, and the
    // reverse. After a change of one axis, is_contested() therefore decides again whether to
    // compare the families of the second axis.
    if (comparison.winners.contains(of_yaw) || result.is_out_of_time) continue;
    if (!is_contested(power_law, result.best, contest, of_yaw)) continue;
    comparison.compare(of_yaw, other_families(comparison.families(), of_yaw));
  }
  for (const bool of_yaw : {yaw_first, !yaw_first}) {
    const auto winner = comparison.winners.find(of_yaw);
    if (winner == comparison.winners.end() || result.is_out_of_time) continue;
    const auto others = to_compare_again(winner->second, of_yaw, result.best, result.others);
    if (!others.empty()) comparison.compare(of_yaw, others);
  }
  if (comparison.winners.contains(false)) comparison.compare_dead_zone_with_coulomb();
  search_terms_of_others(logs, power_law, contest.lead, result);
  const std::string& file = logs.front().file;
  for (Finding& finding : undecided_axes(file, result)) {
    result.findings.push_back(std::move(finding));
  }
  if (auto finding = power_law_inadequate(file, result, contest.open)) {
    result.findings.push_back(*std::move(finding));
  }
  return std::move(result);
}

}  // namespace awmr
