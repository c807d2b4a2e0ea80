#include "awmr/identify/logs/requested_terms.h"

#include <algorithm>

#include "awmr/identify/logs/further_terms.h"
#include "awmr/identify/options.h"
#include "awmr/model/log_term_names.h"

namespace awmr {
namespace {

/// Initial guess of a term. A term that cannot be negative begins above 0, so that the search can
/// move in both directions.
double begin_of(const FreeQuantity& quantity) {
  constexpr double kShare = 0.2;
  return quantity.may_be_zero() ? kShare * quantity.large_change : 0.0;
}

/// Every term that a user can request by name. The other terms cannot be free from the start of a
/// fit: they need a value from the logs (the largest command or speed, or the rate of the servo),
/// or another term in the fit.
std::vector<FreeQuantity> all_terms() {
  std::vector<FreeQuantity> terms{input_delay(),     steering_delay(),     motor_lag(),
                                  steering_trim(),   steering_dead_band(), steering_asymmetry(),
                                  force_imbalance(), force_exponent(),     sway_offset(),
                                  sway_angle()};
  for (const ExtraForce force : {ExtraForce::kSlopeX, ExtraForce::kSlopeY, ExtraForce::kBrakeForce,
                                 ExtraForce::kReverseForce, ExtraForce::kBackwardDrag}) {
    terms.push_back(extra_force(force));
  }
  for (const LogChannel channel : kChannels) {
    // x and y have one delay together.
    if (channel != LogChannel::kY) terms.push_back(sensor_delay_of(channel));
    if (!is_often_filtered(channel)) continue;
    terms.push_back(sensor_lag_of(channel));
    terms.push_back(smoothing_of(channel));
    if (channel == LogChannel::kHeading) continue;
    terms.push_back(sensor_scale_of(channel));
    for (const bool is_ratio : {false, true}) terms.push_back(wheel_slip_of(channel, is_ratio));
  }
  return terms;
}

}  // namespace

std::vector<std::string> requestable_terms() {
  std::vector<std::string> names;
  for (const FreeQuantity& term : all_terms()) names.push_back(term.name());
  return names;
}

std::vector<std::string> automatic_terms() {
  std::vector<std::string> names{std::string(kServoRateName), std::string(kForceSaturationName),
                                 std::string(kSaturationSharpnessName)};
  const std::vector<std::string> requestable = requestable_terms();
  for (const std::string_view name : kExtraForceNames) {
    if (std::ranges::find(requestable, name) == requestable.end()) names.emplace_back(name);
  }
  return names;
}

std::vector<FreeTerm> requested_terms(std::span<const std::string> names) {
  std::vector<FreeTerm> terms;
  for (const FreeQuantity& term : all_terms()) {
    if (std::ranges::find(names, term.name()) != names.end()) {
      terms.push_back({term, begin_of(term)});
    }
  }
  return terms;
}

}  // namespace awmr
