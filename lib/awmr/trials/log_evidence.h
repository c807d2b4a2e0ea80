/// Per-window sums of a log's signals, for the checks of units and signs. Private to this folder.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/log_consistency.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Window length: long enough to average the noise, short enough to turn by less than a circle.
inline constexpr double kEvidenceWindow_s = 1.0;

/// Sums of the signals over one window, in which noise averages out.
struct EvidenceWindow {
  double turned_rad = 0.0;   ///< change of heading; without one, of the integrated yaw rate
  double rate_rad = 0.0;     ///< integral of the yaw rate
  double moved_m = 0.0;      ///< distance between first and last position
  double course_rad = 0.0;   ///< its direction; of a vehicle that drives backwards, the opposite
  double heading_rad = 0.0;  ///< in the middle of the window, as turned_rad
  double driven_m = 0.0;     ///< integral of the speed
  bool has_stuck_speed = false;  ///< all readings of the speed are the same and not 0
  double thrust = 0.0;           ///< mean of F'L + F'R
  double steering_rad = 0.0;     ///< mean command
  double tau_steering_m = 0.0;   ///< l_f (F'L + F'R) sin d_r, as in allocation.h
  double tau_diff_m = 0.0;       ///< d (F'R - F'L)(cos d_r + 1), as in allocation.h
  double span_s = 0.0;
};

/// A log with its windows and the mappings with which it was read: the input of every comparison.
struct Evidence {
  const DrivingLog& log;
  const Vehicle& vehicle;
  std::span<const ColumnMapping> mappings;
  std::vector<EvidenceWindow> windows;  ///< consecutive, without overlap
  /// Windows for medians, which need twenty. In a shorter log they overlap by two thirds, so that
  /// ten seconds suffice to detect a wrong unit.
  std::vector<EvidenceWindow> overlapping;

  bool has(LogChannel channel) const { return log[channel].has_value(); }
};

/// Builds windows of kEvidenceWindow_s.
Evidence evidence_of(const DrivingLog& log, const Vehicle& vehicle,
                     std::span<const ColumnMapping> mappings);

/// Consecutive windows of about this length, each beginning and ending with a reading.
std::vector<LogWindow> evidence_rows(const DrivingLog& log, double length_s);

/// The integral of a channel over a window, by trapezoids.
double integral_of(const DrivingLog& log, LogChannel channel, const LogWindow& window);

/// Returns one field of every window.
template <class Member>
std::vector<double> series(const std::vector<EvidenceWindow>& windows, Member member) {
  std::vector<double> values;
  values.reserve(windows.size());
  for (const EvidenceWindow& w : windows) values.push_back(member(w));
  return values;
}

/// Partial regression of a rate on the two moments; 0 for a moment without significant share.
struct MomentShares {
  double steering = 0.0;
  double sides = 0.0;
};

MomentShares moment_shares(const std::vector<EvidenceWindow>& windows,
                           double (*rate)(const EvidenceWindow&));

/// `NAME="SOURCE"*FACTOR+OFFSET`, where SOURCE is the column from which NAME was read.
std::string scaled_mapping(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset = 0.0);
std::string scaled_mapping(const Evidence& evidence, std::string_view column, double factor,
                           double offset = 0.0);
/// The two mappings that swap the force columns.
std::array<std::string, 2> swapped_mappings(const Evidence& evidence);

/// Detects a vehicle that never moves, for which channels cannot be compared.
std::optional<Contradiction> rest_contradiction(const Evidence& evidence);
/// Units: time, forces, steering angle, yaw rate against heading, speed against positions.
std::vector<Contradiction> unit_contradictions(const Evidence& evidence);
/// Detects a jump of the position, or without it of the heading, to another place.
std::optional<Contradiction> jump_contradiction(const Evidence& evidence);
/// Checks signs and sides: steering, forces, yaw rate, heading, y, direction of motion.
std::vector<Contradiction> sign_contradictions(const Evidence& evidence);

}  // namespace awmr
