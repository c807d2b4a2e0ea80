#include "awmr/validate/claims.h"
#include "awmr/control/allocation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "awmr/model/paper_gains.h"

namespace awmr {
namespace {

/// Largest steady yaw rate r of a mode, rad/s, at a steady speed: the mode makes its largest yaw
/// moment, while the surge force tau_speed holds the speed. With the yaw resistance g3(r) = a3
/// r^b3,
///   r = (moment/a3)^(1/b3)
double largest_yaw_rate_radps(const Plant<double>& plant, const AllocationLimits<double>& limits,
                              YawMode mode, double speed_mps) {
  // The allocation limits this request to the largest moment that the mode can make.
  constexpr double kMoreThanAnyMoment_m = 1e3;
  const Allocation<double> a =
      allocate(mode, plant.surge(speed_mps), kMoreThanAnyMoment_m, limits, speed_mps);
  const GeneralisedForces<double> tau =
      generalised_forces(plant.front_axle_m, plant.half_track_m, a.force, a.steering_rad);
  const double moment_m = std::max(0.0, tau.tau_steering_m + tau.tau_diff_m);
  return std::pow(moment_m / plant.yaw.alpha, 1.0 / plant.yaw.beta);
}

}  // namespace

ModeRuns ClaimSetting::run(const Scenario& scenario) const {
  return std::move(run_all({this, 1}, scenario).front());
}

std::vector<ModeRuns> run_all(std::span<const ClaimSetting> settings, Scenario scenario) {
  scenario.control = settings.front().control;
  std::vector<BatchRun> batch;
  for (const ClaimSetting& setting : settings) {
    const Plant<double> plant = plant_for(scenario, setting.model).value();
    for (const YawMode mode : kYawModes) {
      batch.push_back({.plant = plant,
                       .controller = controller_for(setting.model, setting.gains.in(mode)).value(),
                       .mode = mode});
    }
  }
  std::vector<DrivenRun> driven =
      simulate_batch(batch, scenario, settings.front().model.vehicle.sample_time_s,
                     settings.front().arithmetic, true);
  std::vector<ModeRuns> runs(settings.size());
  auto next = driven.begin();
  for (ModeRuns& in_modes : runs) {
    for (std::size_t m = 0; m < in_modes.size(); ++m, ++next) {
      in_modes[m] = {kYawModes[m], std::move(next->run), next->metrics};
    }
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
  // Direction of the last movement: 1 rising, -1 falling, 0 none beyond the band yet.
  int direction = 0;
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

std::vector<std::vector<Claim>> check_claims_of(std::span<const Model> models,
                                                const std::optional<ModeGains>& gains,
                                                const BatchArithmetic& arithmetic,
                                                const ControlOptions& control) {
  std::vector<Plant<double>> plants;
  for (const Model& model : models) plants.push_back(model.plant().value());
  std::vector<ClaimSetting> settings;
  for (std::size_t i = 0; gains && i < models.size(); ++i) {
    settings.push_back({models[i], plants[i], *gains, arithmetic, control});
  }
  std::vector<std::vector<Claim>> guided;
  if (gains) guided = check_guidance_claims(settings);
  std::vector<std::vector<Claim>> claims(models.size());
  const auto move_to = [](std::vector<Claim>& all, auto first, auto last) {
    all.insert(all.end(), std::make_move_iterator(first), std::make_move_iterator(last));
  };
  for (std::size_t i = 0; i < models.size(); ++i) {
    claims[i].push_back(check_straight_run(models[i], plants[i], control));
    claims[i].push_back(check_circle(models[i], plants[i], control));
    if (gains) {
      std::vector<Claim> heading = check_heading_claims(settings[i]);
      move_to(claims[i], heading.begin(), heading.end() - 1);
      move_to(claims[i], guided[i].begin(), guided[i].end());  // inserts C8 to C12 before C13
      move_to(claims[i], heading.end() - 1, heading.end());
    }
    claims[i].push_back(check_time_constants(gains));
  }
  return claims;
}

std::vector<Claim> check_claims(const Model& model, const std::optional<ModeGains>& gains,
                                const BatchArithmetic& arithmetic) {
  return std::move(check_claims_of({&model, 1}, gains, arithmetic, {}).front());
}

}  // namespace awmr
