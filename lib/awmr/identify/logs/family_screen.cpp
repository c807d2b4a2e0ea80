#include "awmr/identify/logs/family_screen.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/parallel.h"
#include "awmr/identify/logs/back_emf.h"
#include "awmr/identify/logs/log_setup.h"

namespace awmr {

std::vector<Families> other_families(const Families& from, bool of_yaw) {
  std::vector<Families> others;
  for (const Family family : values_in(kFamilyNames)) {
    if (of_yaw && family == Family::kDeadZone) continue;  // yaw has no dead zone
    const Families other = of_yaw ? Families{from.surge, family} : Families{family, from.yaw};
    if (other != from) others.push_back(other);
  }
  return others;
}

namespace {

/// A model that differs from the current one in one family, by one additional term, or by back-EMF.
struct Neighbour {
  Families families;
  std::vector<FreeTerm> more = {};
  bool has_back_emf = false;
};

/// A delay of the commands, a lag of the motors, and low-pass filters of speed and yaw rate if
/// other channels are measured too. Leaves out those that the fit already estimates, and a lag that
/// the vehicle file gives.
std::vector<FreeTerm> late_terms(const FamilyFit& fit, const std::vector<LogChannel>& filtered) {
  constexpr double kBegin_s = 0.05;
  std::vector<FreeTerm> terms;
  const std::vector<FreeQuantity>& quantities = fit.fit.quantities;
  const auto add = [&](const FreeQuantity& late) {
    if (!has(quantities, late.name())) terms.push_back({late, kBegin_s});
  };
  add(free_term(FreeQuantity::Kind::kDelay));
  if (!fit.options.vehicle.motor_time_constant_s) add(free_term(FreeQuantity::Kind::kMotorLag));
  for (const LogChannel channel : filtered) add(sensor_lag_of(channel));
  return terms;
}

/// Ramps of the forces, rising and falling, that the fit does not yet estimate.
std::vector<FreeTerm> ramp_terms(const FamilyFit& fit) {
  constexpr double kBegin_s = 0.3;
  std::vector<FreeTerm> terms;
  for (const FreeQuantity& ramp :
       {force_rise(false), force_rise(true), free_term(FreeQuantity::Kind::kForceFall)}) {
    if (!has(fit.fit.quantities, ramp.kind)) terms.push_back({ramp, kBegin_s});
  }
  return terms;
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

/// Returns the models to try next. Each changes the family of an open axis, or adds one of
/// late_terms() or ramp_terms(), or adds back-EMF if it is a candidate term. `is_done`: axis that
/// was changed last and therefore stays (true: yaw, false: surge). `filtered`: channels that a
/// sensor filter may have delayed.
std::vector<Neighbour> neighbours_of(const FamilyFit& fit, const OpenAxes& open,
                                     std::optional<bool> is_done,
                                     const std::vector<LogChannel>& filtered) {
  const Families families{fit.surge, fit.yaw};
  std::vector<Neighbour> neighbours;
  for (const bool of_yaw : {false, true}) {
    if (!open.has(of_yaw) || is_done == of_yaw) continue;
    for (const Families& other : other_families(families, of_yaw)) neighbours.push_back({other});
  }
  for (const FreeTerm& term : late_terms(fit, filtered)) neighbours.push_back({families, {term}});
  for (const FreeTerm& term : ramp_terms(fit)) neighbours.push_back({families, {term}});
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
  const std::vector<LogChannel> filtered = filtered_channels(logs);
  std::optional<bool> changed_yaw;  // axis that was changed last (true: yaw)
  for (int changes = 0; changes < kMostChanges && !is_over(power_law); ++changes) {
    const std::vector<Neighbour> neighbours = neighbours_of(best, open, changed_yaw, filtered);
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
    changed_yaw.reset();
    if (least->yaw != best.yaw) changed_yaw = true;
    if (least->surge != best.surge) changed_yaw = false;
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
  const auto is_requested = [&](const FreeTerm& term) {
    return std::ranges::any_of(power_law.terms, [&](const FreeTerm& other) {
      return other.quantity.kind == term.quantity.kind;
    });
  };
  std::erase_if(options.terms, [&](const FreeTerm& term) {
    return !term.quantity.is_ramp() || is_requested(term);
  });
  append(options.terms, power_law.terms);
  return fit_with(logs, std::move(options), rough.surge, rough.yaw);
}

}  // namespace awmr
