#include "awmr/identify/logs/checks/log_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/logs/log_setup.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

using Terms = std::vector<FreeTerm>;

/// True if a significant term of the fit (LogFit::is_significant()) is `of_interest`.
template <class OfInterest>
bool any_significant(const LogFit& fit, OfInterest of_interest) {
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeTerm term{fit.quantities[i], fit.coordinates[i]};
    if (fit.is_significant(i) && of_interest(term)) return true;
  }
  return false;
}

/// True if the fit has significant wheel slip or late commands. With both, a reading changes
/// earlier than the logged commands explain.
bool reads_early(const LogFit& fit) {
  return any_significant(
      fit, [](const FreeTerm& term) { return is_slip(term) || is_late_commands(term); });
}

/// True if the fit has significant slip of the wheels that measure the channel.
bool slips(const LogFit& fit, LogChannel channel) {
  return any_significant(fit, [channel](const FreeTerm& term) {
    return is_slip(term) && term.quantity.channel == channel;
  });
}

std::string_view explanation(const FamilyFit& fit) {
  const Terms terms = with_terms_of(fit.fit, fit.options).terms;
  const auto slip = std::ranges::find_if(terms, is_slip);
  if (slip == terms.end()) return "late time stamps of the commands";
  return slip->quantity.is_ratio ? "wheel slip in proportion to force and speed"
                                 : "wheel slip in proportion to the force";
}

/// The channels whose slip is in `terms`. If there are none, returns the measured channels that
/// slipping wheels may affect: the speed, and the yaw rate if left and right forces differ.
std::vector<LogChannel> slipping_channels(const Terms& terms, const std::vector<DrivingLog>& logs) {
  std::vector<LogChannel> channels;
  for (const FreeTerm& term : terms) {
    if (is_slip(term)) channels.push_back(term.quantity.channel);
  }
  if (!channels.empty()) return channels;
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    if (std::ranges::any_of(logs, [&](const DrivingLog& log) {
          return log[channel] && (channel == LogChannel::kSpeed || has_force_difference(log));
        })) {
      channels.push_back(channel);
    }
  }
  return channels;
}

/// Replaces all slip and late commands in `terms` by slip of these channels. `is_ratio`: form of
/// the new slip (WheelSlip::is_ratio).
Terms with_slip(Terms terms, const std::vector<LogChannel>& channels, bool is_ratio) {
  constexpr double kGuess = 0.05;
  std::erase_if(terms, [](const FreeTerm& t) { return is_slip(t) || is_late_commands(t); });
  for (const LogChannel channel : channels) {
    terms.push_back({wheel_slip_of(channel, is_ratio), kGuess});
  }
  return terms;
}

/// Replaces all slip in `terms` by late commands. If only the speed has slip, also adds a latency
/// of a measured yaw rate: the speed then responds before the logged commands, but the yaw rate
/// does not.
Terms with_late_commands(Terms terms, const std::vector<LogChannel>& channels,
                         const std::vector<DrivingLog>& logs) {
  constexpr double kGuess_s = 0.01;
  std::erase_if(terms, is_slip);
  if (std::ranges::none_of(terms,
                           [](const FreeTerm& t) { return t.quantity.kind == Kind::kDelay; })) {
    terms.push_back({free_term(Kind::kDelay), -kGuess_s});
  }
  const auto is_read_late = [](const FreeTerm& t) {
    return t.quantity.channel == LogChannel::kYawRate &&
           (t.quantity.kind == Kind::kSensorDelay || t.quantity.kind == Kind::kAveraging ||
            t.quantity.kind == Kind::kSensorLag);
  };
  const bool has_yaw_rate = is_logged(logs, {LogChannel::kYawRate});
  if (channels.front() == LogChannel::kSpeed && channels.size() == 1 && has_yaw_rate &&
      std::ranges::none_of(terms, is_read_late)) {
    terms.push_back({free_term(Kind::kSensorDelay, LogChannel::kYawRate), kGuess_s});
  }
  return terms;
}

/// Returns the other explanations of a fit with slip or late commands, each as a list of terms to
/// fit.
std::vector<Terms> other_explanations(const Terms& terms, const std::vector<DrivingLog>& logs) {
  const auto slip = std::ranges::find_if(terms, is_slip);
  const bool slips = slip != terms.end();
  if (!slips && std::ranges::none_of(terms, is_late_commands)) return {};
  const std::vector<LogChannel> channels = slipping_channels(terms, logs);
  if (channels.empty()) return {};
  std::vector<Terms> others;
  if (slips) others.push_back(with_late_commands(terms, channels, logs));
  for (const bool is_ratio : {false, true}) {
    if (slips && slip->quantity.is_ratio == is_ratio) continue;
    others.push_back(with_slip(terms, channels, is_ratio));
  }
  return others;
}

/// AIC of `b` minus AIC of `a`, by all rows or by most rows (kMaxSquaredInnovation), whichever is
/// smaller.
double lead_of(const LogFit& a, const LogFit& b) {
  return std::min(aic_lead(a, b), aic_lead(a, b, kMaxSquaredInnovation));
}

/// Withdraws the intervals that depend on the slip of `fit`, if no position shows that the wheels
/// slip. Empty if there is a position or no slip.
std::optional<Finding> doubt_slip(const std::vector<DrivingLog>& logs, LogFit& fit) {
  const bool is_of_yaw = slips(fit, LogChannel::kYawRate);
  if (!is_of_yaw && !slips(fit, LogChannel::kSpeed)) return std::nullopt;
  if (has_channel(fit.noise, LogChannel::kX)) return std::nullopt;
  const std::vector<std::string> names = withdraw_of_slip(is_of_yaw, fit.report);
  if (names.empty()) return std::nullopt;
  return Finding{logs.front().file, 0, Severity::kWarning, "wheel-slip",
                 fmt::format("without a position, these logs do not show whether wheels slip or "
                             "the sensor of their speed has a longer delay at low speed (speed "
                             "from the time between two encoder ticks), so the intervals of {} are "
                             "withdrawn. Log positions, or measure the speed without driven wheels "
                             "(optical flow, GNSS, a free wheel)",
                             fmt::join(names, ", "))};
}

}  // namespace

std::optional<Finding> decide_slip(const std::vector<DrivingLog>& logs, FamilyFit& chosen) {
  if (!chosen.fit.usable || !reads_early(chosen.fit)) return std::nullopt;
  LogFitOptions options = from_optimum(chosen.options, chosen);
  std::vector<FamilyFit> others;
  for (Terms& terms : other_explanations(options.terms, logs)) {
    options.terms = std::move(terms);
    FamilyFit other = fit_with(logs, options, chosen.surge, chosen.yaw);
    if (!other.fit.usable) continue;
    if (aic_lead(other.fit, chosen.fit) > 0.0) std::swap(other, chosen);
    others.push_back(std::move(other));
  }
  std::vector<std::string> names;
  const FamilyFit* closest = nullptr;
  for (const FamilyFit& other : others) {
    if (!(lead_of(chosen.fit, other.fit) < kTermAicThreshold)) continue;
    for (std::string& name : withdraw_different(other.fit.report, chosen.fit.report)) {
      names.push_back(std::move(name));
      closest = &other;
    }
  }
  if (names.empty()) return doubt_slip(logs, chosen.fit);
  if (!has_channel(chosen.fit.noise, LogChannel::kX)) {
    append(names, withdraw_of_slip(slips(chosen.fit, LogChannel::kYawRate), chosen.fit.report));
  }
  const double lead = lead_of(chosen.fit, closest->fit);
  return Finding{
      logs.front().file, 0, Severity::kWarning, "wheel-slip",
      fmt::format(
          "these logs do not decide between two causes, {} and {}: the AIC of the fit with "
          "the first cause, which is used, is {} {:.1f}{}, so the intervals of {} are "
          "withdrawn. Log each command when it is sent, and measure the speed without "
          "driven wheels (optical flow, GNSS, a free wheel)",
          explanation(chosen), explanation(*closest), lead < 0.0 ? "higher by" : "lower by only",
          std::abs(lead),
          aic_lead(chosen.fit, closest->fit) < kTermAicThreshold ? "" : " without a few rows",
          fmt::join(names, ", "))};
}

}  // namespace awmr
