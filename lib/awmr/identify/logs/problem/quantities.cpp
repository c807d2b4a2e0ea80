#include "awmr/identify/logs/problem/quantities.h"

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
  constexpr Interval kOffset_m{-5.0, 5.0};
  if (quantity.is_stribeck_speed()) return {0.01 * quantity.fastest, 0.5 * quantity.fastest};
  if (quantity.is_turn_drag_exponent()) return {0.0, kLargestExponent};
  if (quantity.is_force_excess() || quantity.is(ExtraForce::kBackwardDrag)) return kExcess;
  if (quantity.is(ExtraForce::kSidePull)) return kPull_m;
  if (quantity.is(ExtraForce::kAxleOffset)) return kOffset_m;
  return quantity.may_be_zero() ? Interval{0.0, 1e6} : Interval{-kSteepest_mps2, kSteepest_mps2};
}

/// Properties of all quantities of one kind.
struct KindInfo {
  std::string_view name;  ///< if it ends with a dot, the name of the channel follows
  Interval range;         ///< of the value
  double large_change = 0.1;
  Scale scale = Scale::kLinear;
};

/// By FreeQuantity::Kind. kParameter: see parameter_bounds(). kExtraForce: see extra_force_range().
constexpr KindInfo kKinds[] = {
    {"", {}},
    {kInputDelayName, {-1.0, 1.0}},
    {kSteeringDelayName, {-1.0, 1.0}},
    {kMotorLagName, {0.0, 1.0}},
    {kForceRiseName, {0.0, 10.0}, 0.3},
    {kForceFallName, {0.0, 10.0}, 0.3},
    {kSteeringTrimName, {-0.35, 0.35}},
    {kSteeringDeadBandName, {0.0, 0.35}},
    {kSteeringAsymmetryName, {-0.5, 0.5}},
    {kSteeringCurveName, {-0.33, 2.0}},  // below -1/3, a larger command steers to a smaller angle
    {kSteeringScaleName, {-0.5, 0.5}},
    {kServoRateName, {0.01, 100.0}},
    {kForceImbalanceName, {-0.5, 0.5}},
    {kDeadZoneDifferenceName, {-0.2, 0.2}},
    {kForceExponentName, {0.2, 3.0}, 0.1, Scale::kLogarithmic},
    {kForceSaturationName, {0.0, 0.95}},
    {kSaturationSharpnessName, {1.0, 20.0}, 1.0, Scale::kLogarithmic},
    {kSupplySagName, {0.0, 0.5}},
    {kRunOnName, {0.0, 1.0}},
    {kForceScaleName, {-0.9, 5.0}},
    {kResistanceScalePrefix, {-0.9, 20.0}},
    {"", {}},
    {kBiasPrefix, {-1e6, 1e6}, 1.0},
    {kSensorDelayPrefix, {0.0, 1.0}},
    {kAveragingPrefix, {0.0, 0.2}},
    {kSensorLagPrefix, {0.0, 1.0}},
    {kLagDampingPrefix, {0.2, 2.0}, 0.5},
    {kSmoothingPrefix, {0.0, 0.1}, 0.01},
    {kSensorScalePrefix, {-0.5, 0.5}},
    {kSlipPrefix, {0.0, 10.0}},  // kSlipRatioPrefix for a slip ratio
    {kSwayOffsetName, {-5.0, 5.0}},
    {kSwayAngleName, {-1.0, 1.0}},
    {kSpeedOffsetName, {-5.0, 5.0}},
    {kPositionAheadName, {-5.0, 5.0}},
    {kPositionLeftName, {-5.0, 5.0}},
    {kCompassSinName, {-0.5, 0.5}},
    {kCompassCosName, {-0.5, 0.5}},
    {kCompassSin2Name, {-0.5, 0.5}},
    {kCompassCos2Name, {-0.5, 0.5}}};
static_assert(std::size(kKinds) == at(FreeQuantity::Kind::kCompassCos2) + 1);

Interval bounds_of(const FreeQuantity& quantity, double initial, const Vehicle& vehicle) {
  if (quantity.kind == FreeQuantity::Kind::kParameter) {
    return parameter_bounds(quantity, initial, vehicle);
  }
  const Interval range = quantity.kind == FreeQuantity::Kind::kExtraForce
                             ? extra_force_range(quantity)
                             : kKinds[at(quantity.kind)].range;
  return {to_coordinate(quantity.scale, range.lo), to_coordinate(quantity.scale, range.hi)};
}

}  // namespace

std::string FreeQuantity::name() const {
  if (kind == Kind::kParameter) return std::string(info(id).name);
  if (kind == Kind::kExtraForce) return std::string(kExtraForceNames[at(force)]);
  const bool is_slip_ratio = kind == Kind::kWheelSlip && is_ratio;
  const std::string_view of_kind = is_slip_ratio ? kSlipRatioPrefix : kKinds[at(kind)].name;
  const std::string_view of_channel = of_kind.ends_with('.') ? info(channel).name : "";
  return fmt::format("{}{}{}", of_kind, of_channel, log ? fmt::format("{}{}", kOfLog, log) : "");
}

bool FreeQuantity::may_be_zero() const {
  if (kind == Kind::kExtraForce) {
    return force == ExtraForce::kSurgeStribeck || force == ExtraForce::kYawStribeck ||
           force == ExtraForce::kTurnDrag;
  }
  return kind != Kind::kParameter && kKinds[at(kind)].range.lo == 0.0;
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

std::array<ParameterId, 3> resistance_of(LogChannel axis) {
  using enum ParameterId;
  return axis == LogChannel::kSpeed ? std::array{kSurgeAlpha, kSurgeCoulomb, kSurgeQuadratic}
                                    : std::array{kYawAlpha, kYawCoulomb, kYawQuadratic};
}

FreeQuantity free_term(FreeQuantity::Kind kind, LogChannel channel) {
  const KindInfo& of_kind = kKinds[at(kind)];
  return {.kind = kind,
          .channel = channel,
          .scale = of_kind.scale,
          .large_change = of_kind.large_change};
}

FreeQuantity servo_rate(double begin_radps) {
  FreeQuantity quantity = free_term(FreeQuantity::Kind::kServoRate);
  quantity.large_change = begin_radps;
  return quantity;
}

namespace {

FreeQuantity at_full_command(FreeQuantity quantity, double full_command) {
  quantity.full_command = full_command;
  return quantity;
}

}  // namespace

FreeQuantity force_saturation(double full_command) {
  return at_full_command(free_term(FreeQuantity::Kind::kForceSaturation), full_command);
}

FreeQuantity supply_sag(double full_command) {
  return at_full_command(free_term(FreeQuantity::Kind::kSupplySag), full_command);
}

FreeQuantity extra_force(ExtraForce force) {
  FreeQuantity quantity{.kind = FreeQuantity::Kind::kExtraForce, .force = force};
  if (force == ExtraForce::kSlopeX || force == ExtraForce::kSlopeY) {
    quantity.large_change = 0.5;
  } else if (quantity.is_force_excess() || force == ExtraForce::kBackwardDrag ||
             force == ExtraForce::kAxleOffset) {
    quantity.large_change = 0.1;
  } else if (!quantity.is_form()) {
    quantity.large_change = 0.2;
  }
  return quantity;
}

bool is_late_commands(const FreeTerm& term) {
  return term.quantity.kind == FreeQuantity::Kind::kDelay && term.begin < 0.0;
}

bool is_slip(const FreeTerm& term) { return term.quantity.kind == FreeQuantity::Kind::kWheelSlip; }

FreeTerm run_on_term() { return {free_term(FreeQuantity::Kind::kRunOn), 0.5}; }

FreeTerm stribeck_speed_term(ExtraForce force, double fastest) {
  const bool is_of_yaw = force == ExtraForce::kYawStribeck;
  const FreeQuantity speed{
      .kind = FreeQuantity::Kind::kExtraForce,
      .force = is_of_yaw ? ExtraForce::kYawStribeckSpeed : ExtraForce::kSurgeStribeckSpeed,
      .scale = Scale::kLogarithmic,
      .fastest = fastest};
  return {speed, to_coordinate(speed.scale, kStribeckShare * fastest)};
}

FreeQuantity sensor_lag_of(LogChannel channel, bool is_at_rows) {
  FreeQuantity quantity = free_term(FreeQuantity::Kind::kSensorLag, channel);
  quantity.is_at_rows = is_at_rows;
  return quantity;
}

std::vector<FreeTerm> second_order_lag_of(LogChannel channel, double delay_s, bool is_at_rows) {
  constexpr double kButterworth = 0.70710678;
  return {{sensor_lag_of(channel, is_at_rows), delay_s / (2.0 * kButterworth)},
          {free_term(FreeQuantity::Kind::kLagDamping, channel), kButterworth}};
}

FreeQuantity smoothing_of(LogChannel channel, bool is_mean) {
  FreeQuantity quantity = free_term(FreeQuantity::Kind::kSmoothing, channel);
  quantity.is_mean = is_mean;
  return quantity;
}

FreeQuantity force_rise(bool turns_slowly) {
  FreeQuantity quantity = free_term(FreeQuantity::Kind::kForceRise);
  quantity.turns_slowly = turns_slowly;
  return quantity;
}

FreeQuantity wheel_slip_of(LogChannel channel, bool is_ratio) {
  FreeQuantity quantity = free_term(FreeQuantity::Kind::kWheelSlip, channel);
  quantity.is_ratio = is_ratio;
  return quantity;
}

bool has_kind(const std::vector<FreeQuantity>& quantities, FreeQuantity::Kind kind,
              LogChannel channel) {
  return std::ranges::any_of(
      quantities, [&](const FreeQuantity& q) { return q.kind == kind && q.channel == channel; });
}

bool has_force_excess(const std::vector<FreeQuantity>& quantities) {
  return std::ranges::any_of(quantities, &FreeQuantity::is_force_excess);
}

namespace {

std::vector<FreeTerm> all_free(const LogFitOptions& options) {
  std::vector<FreeTerm> free = options.terms;
  for (const ParameterId id : options.free) {
    free.push_back({free_parameter(id), to_coordinate(id, options.initial_guess[at(id)])});
  }
  for (const LogChannel channel : options.biases) {
    free.push_back({free_term(FreeQuantity::Kind::kBias, channel), 0.0});
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

}  // namespace awmr
