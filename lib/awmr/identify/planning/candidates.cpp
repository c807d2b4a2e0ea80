#include "awmr/identify/planning/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/gravity.h"
#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/steady.h"
#include "awmr/model/tyres.h"

namespace awmr {
namespace {

/// Assumed sample rate of logs and coast-down curves.
constexpr double kRate_hz = 100.0;
/// Stands for a predicted speed (m/s) or yaw rate (rad/s) of 0, because 0 has no logarithm.
constexpr double kAtRest = 1e-6;

/// Scatter of the model's trials of one kind: relative standard deviation of the predicted from the
/// measured values. An assumed value of 5 % if there are fewer than three rows.
double relative_scatter(const Model& model, TrialKind kind) {
  double squares = 0.0;
  int count = 0;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != kind || !trial.predicted) continue;
    const double relative = *trial.predicted / trial.measured - 1.0;
    squares += relative * relative;
    ++count;
  }
  constexpr double kOtherwise = 0.05;
  return count > 2 && squares > 0.0 ? std::sqrt(squares / (count - 2)) : kOtherwise;
}

/// Candidate surge runs. They measure ln u, with the steady speed u under tau_speed. The standard
/// error of the mean of the runs is the relative scatter over sqrt(runs).
CandidateTrial surge_candidate(double tau, double wheel_force, double scatter, double runs) {
  return {.trial = {.kind = TrialKind::kSurge,
                    .settings = fmt::format("straight, tau_speed {:.3g} (wheel_force {:.3g}), {:g} "
                                            "runs over 10 m after reaching steady speed",
                                            tau, wheel_force, runs),
                    .numbers = {{"tau_speed", tau}, {"runs", runs}}},
          .standardised = [=](const Plant<double>& p) {
            const double u =
                steady_rate(p.surge, tau - driven_wheels(p) * p.wheel_dead_zone).value_or(kAtRest);
            return std::vector{std::sqrt(runs) * std::log(u) / scatter};
          }};
}

/// Candidate steered turns. They measure ln r, with the steady yaw rate r under the yaw moment
/// tau_turn = 2 l_f F' sin d_r (F': wheel force, d_r: steering angle, l_f: distance of the front
/// axle).
CandidateTrial turning_candidate(double steering_rad, double wheel_force, double scatter,
                                 double runs) {
  return {.trial = {.kind = TrialKind::kTurning,
                    .settings = fmt::format("steering {:.3g} deg, wheel_force {:.3g}, {:g} full "
                                            "turns",
                                            degrees(steering_rad), wheel_force, runs),
                    .numbers = {{"steering_deg", degrees(steering_rad)},
                                {"wheel_force", wheel_force},
                                {"runs", runs}}},
          .standardised = [=](const Plant<double>& p) {
            const double effective = std::max(0.0, wheel_force - p.wheel_dead_zone);
            const double tau = steering_moment_m(p.front_axle_m, effective, steering_rad);
            const double r = steady_rate(p.yaw, tau).value_or(kAtRest);
            return std::vector{std::sqrt(runs) * std::log(r) / scatter};
          }};
}

/// Candidate differential turns of a vehicle without steering. They measure ln r, with the steady
/// yaw rate r under the yaw moment tau_turn = 2 d (F'R - F'L) (d: half of the track width).
CandidateTrial sides_candidate(SideForces<double> force, double scatter, double runs) {
  return {.trial = {.kind = TrialKind::kTurning,
                    .settings = fmt::format("force_left {:.3g}, force_right {:.3g}, {:g} full "
                                            "turns",
                                            force.left, force.right, runs),
                    .numbers = {{"force_left", force.left},
                                {"force_right", force.right},
                                {"runs", runs}}},
          .standardised = [=](const Plant<double>& p) {
            const double effective = beyond_dead_zone(force.right, p.wheel_dead_zone) -
                                     beyond_dead_zone(force.left, p.wheel_dead_zone);
            const double tau = differential_moment_m(p.half_track_m, effective);
            const double r = steady_rate(p.yaw, tau).value_or(kAtRest);
            return std::vector{std::sqrt(runs) * std::log(r) / scatter};
          }};
}

/// Candidate coast-down curve: the speed from switching the motors off to rest.
CandidateTrial coastdown_candidate(double from_mps, double duration_s, double noise_mps,
                                   double runs) {
  return {.trial = {.kind = TrialKind::kCoastdown,
                    .settings = fmt::format("motors off from {:.3g} m/s, speed recorded at 100 Hz "
                                            "to rest ({:.2g} s), {:g} runs",
                                            from_mps, duration_s, runs),
                    .numbers = {{"initial_speed_mps", from_mps},
                                {"duration_s", duration_s},
                                {"rate_hz", kRate_hz},
                                {"runs", runs}}},
          .standardised = [=, noise = noise_mps / std::sqrt(runs)](const Plant<double>& p) {
            Random none(1, 1);
            std::vector<double> values =
                simulate_coastdown(p, from_mps, duration_s, kRate_hz, 0.0, 0.0, none).speed_mps;
            for (double& value : values) value /= noise;
            return values;
          }};
}

/// Candidate driving log. It measures speed, yaw rate and heading; the position is not used.
CandidateTrial log_candidate(const std::string& what, const Vehicle& vehicle, const DrivePlan& plan,
                             const SensorNoise& sensors) {
  return {.trial = {.kind = TrialKind::kLog,
                    .settings = fmt::format("{}, new step every {:g} s, {:g} s logged at 100 Hz",
                                            what, plan.hold_s, plan.duration_s),
                    .numbers = {{"duration_s", plan.duration_s},
                                {"rate_hz", plan.rate_hz},
                                {"runs", 1.0}}},
          .standardised = [=](const Plant<double>& p) {
            Random none(1, 1);
            SensorNoise silent = sensors;
            silent.speed_mps = silent.yaw_rate_radps = silent.heading_rad = silent.position_m = 0.0;
            const DrivingLog log = simulate_log(p, vehicle, plan, silent, none);
            std::vector<double> values;
            const auto take = [&](LogChannel channel, double noise) {
              for (std::size_t row = 0; row < log.rows(); ++row) {
                if (log[channel]->fresh[row]) values.push_back(log[channel]->value[row] / noise);
              }
            };
            take(LogChannel::kSpeed, sensors.speed_mps);
            take(LogChannel::kYawRate, sensors.yaw_rate_radps);
            take(LogChannel::kHeading, sensors.heading_rad);
            return values;
          }};
}

void add_coastdowns(const Vehicle& vehicle, const Plant<double>& plant,
                    const SuggestOptions& options, std::vector<CandidateTrial>& candidates) {
  const double top =
      steady_rate(plant.surge,
                  driven_wheels(plant) * (vehicle.wheel_force.hi - plant.wheel_dead_zone),
                  driven_wheels(plant) * plant.back_emf_s_per_m)
          .value_or(1.0);
  for (const double share : {0.5, 1.0}) {
    const double from = share * top;
    const double stop_s = stop_time_s(plant.surge, plant.mass_norm, from).value_or(5.0);
    candidates.push_back(coastdown_candidate(from, std::min(10.0, 1.2 * stop_s),
                                             options.sensors.speed_mps, options.repeats));
  }
}

void add_logs(const Vehicle& vehicle, Motion motion, const SensorNoise& sensors,
              std::vector<CandidateTrial>& candidates) {
  const char* steps = vehicle.has_steering()
                          ? "steps of thrust and steering, some with unequal forces left and right"
                          : "steps of thrust, some with unequal forces left and right";
  candidates.push_back(log_candidate("straight starts and stops", vehicle,
                                     {.duration_s = 30.0, .straight = true}, sensors));
  if (motion != Motion::kPlanar) return;
  candidates.push_back(log_candidate(steps, vehicle, {.duration_s = 30.0}, sensors));
  candidates.push_back(log_candidate(steps, vehicle, {.duration_s = 120.0}, sensors));
}

void add_surge_runs(const Model& model, const SuggestOptions& options,
                    std::vector<CandidateTrial>& candidates) {
  const double scatter = relative_scatter(model, TrialKind::kSurge);
  for (const double share : {0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
    const double wheel_force = model.vehicle.wheel_force.hi * share;
    candidates.push_back(surge_candidate(model.vehicle.driven_wheels() * wheel_force, wheel_force,
                                         scatter, options.repeats));
  }
}

void add_turning_runs(const Model& model, const SuggestOptions& options,
                      std::vector<CandidateTrial>& candidates) {
  const Vehicle& vehicle = model.vehicle;
  const double scatter = relative_scatter(model, TrialKind::kTurning);
  if (!vehicle.has_steering()) {
    for (const double share : {0.1, 0.2, 0.35, 0.5, 1.0}) {
      const double right = share * vehicle.wheel_force.hi;
      const double left = std::max(-right, std::min(0.0, vehicle.wheel_force.lo));
      candidates.push_back(sides_candidate({left, right}, scatter, options.repeats));
    }
    return;
  }
  for (const double angle_share : {0.25, 0.5, 1.0}) {
    for (const double force_share : {0.2, 0.5, 1.0}) {
      candidates.push_back(turning_candidate(radians(vehicle.steering_max_deg) * angle_share,
                                             vehicle.wheel_force.hi * force_share, scatter,
                                             options.repeats));
    }
  }
}

}  // namespace

std::vector<CandidateTrial> candidates_of(const Model& model, const SuggestOptions& options) {
  std::vector<CandidateTrial> candidates;
  // A model with back-EMF gets no table rows as candidates: steady runs determine only the sum of
  // back-EMF and resistance.
  const bool tables = !(model[ParameterId::kBackEmf].value.value_or(0.0) > 0.0);
  if (tables && model.plant(Motion::kSteadySurge)) add_surge_runs(model, options, candidates);
  if (tables && model.plant(Motion::kSteadyTurn)) add_turning_runs(model, options, candidates);
  if (const auto plant = model.plant(Motion::kStraight)) {
    add_coastdowns(model.vehicle, *plant, options, candidates);
    add_logs(model.vehicle, model.simulated_motion(), options.sensors, candidates);
  }
  return candidates;
}

namespace {

/// Range in which the scrub moment may be, divided by F_max, m. If the scrub was measured: its 95 %
/// interval without negative values. Otherwise: from the largest moment at which the vehicle did
/// not turn (0 if none is known) to the moment of sliding tyres.
Interval possible_scrub_m(const Model& model, const Plant<double>& plant) {
  const double held_m = model.yaw_held_m.value_or(0.0);
  if (const auto& scrub = model.yaw_scrub) {
    const double least = std::max(scrub->ci95_m.lo, 0.0);
    return {least, std::max({scrub->ci95_m.hi, least, held_m})};
  }
  return {held_m, std::max(held_m, sliding_moment_m(plant))};
}

/// Returns the left and right wheel forces F'L and F'R that have the mean `straight` and make a
/// given yaw moment, divided by F_max, m (d: half of the track width):
///   2 d (F'R - F'L) = moment                                                        [paper (41)]
/// Empty if a force is outside `range`, the limits of the wheel forces.
std::optional<SideForces<double>> forces_for(double moment_m, double straight,
                                             const Plant<double>& plant, const Interval& range) {
  const double half = moment_m / (4.0 * plant.half_track_m);
  const SideForces<double> force{with_dead_zone(straight - half, plant.wheel_dead_zone),
                                 with_dead_zone(straight + half, plant.wheel_dead_zone)};
  if (force.left < range.lo || force.right > range.hi) return std::nullopt;
  return force;
}

/// Text that suggests steered turns, for a model that was identified from differential turns only.
std::string steered_turns_instead(const Vehicle& vehicle) {
  const double stop = vehicle.steering_max_deg;
  const double force = 0.5 * vehicle.wheel_force.hi;
  return fmt::format(
      "all turns were differential, so the yaw resistance includes their tyre scrub. Record at "
      "least three steered turns in the turning table: steering {:.3g}, {:.3g} and {:.3g} deg, "
      "wheel_force {:.3g}, or less if the space is small",
      stop / 3.0, 2.0 * stop / 3.0, stop, force);
}

/// Highest speed of the surge trials, > 0; absent without trials.
std::optional<double> fastest_surge_mps(const Model& model) {
  std::optional<double> fastest_mps;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kSurge || !(trial.measured > 0.0)) continue;
    fastest_mps = std::max(fastest_mps.value_or(0.0), trial.measured);
  }
  return fastest_mps;
}

std::string purpose_of(const Model& model) {
  if (const auto& scrub = model.yaw_scrub) {
    return fmt::format(
        "the tyre scrub (yaw moment divided by F_max), measured in {} turns, is {:.3g} to {:.3g} m "
        "(95 % interval). Four times as many turns halve the interval; compare --break-even shows "
        "whether this is needed",
        scrub->rows, scrub->ci95_m.lo, scrub->ci95_m.hi);
  }
  return model.yaw_held_m
             ? fmt::format("the tyre scrub (yaw moment divided by F_max) is at least {:.3g} m",
                           *model.yaw_held_m)
             : std::string("the tyre scrub is not known yet");
}

}  // namespace

ScrubPlan scrub_plan(const Model& model) {
  const Vehicle& vehicle = model.vehicle;
  if (!vehicle.has_steering()) return {};
  if (model.yaw_by_sides_alone) return {{}, steered_turns_instead(vehicle)};
  const auto yaw = model.plant(Motion::kSteadyTurn);
  const auto surge = model.plant(Motion::kSteadySurge);
  const std::optional<double> fastest_degps = measured_yaw_rate_degps(model);
  if (!yaw || !surge || !fastest_degps) {
    return {{},
            "to suggest forces of differential turns, the model needs the surge resistance, the "
            "yaw resistance and the highest yaw rate. Record surge and turning trials, or a log; "
            "the yaw rate can also be yaw_rate_max_degps of the vehicle file"};
  }
  const std::optional<double> fastest_mps = fastest_surge_mps(model);
  const double straight = fastest_mps ? surge->surge(0.5 * *fastest_mps) / vehicle.driven_wheels()
                                      : 0.5 * (vehicle.wheel_force.lo + vehicle.wheel_force.hi);
  const Interval scrub_m = possible_scrub_m(model, *yaw);
  ScrubPlan plan{{}, purpose_of(model)};
  constexpr int kTurns = 3;
  for (int i = 1; i <= kTurns; ++i) {
    const double rate_degps = *fastest_degps * i / kTurns;
    const double resisted_m = yaw->yaw(radians(rate_degps));
    const auto least = forces_for(resisted_m + scrub_m.lo, straight, *yaw, vehicle.wheel_force);
    if (!least) break;
    const auto most = forces_for(resisted_m + scrub_m.hi, straight, *yaw, vehicle.wheel_force);
    const SideForces<double> limits{vehicle.wheel_force.lo, vehicle.wheel_force.hi};
    plan.turns.push_back({rate_degps, *least, most.value_or(limits)});
  }
  if (plan.turns.size() < kTurns) {
    plan.about += fmt::format(
        "; the wheel forces suffice for only {} of {} yaw rates at a mean wheel force of "
        "{:.3g}. Three turns are needed: repeat the possible turns, at the same or another speed",
        plan.turns.size(), kTurns, straight);
  }
  return plan;
}

/// At the speed u and the steering angle d_r, a vehicle with the wheelbase 2 l_f that rolls without
/// slip about a centre on the line of the rear axle (tyres.h) has the yaw rate r. The lateral
/// acceleration u r limits the angle:
///   r = u tan(d_r)/(2 l_f),   u r <= 0.2 g
std::optional<CoastingTurn> coasting_turn(const Model& model) {
  const Vehicle& vehicle = model.vehicle;
  const auto surge = model.plant(Motion::kSteadySurge);
  if (!vehicle.has_steering() || !surge) return std::nullopt;
  constexpr double kMaxAcross_mps2 = 0.2 * kGravity_mps2;
  const double force = std::max(0.0, vehicle.wheel_force.hi - surge->wheel_dead_zone);
  const auto reachable = steady_rate(surge->surge, driven_wheels(*surge) * force,
                                     driven_wheels(*surge) * surge->back_emf_s_per_m);
  const double fastest_mps = fastest_surge_mps(model).value_or(reachable.value_or(0.0));
  if (!(fastest_mps > 0.0)) return std::nullopt;
  const double speed_mps = 0.5 * fastest_mps;
  const double wheelbase_m = 2.0 * vehicle.front_axle_m;
  const double most_rad = std::atan(kMaxAcross_mps2 * wheelbase_m / (speed_mps * speed_mps));
  const double steering_rad = std::min(radians(0.5 * vehicle.steering_max_deg), most_rad);
  return CoastingTurn{speed_mps, degrees(steering_rad),
                      degrees(speed_mps * std::tan(steering_rad) / wheelbase_m)};
}

std::vector<std::string> assumptions_of(const Model& model, const SuggestOptions& options) {
  const SensorNoise& sensors = options.sensors;
  return {fmt::format("relative scatter of steady speeds {:.2g}, of yaw rates {:.2g} (from this "
                      "model's trials, else 0.05)",
                      relative_scatter(model, TrialKind::kSurge),
                      relative_scatter(model, TrialKind::kTurning)),
          fmt::format("standard deviation of the sensor noise in logs and coast-down curves {:g} "
                      "m/s, {:.2g} rad/s, {:.2g} rad at 100 Hz; positions are not used",
                      sensors.speed_mps, sensors.yaw_rate_radps, sensors.heading_rad),
          fmt::format("{} runs of each surge, turning or coast-down trial; a log is driven once",
                      options.repeats)};
}

}  // namespace awmr
