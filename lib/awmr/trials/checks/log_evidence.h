/// Integrals and means of a log's signals over windows of one second. The checks of units and signs
/// compare them. Private to trials/.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/checks/log_consistency.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Window length, s. It is long enough to average the noise, and short enough that the vehicle
/// turns by less than a full circle in it.
inline constexpr double kEvidenceWindow_s = 1.0;

/// Signals of a log over one window; 0 for channels that the log lacks. Headings, courses and yaw
/// rates are positive counter-clockwise, steering angles to the left.
struct EvidenceWindow {
  double turned_rad = 0.0;   ///< change of heading; without a heading, the integral of the yaw rate
  double rate_rad = 0.0;     ///< integral of the yaw rate
  double moved_m = 0.0;      ///< distance between first and last position
  double course_rad = 0.0;   ///< direction from first to last position, reversed if driven_m < 0
  double heading_rad = 0.0;  ///< heading (or integrated yaw rate) in the middle of the window
  double driven_m = 0.0;     ///< integral of the speed, forward positive
  bool has_stuck_speed = false;  ///< true: all speeds in the window are the same and not 0
  double thrust = 0.0;           ///< mean of F'L + F'R, forward positive
  double steering_rad = 0.0;     ///< mean steering input: the command, else the logged angle
  double tau_steering_m = 0.0;   ///< l_f (F'L + F'R) sin d_r, d_r = steering_rad
  double tau_diff_m = 0.0;       ///< d (F'R - F'L)(cos d_r + 1), d = half_track_m
  double span_s = 0.0;           ///< length of the window, s
};

/// Input of the checks of a log: the log, its vehicle and its windows.
struct Evidence {
  const DrivingLog& log;
  const Vehicle& vehicle;
  std::span<const ColumnMapping> mappings;  ///< column mappings used to read the log
  std::vector<EvidenceWindow> windows;      ///< consecutive windows without overlap
  /// Windows for robust_ratio(), which needs twenty windows. If `windows` has fewer, this list also
  /// has windows shifted by thirds of their length. A log of ten seconds then suffices to detect a
  /// wrong unit.
  std::vector<EvidenceWindow> overlapping;

  bool has(LogChannel channel) const { return log[channel].has_value(); }
};

/// Divides a log into windows of kEvidenceWindow_s and computes their sums.
Evidence evidence_of(const DrivingLog& log, const Vehicle& vehicle,
                     std::span<const ColumnMapping> mappings);

/// Divides the log into consecutive windows of about `length_s`. Each begins and ends at a row with
/// a new reading.
std::vector<LogWindow> evidence_rows(const DrivingLog& log, double length_s);

/// Returns the log with the values between the measurements of each channel interpolated linearly.
/// A log repeats the last value of a slow sensor until the next one, on average half a sample
/// interval late. This latency differs between the channels and between the ends of a window, so
/// it would look like a bias or a wrong scale.
DrivingLog with_interpolated_values(const DrivingLog& log);

/// The integral of a channel over a window (trapezoidal rule).
double integral_of(const DrivingLog& log, LogChannel channel, const LogWindow& window);

/// By row: the integral of the yaw rate from the first row on, rad. Precondition: the log has a yaw
/// rate.
std::vector<double> integrated_rate(const DrivingLog& log);
/// Heading of each row, rad; without a heading, integrated_rate(). Empty without heading and yaw
/// rate.
std::vector<double> headings_of(const DrivingLog& log);

template <class Member>
std::vector<double> series(const std::vector<EvidenceWindow>& windows, Member member) {
  std::vector<double> values;
  values.reserve(windows.size());
  for (const EvidenceWindow& w : windows) values.push_back(member(w));
  return values;
}

/// Ratio y/x of two signals that are proportional: the median of y/x over the half of the pairs
/// (x, y) with the larger |x|, so that about 10 % outliers do no harm. Empty if this half has fewer
/// than 10 pairs, or if the median absolute deviation of y/x from the median exceeds 60 % of it.
std::optional<double> robust_ratio(std::span<const double> x, std::span<const double> y);

/// Coefficients of a linear regression of the yaw rate on the yaw moments tau_steering (of the
/// steering) and tau_diff (of the force difference), as in EvidenceWindow:
///     yaw rate = steering * tau_steering + sides * tau_diff
/// A coefficient whose magnitude is below five standard errors is 0. If there are fewer than 10
/// windows, both coefficients are 0. If the moments are so correlated that a joint fit cannot
/// separate their effects, each coefficient comes from a fit of its own.
struct MomentShares {
  double steering = 0.0;  ///< 1/(m s)
  double sides = 0.0;     ///< 1/(m s)
};

/// Computes MomentShares. `rate(window)`: change of heading or integral of the yaw rate over the
/// window, rad.
MomentShares moment_shares(const std::vector<EvidenceWindow>& windows,
                           double (*rate)(const EvidenceWindow&));

/// Text of the mapping `NAME="SOURCE"*FACTOR+OFFSET` for `--column`. NAME is `column`, SOURCE the
/// file's column from which it was read.
std::string scaled_mapping(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset = 0.0);
std::string scaled_mapping(const Evidence& evidence, std::string_view column, double factor,
                           double offset = 0.0);
/// The option `--column` with this mapping, for messages.
std::string mapping_option(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset = 0.0);
std::array<std::string, 2> swapped_mappings(const Evidence& evidence);

/// A unit that a column may have by mistake.
struct UnitFactor {
  double factor;  ///< ratio of the two compared quantities if the column has this unit
  std::string_view words;
};

/// Detects a log in which the vehicle never moves, so that its channels cannot be compared.
std::optional<Contradiction> rest_contradiction(const Evidence& evidence);
/// Checks the units of time, forces, steering angle, yaw rate and speed.
std::vector<Contradiction> unit_contradictions(const Evidence& evidence);
/// Compares yaw rate with heading, and speed with positions. If the log has no heading or no
/// positions, detects yaw rates and speeds that no wheeled vehicle reaches.
std::vector<Contradiction> motion_unit_contradictions(const Evidence& evidence);
/// Detects a jump of the position or of the heading, as at the seam of two runs in one file.
std::optional<Contradiction> jump_contradiction(const Evidence& evidence);
/// Checks the signs of steering, forces, yaw rate, heading, y and speed, and whether left and right
/// forces are swapped.
std::vector<Contradiction> sign_contradictions(const Evidence& evidence);

}  // namespace awmr
