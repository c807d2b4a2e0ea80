#include "awmr/tune/unsettled_cause.h"

#include <algorithm>
#include <string>

#include "awmr/core/units.h"
#include "awmr/model/model.h"
#include "awmr/model/parameters.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {

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

namespace {

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

}  // namespace

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

}  // namespace awmr
