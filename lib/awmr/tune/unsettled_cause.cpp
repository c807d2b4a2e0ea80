#include "awmr/tune/unsettled_cause.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/model.h"
#include "awmr/model/parameters.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/turning.h"

namespace awmr {
namespace {

/// Returns the effect of Coulomb friction in yaw if it keeps runs of this mode from settling: at
/// least kSettledShare of them settle if neither the vehicles nor the control law have this
/// friction. Precondition: fewer than kSettledShare of the runs settle.
std::optional<FrictionEffect> friction_effect(ObjectiveSetting setting, const Gains<double>& gains,
                                              YawMode mode) {
  const Plant<double> nominal = setting.vehicles.front().plant;
  if (!(nominal.yaw.coulomb > 0.0)) return std::nullopt;
  for (DrawnVehicle& vehicle : setting.vehicles) vehicle.plant.yaw.coulomb = 0.0;
  const double without = settled_share(setting, gains);
  if (without < kSettledShare) return std::nullopt;
  return FrictionEffect{without, degrees(friction_error_rad(gains, nominal, mode)),
                        gains.observer.bandwidth_radps};
}

/// A quantity that is drawn with the model's error. `identify` copies it from the identified plant.
struct DrawnQuantity {
  const char* name;
  ParameterId parameter;  ///< with the trial that identifies it
  void (*identify)(Plant<double>& drawn, const Plant<double>& identified);
};
template <auto member>
void copy_identified(Plant<double>& drawn, const Plant<double>& identified) {
  drawn.*member = identified.*member;
}
constexpr DrawnQuantity kDrawnQuantities[] = {
    {"the yaw resistance g3", ParameterId::kYawAlpha, copy_identified<&Plant<double>::yaw>},
    {"the surge resistance g1", ParameterId::kSurgeAlpha, copy_identified<&Plant<double>::surge>},
    {"the mass m'", ParameterId::kMassNorm, copy_identified<&Plant<double>::mass_norm>},
    {"the yaw inertia I'z", ParameterId::kInertiaNorm,
     copy_identified<&Plant<double>::inertia_norm>},
    {"the sway resistance a_s", ParameterId::kSwayAlpha,
     copy_identified<&Plant<double>::sway_alpha>},
    {"the steering time constant T", ParameterId::kSteeringTimeConstant,
     copy_identified<&Plant<double>::steering_time_constant_s>},
    {"the motors' dead zone F'0", ParameterId::kWheelDeadZone,
     copy_identified<&Plant<double>::wheel_dead_zone>},
    {"the back-EMF k_e", ParameterId::kBackEmf, copy_identified<&Plant<double>::back_emf_s_per_m>},
    {"the scrub moment", ParameterId::kYawCoulomb, copy_identified<&Plant<double>::yaw_scrub_m>}};

/// Returns the setting in which one quantity has its identified value in all vehicles.
ObjectiveSetting with_identified(ObjectiveSetting setting, const DrawnQuantity& quantity) {
  const Plant<double> nominal = setting.vehicles.front().plant;
  for (DrawnVehicle& vehicle : setting.vehicles) quantity.identify(vehicle.plant, nominal);
  return setting;
}

/// Returns the setting in which all vehicles are the identified one.
ObjectiveSetting all_identified(ObjectiveSetting setting) {
  const DrawnVehicle nominal = setting.vehicles.front();
  std::ranges::fill(setting.vehicles, nominal);
  return setting;
}

/// Gains with which runs settle only in a longer time can be slow because of the limits of the
/// damping. If relaxing such a limit lets the runs settle, reports the changes with which they
/// settle as the cause, in place of the noise.
void replace_by_damping(const ObjectiveSetting& setting, const Gains<double>& gains,
                        SettlingSearch& search, UnsettledRuns& unsettled) {
  if (!(unsettled.noise->time_factor > 1.0)) return;
  std::vector<SettlingChange> changes = search.changes(setting, gains, kSettledShare);
  const auto is_of_damping = [](const SettlingChange& change) {
    return change.pointer.ends_with("damping");
  };
  if (std::ranges::none_of(changes, is_of_damping)) return;
  unsettled.noise.reset();
  unsettled.changes = std::move(changes);
}

/// True if no run of the first drawn vehicles settles without noise in kMostTime times the
/// duration. Without drawn vehicles: no run of the nominal vehicle.
bool never_settles(ObjectiveSetting setting, const Gains<double>& gains) {
  if (setting.vehicles.size() > 1) setting.vehicles.erase(setting.vehicles.begin());
  setting = with_times_scaled(on_few_vehicles(std::move(setting)), kMostTime);
  return settled_share_without_noise(std::move(setting), gains) == 0.0;
}

/// Returns why runs do not settle in one scenario and mode, and the changes with which they settle.
/// To save time, it tries causes and changes of the gains only on the nominal vehicle and the first
/// drawn vehicles.
UnsettledRuns unsettled_in(const ObjectiveSetting& setting, const ConstraintContext& context,
                           const Gains<double>& gains, const UnmodelledVariation& open,
                           SettlingSearch& search) {
  const YawMode mode = *setting.mode;
  UnsettledRuns unsettled{.scenario = {}, .mode = mode};
  const Status turns =
      check_turning(context.own(), std::span(&mode, 1), setting.scenarios, std::string());
  if (!turns) {
    unsettled.why = turns.error().faults.front().message;
    return unsettled;
  }
  const ObjectiveSetting few = on_few_vehicles(setting);
  unsettled.vehicles = few.vehicles.size();
  unsettled.variation = variation_effect(few, gains, open);
  if (!unsettled.variation) {
    unsettled.friction = friction_effect(few, gains, mode);
    unsettled.noise = noise_effect(few, gains);
  }
  if (unsettled.noise) {
    replace_by_damping(few, gains, search, unsettled);
    return unsettled;
  }
  if (few.vehicles.size() > 1 && !open.any()) {
    unsettled.error = unsettling_error(few, gains);
    if (!unsettled.error) unsettled.noise = noise_effect_on_identified(few, gains);
    if (unsettled.noise) return unsettled;
  }
  unsettled.changes = scenario_changes(setting, gains, kSettledShare);
  if (!unsettled.error || unsettled.error->share_of_identified < kSettledShare) {
    std::ranges::move(search.changes(few, gains, kSettledShare),
                      std::back_inserter(unsettled.changes));
  }
  return unsettled;
}

}  // namespace

std::optional<NoiseEffect> noise_effect(const ObjectiveSetting& setting,
                                        const Gains<double>& gains) {
  const double without = settled_share_without_noise(setting, gains);
  if (without >= kSettledShare) return NoiseEffect{without, 1.0};
  const ObjectiveSetting longer = with_times_scaled(setting, kMostTime);
  const double without_in_longer = settled_share_without_noise(longer, gains);
  if (without_in_longer < kSettledShare || enough_settle(longer, gains, kSettledShare)) {
    return std::nullopt;
  }
  return NoiseEffect{without_in_longer, kMostTime};
}

std::optional<NoiseEffect> noise_effect_on_identified(const ObjectiveSetting& setting,
                                                      const Gains<double>& gains) {
  const ObjectiveSetting identified = all_identified(setting);
  if (settled_share(identified, gains) >= kSettledShare) return std::nullopt;
  std::optional<NoiseEffect> effect = noise_effect(identified, gains);
  if (effect) effect->is_of_identified = true;
  return effect;
}

std::optional<UnsettlingError> unsettling_error(const ObjectiveSetting& setting,
                                                const Gains<double>& gains) {
  const double drawn = settled_share(setting, gains);
  const double identified = settled_share(all_identified(setting), gains);
  if (identified <= drawn + 0.5 * (1.0 - drawn)) return std::nullopt;
  std::optional<UnsettlingError> largest;
  for (const DrawnQuantity& quantity : kDrawnQuantities) {
    const double share = settled_share(with_identified(setting, quantity), gains);
    if (largest && share <= largest->settled_share) continue;
    largest = {quantity.name, std::string(trial_of(setting.vehicle, quantity.parameter)), share,
               identified};
  }
  return largest;
}

std::optional<VariationEffect> variation_effect(const ObjectiveSetting& setting,
                                                const Gains<double>& gains,
                                                const UnmodelledVariation& open) {
  const std::pair<const char*, UnmodelledVariation> parts[] = {
      {"open/wheel_forces", {.mass_factors = {}, .wheel_forces = open.wheel_forces}},
      {"open/mass_factors", {.mass_factors = open.mass_factors, .wheel_forces = {}}},
      {"open", open}};
  const bool has_both = !open.mass_factors.empty() && !open.wheel_forces.empty();
  for (const auto& [key, part] : parts) {
    if (!part.any() || (&part == &parts[2].second && !has_both)) continue;  // already tried
    ObjectiveSetting other = setting;
    other.vehicles = without(part, setting.vehicles);
    const double share = settled_share(other, gains);
    if (share >= kSettledShare) return VariationEffect{key, share};
  }
  return std::nullopt;
}

std::vector<UnsettledRuns> unsettled_runs(const Tuning& tuning, const ObjectiveSetting& setting,
                                          const ConstraintContext& context,
                                          const TuneOptions& requested) {
  std::vector<UnsettledRuns> all;
  SettlingSearch search(context, requested.bounds);
  const auto look_at = [&](const std::string& scenario, YawMode mode, double settled_share) {
    if (settled_share >= kSettledShare) return;
    all.push_back(unsettled_in(runs_in(setting, scenario, mode), context, tuning.gains,
                               requested.open, search));
    all.back().scenario = scenario;
    all.back().settled_share = settled_share;
    all.back().is_never =
        settled_share == 0.0 && never_settles(runs_in(setting, scenario, mode), tuning.gains);
  };
  if (tuning.robust && !tuning.robust->evaluated.empty()) {
    const RobustTuning& robust = *tuning.robust;
    for (const EvaluatedGains& one :
         robust.evaluated_by_scenario.empty() ? robust.evaluated : robust.evaluated_by_scenario) {
      if (one.gains == kRobustGains) look_at(one.scenario, one.mode, one.completed_share);
    }
  } else {
    for (const ModeScore& score : tuning.scores) {
      look_at(score.scenario, score.mode, score.metrics.completed ? 1.0 : 0.0);
    }
  }
  return all;
}

}  // namespace awmr
