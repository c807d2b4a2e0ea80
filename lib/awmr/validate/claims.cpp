#include "awmr/validate/claims.h"
#include "awmr/control/allocation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "awmr/model/paper_gains.h"

namespace awmr {
namespace {

/// Steady yaw rate at the largest moment of a mode while tau_speed holds the speed: r =
/// (moment/a3)^(1/b3).
double largest_yaw_rate_radps(const Plant<double>& plant, const AllocationLimits<double>& limits,
                              YawMode mode, double speed_mps) {
  constexpr double kMoreThanAnyMoment_m = 1e3;
  const Allocation<double> a =
      allocate(mode, plant.surge(speed_mps), kMoreThanAnyMoment_m, limits, speed_mps);
  const GeneralisedForces<double> tau =
      generalised_forces(plant.front_axle_m, plant.half_track_m, a.force, a.steering_rad);
  const double moment_m = std::max(0.0, tau.tau_steering_m + tau.tau_diff_m);
  return std::pow(moment_m / plant.yaw.alpha, 1.0 / plant.yaw.beta);
}

}  // namespace

Run run_or_failed(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                  YawMode mode) {
  Run failed;
  failed.rows.emplace_back();
  failed.end = RunEnd::kFailed;
  return simulate(model, gains, scenario, mode).value_or(std::move(failed));
}

ModeRuns run_modes(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                   const BatchArithmetic& arithmetic) {
  const BatchRun run{.plant = plant_for(scenario, model).value(),
                     .controller = controller_for(model, gains).value(),
                     .mode = {}};
  std::vector<BatchRun> in_modes(std::size(kYawModes), run);
  for (std::size_t i = 0; i < in_modes.size(); ++i) in_modes[i].mode = kYawModes[i];
  auto driven = drive_batch(in_modes, scenario, model.vehicle.sample_time_s, arithmetic);
  ModeRuns runs;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i] = {kYawModes[i], std::move(driven[i].run), driven[i].metrics};
  }
  return runs;
}

double allowed_settling_s(const Plant<double>& plant, const Vehicle& vehicle, YawMode mode,
                          double step_rad, double speed_mps) {
  const Controller<double> controller = make_controller(plant, vehicle, kPaperGains);
  const double rate_radps = largest_yaw_rate_radps(plant, controller.limits, mode, speed_mps);
  const double law_s = 4.0 * (kPaperGains.heading.sliding_time_constant_s() +
                              2.0 * kPaperGains.heading.reaching_time_constant_s());
  return std::abs(step_rad) / rate_radps + law_s;
}

int reversals(std::span<const double> signal, double band) {
  if (signal.empty()) return 0;
  int count = 0;
  int direction = 0;  // 0 until the signal has first moved by more than the band
  double low = signal[0];
  double high = signal[0];
  for (const double value : signal) {
    low = std::min(low, value);
    high = std::max(high, value);
    const bool fell = value < high - band;
    const bool rose = value > low + band;
    if (direction >= 0 && fell) {
      count += direction == 0 ? 0 : 1;
      direction = -1;
      low = high = value;
    } else if (direction <= 0 && rose) {
      count += direction == 0 ? 0 : 1;
      direction = 1;
      low = high = value;
    }
  }
  return count;
}

std::vector<Claim> check_claims(const Model& model, const Plant<double>& plant,
                                const std::optional<Gains<double>>& gains,
                                const BatchArithmetic& arithmetic, const ControlOptions& control) {
  std::vector<Claim> claims;
  claims.push_back(check_straight_run(model, plant, control));
  claims.push_back(check_circle(model, plant, control));
  if (gains) {
    const ClaimSetting setting{model, plant, *gains, arithmetic, control};
    for (Claim& claim : check_heading_claims(setting)) {
      claims.push_back(std::move(claim));
    }
    // C13 follows C8 to C12.
    const auto driven = claims.end() - 1;
    std::vector<Claim> guided = check_guidance_claims(setting);
    claims.insert(driven, std::make_move_iterator(guided.begin()),
                  std::make_move_iterator(guided.end()));
  }
  claims.push_back(check_time_constants(gains));
  return claims;
}

}  // namespace awmr
