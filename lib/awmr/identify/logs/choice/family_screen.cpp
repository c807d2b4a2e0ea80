#include "awmr/identify/logs/choice/family_screen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/parallel.h"
#include "awmr/identify/logs/choice/back_emf.h"
#include "awmr/identify/logs/log_setup.h"
#include "awmr/identify/logs/problem/multistart.h"

namespace awmr {

std::vector<Families> other_families(const Families& from, bool of_yaw) {
  std::vector<Families> others;
  for (const Family family : values_in(kFamilyNames)) {
    if (of_yaw && terms_of(family).dead_zone) continue;  // yaw has no dead zone
    if (family == Family::kDeadZoneCoulomb) continue;    // compared last in best_family()
    const Families other = of_yaw ? Families{from.surge, family} : Families{family, from.yaw};
    if (other != from) others.push_back(other);
  }
  return others;
}

namespace {

using Kind = FreeQuantity::Kind;

/// A model that differs from the current one in one family, by one additional term, or by back-EMF.
struct Neighbour {
  Families families;
  std::vector<FreeTerm> more = {};
  bool has_back_emf = false;
};

/// A term that a round may add, and the quantity that the score test takes in its place: for a lag,
/// which has no score test, the delay with nearly the same effect.
struct TestedTerm {
  FreeTerm term;
  FreeQuantity tested;
};

/// A delay of the commands, a lag of the motors, filters of the channels `filtered`, and ramps of
/// the forces. Leaves out terms that the fit estimates, and a lag that the vehicle file gives.
std::vector<TestedTerm> tested_terms(const FamilyFit& fit,
                                     const std::vector<LogChannel>& filtered) {
  constexpr double kBegin_s = 0.05;
  constexpr double kBeginOfRamp_s = 0.3;
  const FreeQuantity delay = free_term(Kind::kDelay);
  std::vector<TestedTerm> found{{{delay, kBegin_s}, delay}};
  if (!fit.options.vehicle.motor_time_constant_s) {
    found.push_back({{free_term(Kind::kMotorLag), kBegin_s}, delay});
  }
  for (const LogChannel channel : filtered) {
    found.push_back({{sensor_lag_of(channel), kBegin_s}, free_term(Kind::kSensorDelay, channel)});
  }
  for (const FreeQuantity& ramp :
       {force_rise(false), force_rise(true), free_term(Kind::kForceFall)}) {
    found.push_back({{ramp, kBeginOfRamp_s}, ramp});
  }
  std::erase_if(found, [&](const TestedTerm& one) {
    return has(fit.fit.quantities, one.term.quantity.name());
  });
  return found;
}

/// Speed and yaw rate, if they are measured, unless no other channel is: the filter of an only
/// channel has the same effect as a motor lag.
std::vector<LogChannel> filtered_channels(const std::vector<DrivingLog>& logs) {
  std::vector<LogChannel> channels;
  const auto is_measured = [&](LogChannel channel) { return is_logged(logs, {channel}); };
  if (std::ranges::count_if(kChannels, is_measured) < 2) return channels;
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    if (is_measured(channel)) channels.push_back(channel);
  }
  return channels;
}

/// The terms of tested_terms() for which a score test predicts that they lower the sum of squared
/// errors of the rough fit by at least 1 %.
std::vector<FreeTerm> promising_terms(const std::vector<DrivingLog>& logs, const FamilyFit& rough) {
  constexpr double kWorthATry = 0.01;
  const std::vector<TestedTerm> candidates = tested_terms(rough, filtered_channels(logs));
  std::vector<FreeQuantity> tested;
  for (const TestedTerm& one : candidates) tested.push_back(one.tested);
  const LogProblem problem = rough_problem(log_problem(logs, rough.options));
  const std::vector<ScoreTest> tests =
      score_test(problem, {rough.fit.coordinates, rough.fit.initial_states}, tested);
  const double squares = rough.fit.relative_error * problem.readings();
  std::vector<FreeTerm> terms;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool is_in_range =
        candidates[i].term.quantity.kind == Kind::kDelay || tests[i].value > 0.0;
    const double decrease = std::pow(tests[i].value / tests[i].noise_error, 2);
    if (is_in_range && decrease > kWorthATry * squares) terms.push_back(candidates[i].term);
  }
  return terms;
}

/// Returns the models to try next. Each changes the family of an open axis, or adds one of `terms`,
/// or adds back-EMF if it is a candidate term.
std::vector<Neighbour> neighbours_of(const FamilyFit& fit, const OpenAxes& open,
                                     const std::vector<FreeTerm>& terms) {
  const Families families{fit.surge, fit.yaw};
  std::vector<Neighbour> neighbours;
  for (const bool of_yaw : {false, true}) {
    if (!open.has(of_yaw)) continue;
    for (const Families& other : other_families(families, of_yaw)) neighbours.push_back({other});
  }
  for (const FreeTerm& term : terms) {
    neighbours.push_back({families, {term}});
    const bool is_lag = term.quantity.is(Kind::kMotorLag);
    if (!is_lag || !fit.options.frees(ParameterId::kBackEmf)) continue;
    neighbours.push_back({families, {term, run_on_term()}});
  }
  if (contains(fit.options.candidate_terms, ParameterId::kBackEmf)) {
    neighbours.push_back({.families = families, .has_back_emf = true});
  }
  return neighbours;
}

}  // namespace

FamilyFit likely_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                          const FamilyFit& first, const OpenAxes& open) {
  constexpr double kClearlyLess = 0.98;
  // Back-EMF counts only if it reduces LogFit::relative_error to less than this fraction of its
  // value without back-EMF. A smaller decrease may come from another effect that the model lacks,
  // for which back-EMF can partly compensate.
  constexpr double kMuchLess = 0.67;
  constexpr double kExplained = 0.7;
  constexpr int kMostChanges = 8;
  const FamilyFit same = fit_roughly_from(logs, power_law, first, first.surge, first.yaw, {});
  FamilyFit best = same;
  OpenAxes now = open;  // without the axis that was changed last
  for (int changes = 0; changes < kMostChanges && !is_over(power_law); ++changes) {
    const std::vector<Neighbour> neighbours = neighbours_of(best, now, promising_terms(logs, best));
    std::vector<FamilyFit> fits(neighbours.size());
    parallel_for(fits.size(), power_law.threads, [&](std::size_t i) {
      const auto& [families, more, has_back_emf] = neighbours[i];
      LogFitOptions options = with_back_emf_as_in(best, power_law);
      if (has_back_emf) options = with_back_emf(std::move(options));
      fits[i] = fit_roughly_from(logs, options, best, families.surge, families.yaw, more);
      if (has_back_emf && !(kMuchLess * best.fit.relative_error > fits[i].fit.relative_error)) {
        fits[i].fit.relative_error = std::numeric_limits<double>::infinity();
      }
    });
    const auto least = std::ranges::min_element(
        fits, {}, [](const FamilyFit& other) { return other.fit.relative_error; });
    if (least == fits.end() ||
        !(least->fit.relative_error < kClearlyLess * best.fit.relative_error)) {
      break;
    }
    now = {.surge = open.surge && least->surge == best.surge,
           .yaw = open.yaw && least->yaw == best.yaw};
    best = std::move(*least);
  }
  // If the best families decrease the errors only a little, the errors have another cause, such as
  // unequal motors. The original families are then kept.
  const double excess = std::max(0.0, best.fit.relative_error - 1.0);
  return excess < kExplained * (same.fit.relative_error - 1.0) ? best : same;
}

FamilyFit refine(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                 const FamilyFit& rough) {
  LogFitOptions options = from_optimum(rough.options, rough);
  options.finds_delays = power_law.finds_delays;
  options.optional_coulomb = power_law.optional_coulomb;
  const auto is_requested = [&](const FreeTerm& term) {
    return std::ranges::any_of(power_law.terms, [&](const FreeTerm& other) {
      return other.quantity.kind == term.quantity.kind;
    });
  };
  std::erase_if(options.terms, [&](const FreeTerm& term) {
    const bool is_kept = term.quantity.is_ramp() || term.quantity.log != 0;
    return !is_kept || is_requested(term);
  });
  append(options.terms, power_law.terms);
  return fit_with(logs, std::move(options), rough.surge, rough.yaw);
}

}  // namespace awmr
