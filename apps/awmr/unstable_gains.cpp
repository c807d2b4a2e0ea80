#include "unstable_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <variant>

#include "awmr/core/containers.h"
#include "awmr/simulate/conditions.h"
#include "awmr/tune/loop_stability.h"

namespace awmr::cli {
namespace {

/// The warnings about the unstable loops. `place`: end of the name of a loop, such as " in NAME".
std::vector<Finding> unstable_findings(const Model& model, const ModeGains& gains,
                                       const std::filesystem::path& gains_file,
                                       const LoopConditions& conditions,
                                       std::optional<YawMode> mode, const std::string& place) {
  std::vector<Finding> findings;
  for (const UnstableLoop& loop : unstable_loops(model, gains, conditions, mode)) {
    findings.push_back(
        {gains_file.string(), 0, Severity::kWarning, "unstable-gains",
         fmt::format("the {}{} is unstable: {} is {:.3g} {}, too fast for the sample time of {:g} "
                     "s with the latency and the lag of sensors, servo and motors. Tune again for "
                     "this model (awmr tune)",
                     loop.name, place, loop.rate_name, loop.rate, loop.unit,
                     model.vehicle.sample_time_s)});
  }
  return findings;
}

}  // namespace

void note_unstable(const Model& model, const ModeGains& gains,
                   const std::filesystem::path& gains_file, std::vector<Finding>& findings) {
  std::ranges::move(
      unstable_findings(model, gains, gains_file, conditions_of(model.vehicle, kIdealConditions),
                        std::nullopt, {}),
      std::back_inserter(findings));
}

void note_unstable(const Model& model, const ModeGains& gains,
                   const std::filesystem::path& gains_file, std::span<const Scenario> scenarios,
                   std::vector<Finding>& findings, std::optional<YawMode> mode) {
  std::vector<LoopConditions> examined;
  for (const Scenario& scenario : scenarios) {
    if (std::holds_alternative<OpenLoop>(scenario.guidance)) continue;
    const LoopConditions conditions = conditions_of(scenario);
    if (contains(examined, conditions)) continue;
    examined.push_back(conditions);
    std::vector<Finding> unstable = unstable_findings(model, gains, gains_file, conditions, mode,
                                                      fmt::format(" (scenario {})", scenario.name));
    std::ranges::move(unstable, std::back_inserter(findings));
    if (!unstable.empty()) return;
  }
}

}  // namespace awmr::cli
