#include "awmr/simulate/validity.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/units.h"

namespace awmr {

std::optional<double> measured_yaw_rate_degps(const Model& model) {
  if (model.vehicle.yaw_rate_max_degps) return model.vehicle.yaw_rate_max_degps;
  std::optional<double> fastest;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kTurning) continue;
    fastest = std::max(fastest.value_or(0.0), degrees(trial.measured));
  }
  return fastest;
}

void limit_heading_rate(double limit_degps, Scenario& scenario) {
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) return;
  const double limit_radps = radians(limit_degps);
  if (scenario.shaping) {
    scenario.shaping->rate_max_radps = std::min(scenario.shaping->rate_max_radps, limit_radps);
    return;
  }
  // The limit is reached within a time constant of the filter.
  scenario.shaping =
      HeadingShaping<double>{.omega_radps = kShapingBandwidth_radps,
                             .rate_max_radps = limit_radps,
                             .accel_max_radps2 = kShapingBandwidth_radps * limit_radps};
}

void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings) {
  constexpr double kClearly =
      1.2;  // a power law that was fitted up to there holds a little further
  const std::optional<double> measured = measured_yaw_rate_degps(model);
  if (!measured || fastest_degps <= kClearly * *measured) return;
  findings.push_back(
      {model.file, 0, Severity::kWarning, "beyond-trials",
       fmt::format("{}: the vehicle turns at up to {:.3g} deg/s, {:.2g} times as fast as yaw "
                   "resistance was measured (up to {:.3g} deg/s): beyond it the model is "
                   "extrapolated. Record faster turning trials, or limit the heading's rate "
                   "(shaping in the "
                   "scenario, or --heading-rate-limit measured)",
                   where, fastest_degps, fastest_degps / *measured, *measured)});
}

}  // namespace awmr
