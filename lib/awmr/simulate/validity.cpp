#include "awmr/simulate/validity.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/csv_cell.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/fitted_law.h"

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

std::string fault_of_rate(const HeadingRateChoice& choice) {
  constexpr Interval kRates_degps{0.1, 3600.0};
  if (choice == kMeasuredRate || choice == kNoRate) return {};
  const auto rate_degps = number_from_text(choice);
  if (rate_degps && kRates_degps.contains(*rate_degps)) return {};
  return fmt::format("must be {}, {}, or deg/s from {:g} to {:g}, found {}", kMeasuredRate, kNoRate,
                     kRates_degps.lo, kRates_degps.hi, choice.empty() ? "nothing" : choice);
}

HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& said, const Model& model) {
  if (!said.empty()) return said;
  return measured_yaw_rate_degps(model) ? kMeasuredRate : kNoRate;
}

Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                          std::span<Scenario> scenarios) {
  if (choice.empty() || choice == kNoRate) return {};
  const std::string place = option_text("heading_rate_limit");
  if (const std::string why = fault_of_rate(choice); !why.empty()) return input_error(place, why);
  const std::optional<double> limit_degps =
      choice == kMeasuredRate ? measured_yaw_rate_degps(model) : *number_from_text(choice);
  if (!limit_degps) {
    return input_error(place,
                       "the model does not say how fast it turned when yaw resistance was "
                       "measured; give deg/s, or yaw_rate_max_degps in the vehicle");
  }
  for (Scenario& scenario : scenarios) limit_heading_rate(*limit_degps, scenario);
  return {};
}

void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings) {
  const std::optional<double> measured = measured_yaw_rate_degps(model);
  if (!measured || fastest_degps <= kLittleFurther * *measured) return;
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
