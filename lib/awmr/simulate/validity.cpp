#include "awmr/simulate/validity.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/csv_cell.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/fitted_law.h"

namespace awmr {

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
  if (choice == kMeasuredRate || choice == kNoRate) return {};
  const auto rate_degps = number_from_text(choice);
  if (rate_degps && kLeadRates_degps.contains(*rate_degps)) return {};
  return fmt::format("must be {}, {}, or deg/s from {:g} to {:g}, found {}", kMeasuredRate, kNoRate,
                     kLeadRates_degps.lo, kLeadRates_degps.hi, choice.empty() ? "nothing" : choice);
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

std::optional<Finding> not_led(const HeadingRateChoice& said, const Model& model) {
  if (!said.empty() || measured_yaw_rate_degps(model)) return std::nullopt;
  return Finding{model.file, 0, Severity::kWarning, "not-led",
                 fmt::format("the model does not say how fast it turned when yaw resistance was "
                             "measured, so that headings are not led: what parts the modes may be "
                             "the model's extrapolation. Give yaw_rate_max_degps in the vehicle, "
                             "or {}",
                             option_text("heading_rate_limit"))};
}

void note_extrapolation(const Model& model, double fastest_degps, const std::string& where,
                        std::vector<Finding>& findings, bool is_led) {
  const std::optional<double> measured = measured_yaw_rate_degps(model);
  if (!measured || fastest_degps <= kLittleFurther * *measured) return;
  findings.push_back(
      {model.file, 0, Severity::kWarning, "beyond-trials",
       fmt::format("{}: the vehicle turns at up to {:.3g} deg/s, {:.2g} times as fast as yaw "
                   "resistance was measured (up to {:.3g} deg/s): beyond it the model is "
                   "extrapolated. {}",
                   where, fastest_degps, fastest_degps / *measured, *measured,
                   is_led ? "The heading is led no faster than that, and the vehicle overshoots it "
                            "or slides: record faster turning trials, or lower the limit "
                            "(--heading-rate-limit)"
                          : "Record faster turning trials, or limit the heading's rate (shaping in "
                            "the scenario, or --heading-rate-limit measured)")});
}

}  // namespace awmr
