// Default scenarios for tuning and scoring gains, scaled to the vehicle.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/units.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/meter.h"
#include "awmr/simulate/validity.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tuning_context.h"

namespace awmr {
namespace {

constexpr double kShareOfReachable = 0.3;
constexpr double kShareOfThrust = 1.0 / 3.0;
constexpr double kShareOfMeasured = 0.6;
constexpr double kFastestUnmeasured_mps = 10.0;
constexpr double kLargestStep_deg = 30.0;
constexpr double kSmallestStep_deg = 5.0;
constexpr double kShortestHold_s = 5.0;
constexpr double kLongestHold_s = 20.0;
/// Time for each heading, as a multiple of the time that the turn takes (turning_time_s()).
constexpr double kHoldOverTurn = 1.6;
/// Longest time for each heading, s, for loops that noise or latency makes slow.
constexpr double kLongestDecay_s = 60.0;
/// Settling time after the turn, as a multiple of T + latency, T the lag of servo or motors.
constexpr double kSettlingOverLag = 10.0;

/// Rounds to two significant digits, so that the scenario is easy to read.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / unit) * unit;
}

/// Highest measured speed, m/s, of the model's surge trials; absent if it has none.
std::optional<double> measured_speed_mps(const Model& model) {
  std::optional<double> fastest;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kSurge) continue;
    fastest = std::max(fastest.value_or(0.0), trial.measured);
  }
  return fastest;
}

/// u_d of the default scenarios, m/s (default_tuning_scenario()).
double speed_for(const Model& model, const Plant<double>& plant) {
  const double wheels = driven_wheels(plant);
  const double thrust = wheels * forces_beyond_dead_zone({plant, model.vehicle.wheel_force}).hi;
  const double viscous = wheels * plant.back_emf_s_per_m;
  const auto at_full = steady_rate(plant.surge, thrust, viscous);
  const auto at_part = steady_rate(plant.surge, kShareOfThrust * thrust, viscous);
  const auto measured = measured_speed_mps(model);
  double speed =
      std::max(kShareOfReachable * at_full.value_or(kFastestUnmeasured_mps), at_part.value_or(0.0));
  speed = std::min(speed, measured ? kShareOfMeasured * *measured : kFastestUnmeasured_mps);
  return rounded(std::max(speed, 1e-6));
}

/// Time, s, in which a disturbance observer with the bandwidth lambda/2 reduces the heading error
/// that Coulomb friction leaves in a mode to the settling band of a turn by `angle_rad`. At the
/// start of a turn in the other direction, the observer still compensates the friction of the last
/// turn, so the error is at most twice friction_error_rad(). 0 for steady errors within the band,
/// which need no observer, and for differential mode, whose gains need not limit the rate of the
/// steering.
double friction_time_s(const Gains<double>& gains, const ConstraintContext& context, YawMode mode,
                       double angle_rad) {
  if (!context.has_steering || mode == YawMode::kDifferential) return 0.0;
  const double error_rad = friction_error_rad(gains, context.plant, mode);
  const double band_rad =
      std::max(radians(meter::kSettledLeastDeg), meter::kSettledShare * angle_rad);
  if (error_rad <= band_rad) return 0.0;
  return 2.0 / gains.heading.lambda * std::log(std::min(2.0 * error_rad, angle_rad) / band_rad);
}

/// Time, s, in which the heading error decays to 2 % with gains by pole placement under the default
/// limits: 4/lambda + epsilon/mu, plus friction_time_s() of `mode` or, if it is absent, of steering
/// mode, in which friction leaves the largest error. 0 if the latency is too long for these limits.
double decay_time_s(const Model& model, const Plant<double>& plant, const Scenario& scenario,
                    std::optional<YawMode> mode) {
  ConstraintContext context = context_of({}, plant, model.vehicle, {scenario});
  add_conditions(conditions_of(model.vehicle), context);
  limit_steering_rate(context);
  if (context.latency_s > kMaxLatencySamples * context.sample_time_s) return 0.0;
  const Gains<double> gains = place_poles(context);
  const HeadingGains<double>& heading = gains.heading;
  return 4.0 / heading.lambda + heading.epsilon / heading.mu +
         friction_time_s(gains, context, mode.value_or(YawMode::kSteering), context.step_rad);
}

/// Returns the time, s, that the weaker mode takes to turn by an angle:
///   angle/r + sqrt(angle I'z/N) + 10 (T + latency)
/// The terms are the turn at the yaw rate r, the acceleration by N/I'z, and the settling of the
/// loop. N is the largest moment of the weaker mode. r is the yaw rate of a steady turn with N, at
/// most the highest measured yaw rate. T is the larger of the time constants of servo and motors.
double turning_time_s(const Model& model, const Plant<double>& plant, double speed_mps,
                      double angle_rad) {
  const double moment = turning_authority_m({plant, model.vehicle.wheel_force}, speed_mps);
  const LoopConditions conditions = conditions_of(model.vehicle);
  const double lag_s = std::max(model.vehicle.has_steering() ? plant.steering_time_constant_s : 0.0,
                                conditions.motor_time_constant_s) +
                       std::max(conditions.heading_latency_s, conditions.yaw_rate_latency_s);
  std::optional<double> rate = steady_rate(plant.yaw, moment);
  if (const auto measured_degps = measured_yaw_rate_degps(model)) {
    rate = std::min(rate.value_or(radians(*measured_degps)), radians(*measured_degps));
  }
  return (rate ? angle_rad / *rate : 0.0) +
         (moment > 0.0 ? std::sqrt(angle_rad * plant.inertia_norm / moment) : 0.0) +
         kSettlingOverLag * lag_s;
}

/// Manoeuvre of the default scenario: at speed_mps, the heading step_deg is commanded for hold_s,
/// then the opposite heading.
struct Manoeuvre {
  double speed_mps;
  double step_deg;
  double hold_s;
};

/// The manoeuvre without time for the decay of the error after the turn.
Manoeuvre turn_for(const Model& model, const Plant<double>& plant) {
  const double speed_mps = speed_for(model, plant);
  const auto hold_for = [&](double step_deg) {
    return kHoldOverTurn * turning_time_s(model, plant, speed_mps, radians(2.0 * step_deg));
  };
  double step_deg = kLargestStep_deg;
  while (hold_for(step_deg) > kLongestHold_s && step_deg > kSmallestStep_deg) {
    step_deg -= kSmallestStep_deg;
  }
  const double hold_s =
      std::clamp(std::round(hold_for(step_deg) / kShortestHold_s) * kShortestHold_s,
                 kShortestHold_s, kLongestHold_s);
  return {speed_mps, step_deg, hold_s};
}

Scenario scenario_of(const Manoeuvre& m) {
  return heading_steps({m.step_deg, -m.step_deg},
                       {.hold_s = m.hold_s,
                        .speed_mps = m.speed_mps,
                        .name = fmt::format("heading_{:g}_{:g}", m.step_deg, -m.step_deg)});
}

Result<Manoeuvre> manoeuvre_for(const Model& model, std::optional<YawMode> mode) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  Manoeuvre m = turn_for(model, plant);
  const double settled_s = turning_time_s(model, plant, m.speed_mps, radians(2.0 * m.step_deg)) +
                           decay_time_s(model, plant, scenario_of(m), mode);
  m.hold_s = std::max(m.hold_s, std::min(std::ceil(settled_s), kLongestDecay_s));
  return m;
}

/// The model with a heading rate limit as its highest yaw rate, if that is not lower already. The
/// time and the size of the heading steps then suit the limit.
Model turning_within(const HeadingRateChoice& choice, Model model) {
  const auto limit_degps = number_from_text(choice);
  const std::optional<double> measured_degps = measured_yaw_rate_degps(model);
  if (limit_degps && *limit_degps > 0.0 && (!measured_degps || *limit_degps < *measured_degps)) {
    model.vehicle.yaw_rate_max_degps = *limit_degps;
  }
  return model;
}

}  // namespace

Result<Scenario> examined_scenario(const Model& model) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  return scenario_of(turn_for(model, plant));
}

Result<Scenario> default_tuning_scenario(const Model& model, std::optional<YawMode> mode) {
  AWMR_ASSIGN_OR_RETURN(const Manoeuvre m, manoeuvre_for(model, mode));
  return scenario_of(m);
}

Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& choice) {
  AWMR_ASSIGN_OR_RETURN(Scenario stepped,
                        default_tuning_scenario(turning_within(choice, model), options.mode));
  std::vector<Scenario> scenarios{std::move(stepped)};
  const std::optional<double> measured_degps = measured_yaw_rate_degps(model);
  if (choice.empty() && measured_degps) {
    Scenario limited = scenarios.front();
    limited.name += kLedSuffix;
    limit_heading_rate(*measured_degps, model.vehicle.sample_time_s, limited);
    scenarios.push_back(std::move(limited));
  }
  if (!options.observer) return scenarios;
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  Scenario pushed = scenarios.back();
  pushed.name += "_pushed";
  const auto constantly = [](double value) {
    DisturbanceTerm term;
    term.value = value;
    return std::vector{term};
  };
  pushed.disturbance.yaw =
      constantly(kPush * turning_authority_m({plant, model.vehicle.wheel_force}, pushed.speed_mps));
  pushed.disturbance.surge = constantly(-kPush * plant.surge(pushed.speed_mps));
  scenarios.push_back(std::move(pushed));
  return scenarios;
}

Result<Scenario> held_out_scenario(const Model& model, std::optional<YawMode> mode) {
  AWMR_ASSIGN_OR_RETURN(const Manoeuvre m, manoeuvre_for(model, mode));
  return heading_steps({2.0 * m.step_deg, 0.0},
                       {.hold_s = m.hold_s,
                        .speed_mps = 0.7 * m.speed_mps,
                        .name = fmt::format("held_out_{:g}_0", 2.0 * m.step_deg)});
}

}  // namespace awmr
