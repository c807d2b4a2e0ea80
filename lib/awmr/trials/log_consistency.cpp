#include "awmr/trials/log_consistency.h"

#include <fmt/format.h>

#include <cmath>

#include "awmr/core/option_text.h"
#include "awmr/core/sample_quantile.h"
#include "awmr/trials/calibration_checks.h"
#include "awmr/trials/log_evidence.h"

namespace awmr {

std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings) {
  const Evidence evidence = evidence_of(log, vehicle, mappings);
  if (auto rest = rest_contradiction(evidence)) return {*std::move(rest)};
  std::vector<Contradiction> found = unit_contradictions(evidence);
  // If the unit of t_s is wrong, the windows are not one second long, and no sign can be checked.
  if (!found.empty() && found.front().column == "t_s") return found;
  for (Contradiction& one : sign_contradictions(evidence)) found.push_back(std::move(one));
  // Positions in a wrong unit can look like a jump, so jumps count only if there is no other
  // contradiction.
  if (found.empty()) {
    if (auto jump = jump_contradiction(evidence)) found.push_back(*std::move(jump));
  }
  return found;
}

std::optional<GyroBias> gyro_bias(const DrivingLog& log) {
  if (!log[LogChannel::kHeading] || !log[LogChannel::kYawRate]) return std::nullopt;
  std::vector<double> offsets;
  for (const LogWindow& window : windows_of(log, kEvidenceWindow_s)) {
    const std::vector<double>& heading = log[LogChannel::kHeading]->value;
    const double span_s = log.t_s[window.end - 1] - log.t_s[window.begin];
    const double turned = heading[window.end - 1] - heading[window.begin];
    offsets.push_back((integral_of(log, LogChannel::kYawRate, window) - turned) / span_s);
  }
  if (offsets.size() < 10) return std::nullopt;
  const double bias = median(offsets);
  // The standard error of a median is sqrt(pi/2) = 1.2533 times that of a mean.
  const double error = 1.2533 * kStdPerMad * median_absolute_deviation(offsets, bias) /
                       std::sqrt(static_cast<double>(offsets.size()));
  return GyroBias{bias, error};
}

bool GyroBias::significant() const {
  constexpr double kStandardErrors = 5.0;
  return std::abs(bias_radps) > kStandardErrors * std_error_radps;
}

bool has_gyro_bias(const DrivingLog& log) {
  const auto bias = gyro_bias(log);
  return bias && bias->significant();
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
  for (Finding& finding : calibration_findings(log, options.columns)) {
    findings.push_back(std::move(finding));
  }
  const auto bias = gyro_bias(log);
  if (bias && bias->significant()) {
    findings.push_back(
        {log.file, 0, Severity::kWarning, "gyro-bias",
         fmt::format("yaw_rate_radps differs by {:.3g} +- {:.2g} rad/s from the rate of change of "
                     "the heading: the gyroscope has a bias. The fit estimates this bias, as with "
                     "{}; to avoid it, let the gyroscope settle at rest before a drive",
                     bias->bias_radps, bias->std_error_radps,
                     option_text("fit bias.yaw_rate_radps"))});
  }
  return {};
}

}  // namespace awmr
