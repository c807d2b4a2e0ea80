#include "awmr/trials/checks/log_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/rest_limits.h"

namespace awmr {
namespace {

/// Assumed time from a command to the vehicle's response.
constexpr double kResponse_s = 0.2;
/// Adds the means of the commands to `sums`. The vehicle responds in the window to commands that
/// were logged kResponse_s earlier. If the log has the steering angle instead of the steering
/// command, uses the commands in the window itself.
void add_commands(const DrivingLog& log, const Vehicle& vehicle, const LogWindow& window,
                  EvidenceWindow& sums) {
  const double delay_s = log.steering_command_rad ? kResponse_s : 0.0;
  const auto row_at = [&](double t_s) {
    const auto at = std::lower_bound(log.t_s.begin(), log.t_s.end(), t_s - delay_s);
    return std::min(log.rows() - 1, static_cast<std::size_t>(at - log.t_s.begin()));
  };
  const std::size_t begin = row_at(log.t_s[window.begin]);
  const std::size_t end = std::max(begin + 1, row_at(log.t_s[window.end - 1]) + 1);
  const std::vector<double>& steering = log.driving_steering_rad();
  const double n = static_cast<double>(end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    const double both = log.force_left[i] + log.force_right[i];
    const double apart = log.force_right[i] - log.force_left[i];
    sums.thrust += both / n;
    sums.steering_rad += steering[i] / n;
    sums.tau_steering_m += vehicle.front_axle_m * both * std::sin(steering[i]) / n;
    sums.tau_diff_m += vehicle.half_track_m * apart * (std::cos(steering[i]) + 1.0) / n;
  }
}

EvidenceWindow sums_of(const DrivingLog& log, const Vehicle& vehicle,
                       const std::vector<double>& headings, const LogWindow& window) {
  EvidenceWindow sums;
  const std::size_t last = window.end - 1;
  sums.span_s = log.t_s[last] - log.t_s[window.begin];
  if (!headings.empty()) {
    sums.turned_rad = headings[last] - headings[window.begin];
    sums.heading_rad = headings[(window.begin + last) / 2];
  }
  if (log[LogChannel::kYawRate]) sums.rate_rad = integral_of(log, LogChannel::kYawRate, window);
  if (log[LogChannel::kX] && log[LogChannel::kY]) {
    const double dx = log[LogChannel::kX]->value[last] - log[LogChannel::kX]->value[window.begin];
    const double dy = log[LogChannel::kY]->value[last] - log[LogChannel::kY]->value[window.begin];
    sums.moved_m = std::hypot(dx, dy);
    sums.course_rad = std::atan2(dy, dx);
  }
  if (const auto& speed = log[LogChannel::kSpeed]) {
    sums.driven_m = integral_of(log, LogChannel::kSpeed, window);
    const auto [least, most] = std::ranges::minmax(
        std::span(speed->value).subspan(window.begin, window.end - window.begin));
    sums.has_stuck_speed = !(least < most) && !is_rest(least, kRestSpeed_mps);
    // If the vehicle drives backward, the course is reversed so that it can be compared with the
    // heading.
    if (sums.driven_m < 0.0) sums.course_rad += pi<double>();
  }
  add_commands(log, vehicle, window, sums);
  return sums;
}

/// True if position and heading of a row are new readings, not values repeated from an earlier row.
bool has_readings(const DrivingLog& log, std::size_t row) {
  return std::ranges::all_of(
      std::array{LogChannel::kX, LogChannel::kY, LogChannel::kHeading}, [&](LogChannel channel) {
        return !log[channel] || !log[channel]->held || log[channel]->fresh[row];
      });
}

/// Moves the ends of the windows to rows with new readings, because the sensor measured a repeated
/// value before the time of its row. An end moves forward into the next window, or back if no new
/// reading follows there. Drops a window that loses more than half its rows.
std::vector<LogWindow> between_readings(const std::vector<LogWindow>& windows) {
  std::vector<LogWindow> moved;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto& [log, begin, end] = windows[i];
    const bool goes_on = i + 1 < windows.size() && windows[i + 1].begin == end;
    const std::size_t limit = goes_on ? windows[i + 1].end : end;
    std::size_t first = begin;
    while (first < end && !has_readings(*log, first)) ++first;
    std::size_t last = end - 1;
    while (last < limit && !has_readings(*log, last)) ++last;
    if (last == limit) {
      last = end - 1;
      while (last > first && !has_readings(*log, last)) --last;
    }
    if (2 * (last - std::min(first, last)) >= end - begin) moved.push_back({log, first, last + 1});
  }
  return moved;
}

/// Returns overlapping windows: each window that has a successor, shifted forward by a third and by
/// two thirds of its length. Empty if there are twenty windows or more, which suffice without them.
std::vector<LogWindow> windows_between(const std::vector<LogWindow>& windows) {
  constexpr std::size_t kEnough = 20;
  constexpr std::size_t kParts = 3;
  std::vector<LogWindow> between;
  if (windows.size() >= kEnough) return between;
  for (std::size_t i = 1; i < windows.size(); ++i) {
    const auto& [log, begin, middle] = windows[i - 1];
    if (windows[i].begin != middle) continue;
    for (std::size_t part = 1; part < kParts; ++part) {
      between.push_back({log, begin + (middle - begin) * part / kParts,
                         middle + (windows[i].end - middle) * part / kParts});
    }
  }
  return between;
}

}  // namespace

DrivingLog with_interpolated_values(const DrivingLog& log) {
  DrivingLog result = log;
  for (const LogChannel channel : kChannels) {
    if (!result[channel]) continue;
    const std::vector<bool>& fresh = result[channel]->fresh;
    std::vector<double>& value = result[channel]->value;
    std::optional<std::size_t> last;
    for (std::size_t next = 0; next < value.size(); ++next) {
      if (!fresh[next]) continue;
      for (std::size_t i = last.value_or(next) + 1; i < next; ++i) {
        const double share = (log.t_s[i] - log.t_s[*last]) / (log.t_s[next] - log.t_s[*last]);
        value[i] = std::lerp(value[*last], value[next], share);
      }
      last = next;
    }
  }
  return result;
}

double integral_of(const DrivingLog& log, LogChannel channel, const LogWindow& window) {
  const std::vector<double>& value = log[channel]->value;
  double sum = 0.0;
  for (std::size_t i = window.begin; i + 1 < window.end; ++i) {
    sum += 0.5 * (value[i] + value[i + 1]) * (log.t_s[i + 1] - log.t_s[i]);
  }
  return sum;
}

std::vector<double> integrated_rate(const DrivingLog& log) {
  const std::vector<double>& rate = log[LogChannel::kYawRate]->value;
  std::vector<double> psi(log.rows(), 0.0);
  for (std::size_t i = 1; i < log.rows(); ++i) {
    psi[i] = psi[i - 1] + 0.5 * (rate[i - 1] + rate[i]) * (log.t_s[i] - log.t_s[i - 1]);
  }
  return psi;
}

std::vector<double> headings_of(const DrivingLog& log) {
  if (const auto& heading = log[LogChannel::kHeading]) return heading->value;
  return log[LogChannel::kYawRate] ? integrated_rate(log) : std::vector<double>();
}

std::vector<LogWindow> evidence_rows(const DrivingLog& log, double length_s) {
  return between_readings(windows_of(log, length_s));
}

Evidence evidence_of(const DrivingLog& log, const Vehicle& vehicle,
                     std::span<const ColumnMapping> mappings) {
  Evidence evidence{log, vehicle, mappings, {}, {}};
  const std::vector<double> headings = headings_of(log);
  const std::vector<LogWindow> windows = windows_of(log, kEvidenceWindow_s);
  for (const LogWindow& window : between_readings(windows)) {
    evidence.windows.push_back(sums_of(log, vehicle, headings, window));
  }
  evidence.overlapping = evidence.windows;
  for (const LogWindow& window : between_readings(windows_between(windows))) {
    evidence.overlapping.push_back(sums_of(log, vehicle, headings, window));
  }
  return evidence;
}

std::optional<double> robust_ratio(std::span<const double> x, std::span<const double> y) {
  constexpr int kMinPairs = 10;
  constexpr double kLargestSpread = 0.6;
  // Skips pairs (x, y) with a smaller |x|, because the vehicle is then at rest.
  constexpr double kSmallest = 1e-9;
  std::vector<double> sizes;
  for (const double value : x) sizes.push_back(std::abs(value));
  if (sizes.empty()) return std::nullopt;
  const double half = median(sizes);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (sizes[i] >= half && sizes[i] > kSmallest) ratios.push_back(y[i] / x[i]);
  }
  if (static_cast<int>(ratios.size()) < kMinPairs) return std::nullopt;
  const double ratio = median(ratios);
  const double spread = median_absolute_deviation(ratios, ratio) / std::abs(ratio);
  if (!std::isfinite(spread) || spread > kLargestSpread) return std::nullopt;
  return ratio;
}

namespace {

/// Sums of products over the windows: s, d: the moments tau_steering and tau_diff, m; r: the mean
/// yaw rate, rad/s.
struct MomentSums {
  double ss = 0.0, sd = 0.0, dd = 0.0, sr = 0.0, dr = 0.0, rr = 0.0;
};

MomentSums moment_sums(const std::vector<EvidenceWindow>& windows,
                       double (*rate)(const EvidenceWindow&)) {
  MomentSums sums;
  for (const EvidenceWindow& w : windows) {
    const double y = rate(w) / w.span_s;
    sums.ss += w.tau_steering_m * w.tau_steering_m;
    sums.sd += w.tau_steering_m * w.tau_diff_m;
    sums.dd += w.tau_diff_m * w.tau_diff_m;
    sums.sr += w.tau_steering_m * y;
    sums.dr += w.tau_diff_m * y;
    sums.rr += y * y;
  }
  return sums;
}

}  // namespace

MomentShares moment_shares(const std::vector<EvidenceWindow>& windows,
                           double (*rate)(const EvidenceWindow&)) {
  const MomentSums sums = moment_sums(windows, rate);
  const auto [ss, sd, dd, sr, dr, rr] = sums;
  const double n = static_cast<double>(windows.size());
  const double determinant = ss * dd - sd * sd;
  const bool steering_only = dd < 1e-6 * ss;
  const bool sides_only = ss < 1e-6 * dd;
  // The effects of steering and of force difference can be separated only if their moments are not
  // proportional. They are proportional if a controller uses both at once. Above a correlation of
  // 0.9, a joint fit would mainly fit the effect of the inertia, which this regression neglects.
  const bool apart = determinant > 0.19 * ss * dd && !steering_only && !sides_only;
  if (n < 10.0 || rr <= 0.0) return {};
  constexpr double kSignificant = 5.0;  // smallest significant coefficient, in standard errors
  const auto shown = [&](double coefficient, double variance_factor, double explained) {
    const double noise = std::max(0.0, sums.rr - explained) / std::max(1.0, n - 2.0);
    return std::abs(coefficient) > kSignificant * std::sqrt(noise * variance_factor) ? coefficient
                                                                                     : 0.0;
  };
  if (steering_only) return {shown(sr / ss, 1.0 / ss, sr * sr / ss), 0};
  if (sides_only) return {0.0, shown(dr / dd, 1.0 / dd, dr * dr / dd)};
  if (!apart) {
    // If both moments had nearly equal size and truly opposite signs, the vehicle would not turn.
    // As it does turn, the moment that opposes the yaw rate has the wrong sign.
    constexpr double kNearlyEqual = 4.0;  // bound on the ratio of the squares of the two moments
    const bool cancel = sd < 0.0 && ss < kNearlyEqual * dd && dd < kNearlyEqual * ss;
    if (sd < 0.0 && !cancel) return {};
    return {shown(sr / ss, 1.0 / ss, sr * sr / ss), shown(dr / dd, 1.0 / dd, dr * dr / dd)};
  }
  const double bs = (sr * dd - dr * sd) / determinant;
  const double bd = (dr * ss - sr * sd) / determinant;
  const double explained = bs * sr + bd * dr;
  return {shown(bs, dd / determinant, explained), shown(bd, ss / determinant, explained)};
}

namespace {

/// Formula for `--column`: the file's column from which `column` was read, times a factor, plus an
/// offset.
std::string scaled_source(std::span<const ColumnMapping> mappings, std::string_view column,
                          double factor, double offset) {
  ColumnMapping used{std::string(column), std::string(column)};
  for (const ColumnMapping& mapping : mappings) {
    if (mapping.name == column) used = mapping;
  }
  return scaled_expression(used, factor, offset);
}

}  // namespace

std::string scaled_mapping(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset) {
  return fmt::format("{}={}", column, scaled_source(mappings, column, factor, offset));
}

std::string scaled_mapping(const Evidence& evidence, std::string_view column, double factor,
                           double offset) {
  return scaled_mapping(evidence.mappings, column, factor, offset);
}

std::string mapping_option(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset) {
  return option_text("column '" + scaled_mapping(mappings, column, factor, offset) + "'");
}

std::array<std::string, 2> swapped_mappings(const Evidence& evidence) {
  return {"force_left=" + scaled_source(evidence.mappings, "force_right", 1.0, 0.0),
          "force_right=" + scaled_source(evidence.mappings, "force_left", 1.0, 0.0)};
}

}  // namespace awmr
