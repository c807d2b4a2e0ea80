#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/identify/logs/choice/log_terms.h"
#include "awmr/identify/logs/findings/term_findings.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

using Logs = std::vector<DrivingLog>;

/// "log 2 (drive.csv)" for the log with this number.
std::string log_text(int number, const Logs& logs) {
  const auto log = std::ranges::find(logs, number, &DrivingLog::number);
  return fmt::format("log {} ({})", number, log == logs.end() ? "" : log->file);
}

/// Differences of one log from the first log, each divided by the value in the first log. Empty if
/// not estimated.
struct LogDifference {
  std::optional<Identified> force;
  std::optional<Identified> surge;  ///< of the resistance
  std::optional<Identified> yaw;
};

std::map<int, LogDifference> differences_of(const LogFit& fit) {
  std::map<int, LogDifference> logs;
  for (const FreeQuantity& q : fit.quantities) {
    if (q.log == 0) continue;
    const auto found = identified(fit, q.name());
    if (q.kind == Kind::kForceScale) logs[q.log].force = found;
    if (q.kind != Kind::kResistanceScale) continue;
    (q.channel == LogChannel::kSpeed ? logs[q.log].surge : logs[q.log].yaw) = found;
  }
  return logs;
}

/// True if force and resistances, over the mass, differ from those of the first log by the same
/// factor: the mass then differs, not they.
bool is_of_mass(const LogDifference& log) {
  constexpr double kErrors = 3.0;
  if (!log.force || !log.surge || !is_significant(*log.force)) return false;
  const auto agrees = [&](const std::optional<Identified>& other) {
    return !other || std::abs(other->value - log.force->value) <
                         kErrors * std::hypot(other->error, log.force->error);
  };
  return is_significant(*log.surge) && agrees(log.surge) && agrees(log.yaw);
}

/// Adds "2.0 +- 0.1 % less in LOG" to `texts`, if the difference is significant and at least half a
/// percent. `more`, `less`: words for a positive and a negative difference.
void add_text(const std::optional<Identified>& difference, const std::string& log,
              std::string_view more, std::string_view less, std::vector<std::string>& texts) {
  if (!difference || !is_significant(*difference)) return;
  if (std::abs(difference->value) < kMinReported) return;
  texts.push_back(fmt::format("{:.1f} +- {:.1f} % {} in {}", 100.0 * std::abs(difference->value),
                              100.0 * difference->error, difference->value > 0.0 ? more : less,
                              log));
}

/// The finding `delay-differs` about logs in which the vehicle responds later or earlier than in the
/// first log. If the times of command changes are uncertain, differences that they can explain are
/// not reported: the mean of these times can differ between the logs.
std::vector<Finding> delay_findings(const LogFit& fit, const Logs& logs) {
  constexpr double kNegligible_s = 0.002;
  std::map<int, std::string> texts;  // by the number of the log
  for (const FreeQuantity& q : fit.quantities) {
    if (q.kind != Kind::kDelay || q.log == 0) continue;
    const auto delay = significant(fit, q.name());
    if (!delay || std::abs(delay->value) < kNegligible_s) continue;
    const double by_rows_s =
        fit.change_reach_s > 0.0 ? fit.change_reach_s + 2.0 * delay->error : 0.0;
    if (std::abs(delay->value) < by_rows_s) continue;
    texts[q.log] = fmt::format("{:.3f} +- {:.3f} s {} in {}", std::abs(delay->value), delay->error,
                               delay->value > 0.0 ? "later" : "earlier", log_text(q.log, logs));
  }
  if (texts.empty()) return {};
  return {{logs.front().file, 0, Severity::kWarning, "delay-differs",
           fmt::format("compared with the first log, the vehicle responds to its commands {}: the "
                       "clocks of commands and sensors, or the latency of the recording, differ. "
                       "The fit estimates this difference; the delay is that of the first log",
                       fmt::join(std::views::values(texts), ", "))}};
}

/// Relative difference of the mass that corresponds to the factor 1 + e of the force over the mass.
Identified of_mass(const Identified& force) {
  const double factor = 1.0 / (1.0 + force.value);
  return {factor - 1.0, factor * factor * force.error};
}

std::vector<Finding> difference_findings(const LogFit& fit, const Logs& logs) {
  std::vector<std::string> masses;
  std::vector<std::string> forces;
  std::vector<std::string> surge;
  std::vector<std::string> yaw;
  for (const auto& [number, log] : differences_of(fit)) {
    const std::string which = log_text(number, logs);
    if (is_of_mass(log)) {
      add_text(of_mass(*log.force), which, "heavier", "lighter", masses);
      continue;
    }
    add_text(log.force, which, "more", "less", forces);
    add_text(log.surge, which, "higher", "lower", surge);
    add_text(log.yaw, which, "higher", "lower", yaw);
  }
  std::vector<Finding> findings;
  const auto report = [&](const char* code, const std::vector<std::string>& texts,
                          std::string_view subject, std::string_view cause) {
    if (texts.empty()) return;
    findings.push_back({logs.front().file, 0, Severity::kWarning, code,
                        fmt::format("compared with the first log, {} {}: {}. The fit estimates "
                                    "this difference, and its results are those of the first log",
                                    subject, fmt::join(texts, ", "), cause)});
  };
  report("load-differs", masses, "the vehicle is", "a load, or other batteries");
  report("forces-differ", forces, "the wheels push at the same command",
         "the battery voltage differs, for example");
  report("resistance-differs", surge, "the surge resistance is", "other ground or tyres");
  report("resistance-differs", yaw, "the yaw resistance is", "other ground or tyres");
  return findings;
}

/// Finding `gyro-bias` about a constant offset of the yaw rate. With a heading,
/// log_consistency.cpp reports it.
std::vector<Finding> gyro_bias_findings(const LogFit& fit, const Logs& logs) {
  if (has_channel(fit.noise, LogChannel::kHeading)) return {};
  std::map<int, std::string> texts;  // by the number of the log; 0: of all logs
  for (const FreeQuantity& q : fit.quantities) {
    if (q.kind != Kind::kBias || q.channel != LogChannel::kYawRate) continue;
    const auto bias = significant(fit, q.name());
    if (!bias) continue;
    const std::string value = fmt::format("{:.3g} +- {:.2g} rad/s", bias->value, bias->error);
    texts[q.log] = q.log == 0
                       ? fmt::format("yaw_rate_radps is {} while the vehicle does not turn", value)
                       : fmt::format("in {} shifted by {} from that of the first log",
                                     log_text(q.log, logs), value);
  }
  if (texts.empty()) return {};
  return {
      {logs.front().file, 0, Severity::kWarning, "gyro-bias",
       fmt::format("the gyroscope has a bias: {}. The fit estimates this bias; to avoid it, let "
                   "the gyroscope settle at rest before a drive",
                   fmt::join(std::views::values(texts), ", "))}};
}

}  // namespace

std::vector<Finding> log_findings(const LogFit& fit, const std::vector<DrivingLog>& logs) {
  std::vector<Finding> findings = difference_findings(fit, logs);
  append(findings, delay_findings(fit, logs));
  append(findings, gyro_bias_findings(fit, logs));
  return findings;
}

}  // namespace awmr
