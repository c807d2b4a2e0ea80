#include "awmr/identify/logs/family_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/identify/logs/family_score.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

bool is_of_yaw(ParameterId term) {
  return term == ParameterId::kYawCoulomb || term == ParameterId::kYawQuadratic;
}

/// Largest decrease of -2 ln L that the score tests predict for a term of the yaw resistance
/// (`of_yaw`) or of the surge resistance; 0 without terms.
double largest_gain(const LogFit& fit, const std::vector<ParameterId>& candidate_terms,
                    bool of_yaw) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(candidate_terms.size(), fit.candidate_gain.size()); ++i) {
    const bool is_of_axis =
        candidate_terms[i] != ParameterId::kBackEmf && is_of_yaw(candidate_terms[i]) == of_yaw;
    if (is_of_axis) most = std::max(most, fit.candidate_gain[i]);
  }
  return most;
}

/// True if a family with more terms may be better. One of these reasons suffices: the score test of
/// a term predicts a large decrease of -2 ln L; the errors have a slow drift, which can hide a
/// missing term; `fit` did not converge. `of_yaw`: true for terms of yaw, false for terms of surge.
bool suspicious(const LogFit& fit, const std::vector<ParameterId>& candidate_terms, bool of_yaw) {
  constexpr double kWorthATry = 4.0;  // decrease of -2 ln L
  if (!fit.usable || largest_gain(fit, candidate_terms, of_yaw) > kWorthATry) return true;
  const auto drifts = [&](LogChannel channel) {
    const auto noise = fit.noise.find(channel);
    return noise != fit.noise.end() && noise->second.has_slow_drift();
  };
  return of_yaw ? drifts(LogChannel::kYawRate) || drifts(LogChannel::kHeading)
                : drifts(LogChannel::kSpeed) || drifts(LogChannel::kX);
}

/// The parameter with the largest difference between two fits, and that difference in standard
/// errors.
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

Finding taken(const std::string& file, const FamilyFit& best, const LogFit& power_law) {
  const std::string families = families_in_words(best.surge, best.yaw);
  const std::string why =
      power_law.usable
          ? fmt::format("the AIC of {} is lower by {:.0f}", families, aic_lead(best.fit, power_law))
          : fmt::format("its fit did not converge, but that of {} did", families);
  return {file, 0, Severity::kWarning, "power-law-inadequate",
          "another resistance family is used, because a power law does not describe these logs: " +
              why};
}

/// The finding `family-undecided` if the alternative has a lower AIC than the selected family, but
/// not significantly, and a parameter differs between the two by more than two standard errors.
std::optional<Finding> undecided(const std::string& file, const FamilyFit& best,
                                 const FamilyFit& alternative) {
  constexpr double kApart = 2.0;
  const double gain = aic_lead(alternative.fit, best.fit);
  const auto [apart, name] = largest_difference(best.fit, alternative.fit);
  if (!alternative.fit.usable || !(gain > 0.0) || !(apart > kApart)) return std::nullopt;
  return Finding{file, 0, Severity::kWarning, "family-undecided",
                 fmt::format("these logs do not decide between {} and {}: the AIC of the latter is "
                             "lower by {:.1f}, which is not significant, but {} changes by {:.1f} "
                             "standard errors. The intervals are valid for {} only; record a log "
                             "at more different speeds",
                             families_in_words(best.surge, best.yaw),
                             families_in_words(alternative.surge, alternative.yaw), gain, name,
                             apart, families_in_words(best.surge, best.yaw))};
}

Finding not_compared(const std::string& file, const FamilyFit& first) {
  return {
      file, 0, Severity::kWarning, "families-not-compared",
      fmt::format(
          "the search reached its limit before every resistance family was compared with {}, so "
          "the intervals are withdrawn. Select the family ({}), or use a part of the logs",
          families_in_words(first.surge, first.yaw), option_text("family surge=..."))};
}

Finding terms_not_searched(const std::string& file, const FamilyFit& best) {
  return {file, 0, Severity::kWarning, "families-not-compared",
          fmt::format(
              "the search reached its limit before it had looked for delays, lags and command "
              "errors with {}, so the intervals are withdrawn. Select the family ({}), or use a "
              "part of the logs",
              families_in_words(best.surge, best.yaw), option_text("family surge=..."))};
}

struct Contender {
  Family surge;
  Family yaw;
};

/// The pairs of families that differ from `first` in the yaw family (`of_yaw`) or the surge family.
std::vector<Contender> contenders(const FamilyFit& first, bool of_yaw) {
  std::vector<Contender> found;
  for (const Family family : values_in(kFamilyNames)) {
    if (of_yaw && family == Family::kDeadZone) continue;  // wheels have dead zones, yaw has none
    const Contender c = of_yaw ? Contender{first.surge, family} : Contender{family, first.yaw};
    if (c.surge != first.surge || c.yaw != first.yaw) found.push_back(c);
  }
  return found;
}

/// Fits the families `others`. The best of them replaces the fit in `result.best` if its AIC is
/// lower by more than `lead`. Returns the fit of the families that were in `result.best` before;
/// the search for it is repeated if an alternative is better (searched_again()).
LogFit compete(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
               const std::vector<Contender>& others, double lead, BestFamily& result) {
  FamilyFit first = std::move(result.best);
  std::vector<FamilyFit> alternatives;
  std::size_t best = 0;
  for (const Contender& other : others) {
    if (is_over(power_law)) break;
    const FamilyFit& from = alternatives.empty() ? first : alternatives[best];
    alternatives.push_back(fit_from(logs, power_law, from, other.surge, other.yaw));
    if (aic_lead(alternatives.back().fit, alternatives[best].fit) > 0.0)
      best = alternatives.size() - 1;
  }
  if (!alternatives.empty()) {
    first = searched_again(logs, power_law, std::move(first), alternatives[best]);
  }
  if (is_over(power_law)) {
    result.is_out_of_time = true;
    result.findings.push_back(not_compared(logs.front().file, first));
  }
  if (alternatives.empty()) {
    result.best = std::move(first);
    return result.best.fit;
  }
  const LogFit of_first = first.fit;
  if (aic_lead(alternatives[best].fit, first.fit) > lead) {
    std::swap(first, alternatives[best]);
  }
  result.best = std::move(first);
  for (FamilyFit& alternative : alternatives) result.others.push_back(std::move(alternative));
  return of_first;
}

/// Names of the free delays, lags, command errors and offsets of a fit.
std::set<std::string> names_of_terms(const LogFit& fit) {
  std::set<std::string> names;
  for (const FreeQuantity& q : fit.quantities) {
    if (q.kind != FreeQuantity::Kind::kParameter) names.insert(q.name());
  }
  return names;
}

/// Fits Stribeck friction of one axis (yaw if `of_yaw`, else surge) in addition to Coulomb and
/// linear friction. Keeps this fit if it is significantly better than `result.best`. (A power with
/// Coulomb friction resembles Stribeck friction so much that a score test does not show it.)
void compete_with_stribeck(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           bool of_yaw, BestFamily& result) {
  if (!result.best.fit.usable || result.is_out_of_time) return;
  FamilyFit stribeck = fit_stribeck(logs, power_law, result.best, of_yaw);
  if (aic_lead(stribeck.fit, result.best.fit) > kFamilyAicThreshold) {
    std::swap(stribeck, result.best);
    result.others.push_back(std::move(stribeck));
  }
}

/// Searches delays, lags and command errors again for the best families. Reason: terms that were
/// found with other families may only have compensated for a wrong resistance. Keeps the new fit if
/// it is better.
void search_terms_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        BestFamily& result) {
  FamilyFit& best = result.best;
  if (!best.fit.usable || result.is_out_of_time) return;
  LogFitOptions options = from_optimum(best.options, best);
  options.finds_delays = true;
  std::erase_if(options.terms,
                [](const FreeTerm& term) { return !term.quantity.is_stribeck_or_slope(); });
  options.terms.insert(options.terms.end(), power_law.terms.begin(), power_law.terms.end());
  options.candidate_terms = power_law.candidate_terms;
  FamilyFit own = fit_with(logs, std::move(options), best.surge, best.yaw);
  if (is_over(power_law)) {
    result.is_out_of_time = true;
    result.findings.push_back(terms_not_searched(logs.front().file, best));
  }
  if (aic_lead(own.fit, best.fit) > 0.0) best = std::move(own);
}

/// Returns the families of one axis (yaw if `of_yaw`, else surge) to compare again, and removes
/// them from `others`. `winner`: the fit first selected on this axis. `best`: the fit after the
/// other axis and the delays were selected too. A family is compared again if its AIC was close:
/// above that of `winner` by less than `best` has improved on `winner`. It is also compared again
/// if its fit had other delays, lags or command errors than `best`: with wrong terms, the true
/// family can lose by any amount.
std::vector<Contender> to_compare_again(const LogFit& winner, bool of_yaw, const FamilyFit& best,
                                        std::vector<FamilyFit>& others) {
  const double improved = aic_lead(best.fit, winner);
  const std::set<std::string> terms = names_of_terms(best.fit);
  std::vector<Contender> again;
  std::erase_if(others, [&](const FamilyFit& other) {
    const bool is_of_axis = of_yaw ? other.yaw != best.yaw : other.surge != best.surge;
    if (!is_of_axis || !other.fit.usable) return false;
    const bool is_close = aic_lead(winner, other.fit) < improved;
    if (!is_close && names_of_terms(other.fit) == terms) return false;
    again.push_back(of_yaw ? Contender{best.surge, other.yaw} : Contender{other.surge, best.yaw});
    return true;
  });
  return again;
}

/// The findings of undecided() for the best alternative on each axis.
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

/// True if other yaw families (`of_yaw`) or surge families are to be fitted.
bool is_contested(const LogFitOptions& power_law, const FamilyFit& first,
                  const FamilyContest& contest, bool of_yaw) {
  if (!(of_yaw ? contest.yaw : contest.surge)) return false;
  return !contest.only_candidates || suspicious(first.fit, power_law.candidate_terms, of_yaw);
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
    if (is_contested(power_law, first, contest, of_yaw)) count += contenders(first, of_yaw).size();
  }
  return count;
}

namespace {

/// Adds the findings about undecided families, and about families that replace the power law.
/// `power_fit`: the best fit of the first families.
void add_findings(const std::string& file, const LogFit& power_fit, BestFamily& result) {
  for (Finding& finding : undecided_axes(file, result)) {
    result.findings.push_back(std::move(finding));
  }
  const bool other = result.best.surge != Family::kPower || result.best.yaw != Family::kPower;
  if (other && aic_lead(result.best.fit, power_fit) > kFamilyAicThreshold) {
    result.findings.push_back(taken(file, result.best, power_fit));
  }
}

/// The comparison of families in progress.
struct FamilyComparison {
  const std::vector<DrivingLog>& logs;
  const LogFitOptions& power_law;
  const FamilyContest& contest;
  BestFamily result;
  LogFit power_fit;                 ///< the best fit under the families of `start`
  std::pair<Family, Family> start;  ///< first families: surge, yaw
  std::map<bool, LogFit> winners;   ///< key true: yaw; fits before delays were searched again

  std::pair<Family, Family> families() const { return {result.best.surge, result.best.yaw}; }

  /// Fits the families `others` of an axis. If the best fit changes, the terms are searched again.
  void compare(bool of_yaw, const std::vector<Contender>& others) {
    const auto before = families();
    const std::set<std::string> terms = names_of_terms(result.best.fit);
    LogFit of_first = compete(logs, power_law, others, contest.lead, result);
    if (winners.try_emplace(of_yaw, result.best.fit).second) {
      compete_with_stribeck(logs, power_law, of_yaw, result);
    }
    const bool is_changed = families() != before || names_of_terms(result.best.fit) != terms;
    if (is_changed) search_terms_again(logs, power_law, result);
    if (before == start) power_fit = std::move(of_first);
  }
};

}  // namespace

BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest) {
  const std::map<bool, bool> is_suspect{{false, is_contested(power_law, first, contest, false)},
                                        {true, is_contested(power_law, first, contest, true)}};
  // The axis (surge or yaw) whose score tests have the larger gain goes first, because a wrong
  // resistance law of one axis also causes errors in the other axis.
  const bool yaw_first = largest_gain(first.fit, power_law.candidate_terms, true) >
                         largest_gain(first.fit, power_law.candidate_terms, false);
  const std::pair start{first.surge, first.yaw};
  LogFit power_fit = first.fit;
  BestFamily alone{std::move(first), {}, {}, false};
  FamilyComparison comparison{logs,  power_law, contest, std::move(alone), std::move(power_fit),
                              start, {}};
  BestFamily& result = comparison.result;
  for (const bool of_yaw : {yaw_first, !yaw_first, yaw_first}) {
    // After a change of one axis, the other axis is compared too. Reasons: the errors of a wrong
    // law of one axis can hide those of the other, and if the friction of one axis is not a power
    // law, that of the other is probably not one either.
    const bool is_open = is_suspect.at(of_yaw) || (comparison.families() != comparison.start &&
                                                   (of_yaw ? contest.yaw : contest.surge));
    if (!is_open || comparison.winners.contains(of_yaw) || result.is_out_of_time) continue;
    comparison.compare(of_yaw, contenders(result.best, of_yaw));
  }
  for (const bool of_yaw : {yaw_first, !yaw_first}) {
    const auto winner = comparison.winners.find(of_yaw);
    if (winner == comparison.winners.end() || result.is_out_of_time) continue;
    const auto others = to_compare_again(winner->second, of_yaw, result.best, result.others);
    if (!others.empty()) comparison.compare(of_yaw, others);
  }
  add_findings(logs.front().file, comparison.power_fit, result);
  return std::move(result);
}

}  // namespace awmr
