#include "awmr/trials/checks/log_consistency.h"

#include <fmt/format.h>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/trials/calibration_checks.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {

std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings) {
  const Evidence evidence = evidence_of(log, vehicle, mappings);
  if (auto rest = rest_contradiction(evidence)) return {*std::move(rest)};
  std::vector<Contradiction> found = unit_contradictions(evidence);
  // If the unit of t_s is wrong, the windows are not one second long, and no sign can be checked.
  if (!found.empty() && found.front().column == "t_s") return found;
  append(found, sign_contradictions(evidence));
  // Positions in a wrong unit can look like a jump, so jumps count only if there is no other
  // contradiction.
  if (found.empty()) {
    if (auto jump = jump_contradiction(evidence)) found.push_back(*std::move(jump));
  }
  return found;
}

Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings) {
  const std::vector<Contradiction> found = contradictions(log, vehicle, options.columns);
  std::vector<Fault> faults;
  for (const Contradiction& one : found) {
    if (options.as_is) {
      findings.push_back({log.file, 0, Severity::kWarning, "log-contradiction",
                          fmt::format("{}: {}", one.column, one.message)});
      continue;
    }
    const bool says_more = !one.remedy.empty() || one.mapping.empty();
    const std::string remedy =
        says_more ? one.remedy : "map it with " + option_text("column '" + one.mapping + "'");
    faults.push_back({ErrorCode::kContradiction, place,
                      fmt::format("{}: {}; {}{}accept it with {}", one.column, one.message, remedy,
                                  remedy.empty() ? "" : ", or ", option_text("as-is"))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  if (!found.empty()) return {};
  append(findings, calibration_findings(log, options.columns));
  if (const auto bias = gyro_bias_radps(log)) {
    findings.push_back(
        {log.file, 0, Severity::kWarning, "gyro-bias",
         fmt::format("yaw_rate_radps differs by {:.3g} +- {:.2g} rad/s from the rate of change of "
                     "the heading: the gyroscope has a bias. The fit estimates this bias, as with "
                     "{}; to avoid it, let the gyroscope settle at rest before a drive",
                     bias->value, bias->std_error, option_text("fit bias.yaw_rate_radps"))});
  }
  return {};
}

}  // namespace awmr
