#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "awmr/core/gravity.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {
namespace {

/// Mean, variance and number of a channel's readings within a window of one second.
struct WindowMoments {
  double mean = 0.0;
  double variance = 0.0;
  double count = 0.0;
};

std::vector<WindowMoments> moments_of(const DrivingLog& log, LogChannel channel) {
  std::vector<WindowMoments> all;
  for (const LogWindow& window : windows_of(log, kEvidenceWindow_s)) {
    WindowMoments m;
    double squares = 0.0;
    for (std::size_t row = window.begin; row < window.end; ++row) {
      if (!log[channel]->fresh[row]) continue;
      const double off = log[channel]->value[row] - m.mean;
      m.count += 1.0;
      m.mean += off / m.count;
      squares += off * (log[channel]->value[row] - m.mean);
    }
    if (m.count < 3.0) continue;
    m.variance = squares / (m.count - 1.0);
    all.push_back(m);
  }
  return all;
}

/// True if a channel is only noise about a constant value. Analysis of variance: F = n var(means of
/// the windows)/(mean variance within a window) is at most kMaxRatio (n: readings per window).
bool is_noise_alone(const std::vector<WindowMoments>& windows) {
  // F is about 1 for white noise, somewhat larger for correlated noise, and above 100 for motion.
  constexpr double kMaxRatio = 5.0;
  const auto n = static_cast<double>(windows.size());
  double mean = 0.0, within = 0.0, readings = 0.0, between = 0.0;
  for (const WindowMoments& w : windows) {
    mean += w.mean / n;
    within += w.variance / n;
    readings += w.count / n;
  }
  for (const WindowMoments& w : windows) between += (w.mean - mean) * (w.mean - mean) / (n - 1.0);
  return readings * between <= kMaxRatio * within;
}

/// True if the mean speed is 0 within its error, or slower than any vehicle of this length drives.
bool is_about_zero(const std::vector<WindowMoments>& windows, double length_m) {
  // Froude number u/sqrt(g length) below which no vehicle drives; u: speed, g: gravity.
  constexpr double kFroude = 0.005;
  double sum = 0.0, count = 0.0, variance = 0.0;
  for (const WindowMoments& w : windows) {
    sum += w.mean * w.count;
    count += w.count;
    variance += w.variance / static_cast<double>(windows.size());
  }
  return std::abs(sum / count) <=
         std::max(5.0 * std::sqrt(variance / count), kFroude * std::sqrt(kGravity_mps2 * length_m));
}

}  // namespace

std::optional<Contradiction> rest_contradiction(const Evidence& evidence) {
  constexpr std::size_t kMinWindows = 5;
  bool shows_motion = false;  // true: the log has a speed or a position
  std::string column;
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kX, LogChannel::kY,
                                   LogChannel::kHeading, LogChannel::kYawRate}) {
    if (!evidence.has(channel)) continue;
    const std::vector<WindowMoments> windows = moments_of(evidence.log, channel);
    if (windows.size() < kMinWindows || !is_noise_alone(windows)) return std::nullopt;
    const bool is_speed = channel == LogChannel::kSpeed;
    if (is_speed && !is_about_zero(windows, evidence.vehicle.length_m)) return std::nullopt;
    shows_motion |= is_speed || channel == LogChannel::kX || channel == LogChannel::kY;
    if (column.empty()) column = info(channel).column;
  }
  if (!shows_motion) return std::nullopt;
  return Contradiction{column, "the vehicle never moves: every channel is noise about one value",
                       "", "record a log in which the vehicle drives"};
}

}  // namespace awmr
