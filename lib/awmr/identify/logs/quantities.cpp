#include "awmr/identify/logs/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string_view>

#include "awmr/core/index.h"
#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/model/log_term_names.h"
#include "awmr/model/plausibility.h"

namespace awmr {
namespace {

Interval parameter_bounds(const FreeQuantity& quantity, double initial, const Vehicle& vehicle) {
  if (quantity.id == ParameterId::kSurgeBeta) {
    return {vehicle.surge_beta_range.lo, vehicle.surge_beta_range.hi};
  }
  if (quantity.id == ParameterId::kYawBeta) {
    return {vehicle.yaw_beta_range.lo, vehicle.yaw_beta_range.hi};
  }
  if (quantity.scale == Scale::kLinear) return {0.0, 1e6};
  // The servo's time constant T is limited to kSlowestServo_s. Reason: servo and yaw motion are two
  // lags in series. If there were no limit, a search could exchange T with I'z/g3', the time
  // constant of the yaw motion (I'z: yaw inertia, g3': slope of the yaw resistance).
  const double most = quantity.is(ParameterId::kSteeringTimeConstant)
                          ? to_coordinate(quantity.scale, kSlowestServo_s)
                          : initial + 10.0;
  return {initial - 10.0, std::max(initial, most)};
}

Interval extra_force_range(const FreeQuantity& quantity) {
  constexpr double kSteepest_mps2 = 5.0;
  constexpr double kLargestExponent = 3.0;
  constexpr Interval kExcess{-0.9, 5.0};
  constexpr Interval kPull_m{-1.0, 1.0};
  if (quantity.is_stribeck_speed()) return {0.01 * quantity.fastest, 0.5 * quantity.fastest};
  if (quantity.is_turn_drag_exponent()) return {0.0, kLargestExponent};
  if (quantity.is_force_excess() || quantity.is(ExtraForce::kBackwardDrag)) return kExcess;
  if (quantity.is(ExtraForce::kSidePull)) return kPull_m;
  return quantity.may_be_zero() ? Interval{0.0, 1e6} : Interval{-kSteepest_mps2, kSteepest_mps2};
}

Interval range_of(const FreeQuantity& quantity) {
  using Kind = FreeQuantity::Kind;
  constexpr double kLongest_s = 1.0;
  constexpr double kWidest_s2 = 0.1;
  constexpr double kLargestTrim_rad = 0.35;
  constexpr double kSlowestRate_radps = 0.01;
  constexpr double kFastestRate_radps = 100.0;
  constexpr double kLargestImbalance = 0.5;
  // If the curve k were below -1/3, a larger command would steer to a smaller angle.
  constexpr Interval kCurve{-0.33, 2.0};
  constexpr double kLargestSlip = 10.0;
  constexpr double kLargestOffset_m = 5.0;
  constexpr double kLargestAngle_rad = 1.0;
  switch (quantity.kind) {
    case Kind::kDelay:
    case Kind::kSteeringDelay:
      return {-kLongest_s, kLongest_s};
    case Kind::kSteeringTrim:
      return {-kLargestTrim_rad, kLargestTrim_rad};
    case Kind::kSteeringDeadBand:
      return {0.0, kLargestTrim_rad};
    case Kind::kSteeringCurve:
      return kCurve;
    case Kind::kServoRate:
      return {kSlowestRate_radps, kFastestRate_radps};
    case Kind::kSteeringAsymmetry:
    case Kind::kSteeringScale:
    case Kind::kForceImbalance:
    case Kind::kSensorScale:
      return {-kLargestImbalance, kLargestImbalance};
    case Kind::kForceExponent:
      return {0.2, 1.0};
    case Kind::kForceSaturation:
      return {0.0, 0.95};
    case Kind::kSaturationSharpness:
      return {1.0, 20.0};
    case Kind::kExtraForce:
      return extra_force_range(quantity);
    case Kind::kParameter:
    case Kind::kBias:
      return {-1e6, 1e6};
    case Kind::kMotorLag:
    case Kind::kSensorDelay:
    case Kind::kSensorLag:
      return {0.0, kLongest_s};
    case Kind::kSmoothing:
      return {0.0, kWidest_s2};
    case Kind::kWheelSlip:
      return {0.0, kLargestSlip};
    case Kind::kSwayOffset:
    case Kind::kSpeedOffset:
      return {-kLargestOffset_m, kLargestOffset_m};
    case Kind::kSwayAngle:
      return {-kLargestAngle_rad, kLargestAngle_rad};
  }
  return {};
}

/// Name of a kind of quantities. `is_of_channel`: there is one for each channel, and the name of
/// the channel follows.
struct NamedKind {
  FreeQuantity::Kind kind;
  std::string_view name;
  bool is_of_channel = false;
};

/// All kinds except kParameter and kExtraForce. kWheelSlip: see also FreeQuantity::is_ratio.
constexpr NamedKind kNamedKinds[] = {
    {FreeQuantity::Kind::kDelay, kInputDelayName},
    {FreeQuantity::Kind::kSteeringDelay, kSteeringDelayName},
    {FreeQuantity::Kind::kMotorLag, kMotorLagName},
    {FreeQuantity::Kind::kSteeringTrim, kSteeringTrimName},
    {FreeQuantity::Kind::kSteeringDeadBand, kSteeringDeadBandName},
    {FreeQuantity::Kind::kSteeringAsymmetry, kSteeringAsymmetryName},
    {FreeQuantity::Kind::kSteeringCurve, kSteeringCurveName},
    {FreeQuantity::Kind::kSteeringScale, kSteeringScaleName},
    {FreeQuantity::Kind::kServoRate, kServoRateName},
    {FreeQuantity::Kind::kForceImbalance, kForceImbalanceName},
    {FreeQuantity::Kind::kForceExponent, kForceExponentName},
    {FreeQuantity::Kind::kForceSaturation, kForceSaturationName},
    {FreeQuantity::Kind::kSaturationSharpness, kSaturationSharpnessName},
    {FreeQuantity::Kind::kSensorDelay, kSensorDelayPrefix, true},
    {FreeQuantity::Kind::kSensorLag, kSensorLagPrefix, true},
    {FreeQuantity::Kind::kSmoothing, kSmoothingPrefix, true},
    {FreeQuantity::Kind::kSensorScale, kSensorScalePrefix, true},
    {FreeQuantity::Kind::kWheelSlip, kSlipPrefix, true},
    {FreeQuantity::Kind::kSwayOffset, kSwayOffsetName},
    {FreeQuantity::Kind::kSwayAngle, kSwayAngleName},
    {FreeQuantity::Kind::kSpeedOffset, kSpeedOffsetName},
    {FreeQuantity::Kind::kBias, kBiasPrefix, true},
};
static_assert(std::size(kNamedKinds) + 2 == at(FreeQuantity::Kind::kSpeedOffset) + 1);

Interval bounds_of(const FreeQuantity& quantity, double initial, const Vehicle& vehicle) {
  if (quantity.kind == FreeQuantity::Kind::kParameter) {
    return parameter_bounds(quantity, initial, vehicle);
  }
  const Interval range = range_of(quantity);
  return {to_coordinate(quantity.scale, range.lo), to_coordinate(quantity.scale, range.hi)};
}

}  // namespace

std::string FreeQuantity::name() const {
  if (kind == Kind::kParameter) return std::string(info(id).name);
  if (kind == Kind::kExtraForce) return std::string(kExtraForceNames[at(force)]);
  const auto named = std::ranges::find(kNamedKinds, kind, &NamedKind::kind);
  assert(named != std::end(kNamedKinds));
  const bool is_slip_ratio = kind == Kind::kWheelSlip && is_ratio;
  return fmt::format("{}{}", is_slip_ratio ? kSlipRatioPrefix : named->name,
                     named->is_of_channel ? info(channel).name : std::string_view());
}

double FreeQuantity::value(double coordinate) const { return from_coordinate(scale, coordinate); }

double FreeQuantity::jacobian(double coordinate) const {
  return awmr::jacobian(scale, value(coordinate));
}

FreeQuantity free_parameter(ParameterId id) {
  // A term that only some resistance families have is a force or moment over F_max. A fifth of
  // F_max counts as a large change.
  return {.id = id, .scale = scale_of(id), .large_change = info(id).term ? 0.2 : 1.0};
}

FreeQuantity input_delay() { return {.kind = FreeQuantity::Kind::kDelay, .large_change = 0.1}; }

FreeQuantity steering_delay() {
  return {.kind = FreeQuantity::Kind::kSteeringDelay, .large_change = 0.1};
}

FreeQuantity motor_lag() { return {.kind = FreeQuantity::Kind::kMotorLag, .large_change = 0.1}; }

FreeQuantity steering_trim() {
  return {.kind = FreeQuantity::Kind::kSteeringTrim, .large_change = 0.1};
}

FreeQuantity steering_dead_band() {
  return {.kind = FreeQuantity::Kind::kSteeringDeadBand, .large_change = 0.1};
}

FreeQuantity steering_asymmetry() {
  return {.kind = FreeQuantity::Kind::kSteeringAsymmetry, .large_change = 0.1};
}

FreeQuantity steering_curve() {
  return {.kind = FreeQuantity::Kind::kSteeringCurve, .large_change = 0.1};
}

FreeQuantity steering_scale() {
  return {.kind = FreeQuantity::Kind::kSteeringScale, .large_change = 0.1};
}

FreeQuantity servo_rate(double begin_radps) {
  return {.kind = FreeQuantity::Kind::kServoRate, .large_change = begin_radps};
}

FreeQuantity force_imbalance() {
  return {.kind = FreeQuantity::Kind::kForceImbalance, .large_change = 0.1};
}

FreeQuantity force_exponent() {
  return {.kind = FreeQuantity::Kind::kForceExponent,
          .scale = Scale::kLogarithmic,
          .large_change = 0.1};
}

FreeQuantity force_saturation(double full_command) {
  return {.kind = FreeQuantity::Kind::kForceSaturation,
          .large_change = 0.1,
          .full_command = full_command};
}

FreeQuantity saturation_sharpness() {
  return {.kind = FreeQuantity::Kind::kSaturationSharpness, .scale = Scale::kLogarithmic};
}

FreeQuantity extra_force(ExtraForce force) {
  FreeQuantity quantity{.kind = FreeQuantity::Kind::kExtraForce, .force = force};
  if (force == ExtraForce::kSlopeX || force == ExtraForce::kSlopeY) {
    quantity.large_change = 0.5;
  } else if (quantity.is_force_excess() || force == ExtraForce::kBackwardDrag) {
    quantity.large_change = 0.1;
  } else if (!quantity.is_form()) {
    quantity.large_change = 0.2;
  }
  return quantity;
}

bool is_late_commands(const FreeTerm& term) {
  return term.quantity.kind == FreeQuantity::Kind::kDelay && term.begin < 0.0;
}

FreeTerm stribeck_speed_term(ExtraForce force, double fastest) {
  const bool is_of_yaw = force == ExtraForce::kYawStribeck;
  const FreeQuantity speed{
      .kind = FreeQuantity::Kind::kExtraForce,
      .force = is_of_yaw ? ExtraForce::kYawStribeckSpeed : ExtraForce::kSurgeStribeckSpeed,
      .scale = Scale::kLogarithmic,
      .fastest = fastest};
  return {speed, to_coordinate(speed.scale, kStribeckShare * fastest)};
}

FreeQuantity sensor_delay_of(LogChannel channel) {
  return {.kind = FreeQuantity::Kind::kSensorDelay, .channel = channel, .large_change = 0.1};
}

FreeQuantity sensor_lag_of(LogChannel channel, bool is_at_rows) {
  return {.kind = FreeQuantity::Kind::kSensorLag,
          .channel = channel,
          .large_change = 0.1,
          .is_at_rows = is_at_rows};
}

FreeQuantity second_order_lag_of(LogChannel channel, double damping) {
  FreeQuantity quantity = sensor_lag_of(channel);
  quantity.damping = damping;
  return quantity;
}

FreeQuantity smoothing_of(LogChannel channel, bool is_mean) {
  return {.kind = FreeQuantity::Kind::kSmoothing,
          .channel = channel,
          .large_change = 0.01,
          .is_mean = is_mean};
}

FreeQuantity sensor_scale_of(LogChannel channel) {
  return {.kind = FreeQuantity::Kind::kSensorScale, .channel = channel, .large_change = 0.1};
}

FreeQuantity wheel_slip_of(LogChannel channel, bool is_ratio) {
  return {.kind = FreeQuantity::Kind::kWheelSlip,
          .channel = channel,
          .large_change = 0.1,
          .is_ratio = is_ratio};
}

FreeQuantity sway_offset() {
  return {.kind = FreeQuantity::Kind::kSwayOffset, .large_change = 0.1};
}

FreeQuantity sway_angle() { return {.kind = FreeQuantity::Kind::kSwayAngle, .large_change = 0.1}; }

FreeQuantity speed_offset() {
  return {.kind = FreeQuantity::Kind::kSpeedOffset, .large_change = 0.1};
}

bool has_kind(const std::vector<FreeQuantity>& quantities, FreeQuantity::Kind kind) {
  return std::ranges::any_of(quantities, [&](const FreeQuantity& q) { return q.kind == kind; });
}

bool has_kind(const std::vector<FreeQuantity>& quantities, FreeQuantity::Kind kind,
              LogChannel channel) {
  return std::ranges::any_of(
      quantities, [&](const FreeQuantity& q) { return q.kind == kind && q.channel == channel; });
}

bool has_force(const std::vector<FreeQuantity>& quantities, ExtraForce force) {
  return std::ranges::any_of(quantities, [&](const FreeQuantity& q) { return q.is(force); });
}

bool has_force_excess(const std::vector<FreeQuantity>& quantities) {
  return std::ranges::any_of(quantities, &FreeQuantity::is_force_excess);
}

std::optional<std::size_t> place_of(const std::vector<FreeQuantity>& quantities, ParameterId id) {
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [id](const FreeQuantity& q) { return q.is(id); });
  if (found == quantities.end()) return std::nullopt;
  return at(found - quantities.begin());
}

namespace {

std::vector<FreeTerm> all_free(const LogFitOptions& options) {
  std::vector<FreeTerm> free = options.terms;
  for (const ParameterId id : options.free) {
    free.push_back({free_parameter(id), to_coordinate(id, options.initial_guess[at(id)])});
  }
  for (const LogChannel channel : options.biases) {
    free.push_back({{.kind = FreeQuantity::Kind::kBias, .channel = channel}, 0.0});
  }
  std::ranges::stable_sort(free, {}, [](const FreeTerm& term) { return term.quantity.kind; });
  return free;
}

}  // namespace

std::vector<FreeQuantity> free_quantities(const LogFitOptions& options) {
  std::vector<FreeQuantity> quantities;
  for (const FreeTerm& term : all_free(options)) quantities.push_back(term.quantity);
  return quantities;
}

std::vector<double> initial_coordinates(const LogFitOptions& options) {
  std::vector<double> coordinates;
  for (const FreeTerm& term : all_free(options)) coordinates.push_back(term.begin);
  return coordinates;
}

std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial,
                                        const Vehicle& vehicle) {
  std::vector<Interval> bounds;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    bounds.push_back(bounds_of(quantities[i], initial[i], vehicle));
  }
  return bounds;
}

ParameterValues<double> parameters_at(ParameterValues<double> held,
                                      const std::vector<FreeQuantity>& quantities,
                                      const std::vector<double>& coordinates) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const FreeQuantity& q = quantities[i];
    if (q.kind == FreeQuantity::Kind::kParameter) held[at(q.id)] = q.value(coordinates[i]);
  }
  return held;
}

std::vector<double> values_at(const std::vector<FreeQuantity>& quantities,
                              const std::vector<double>& coordinates) {
  std::vector<double> values;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values.push_back(quantities[i].value(coordinates[i]));
  }
  return values;
}

}  // namespace awmr
