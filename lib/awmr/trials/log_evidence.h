/// What the windows of a log say of each signal, for the checks of its units and signs. Private to
/// this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/log_consistency.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Windows of this length average the noise out and still turn by less than a circle.
inline constexpr double kEvidenceWindow_s = 1.0;

/// What one window says of each signal; sums over the window, so that noise averages out.
struct EvidenceWindow {
  double turned_rad = 0.0;       ///< change of heading
  double rate_rad = 0.0;         ///< integral of the yaw rate
  double moved_m = 0.0;          ///< distance between the first and the last position
  double course_rad = 0.0;       ///< its direction
  double heading_rad = 0.0;      ///< in the middle
  double driven_m = 0.0;         ///< integral of the speed
  bool has_stuck_speed = false;  ///< every reading of the speed is the same, and not 0
  double thrust = 0.0;           ///< mean of F'L + F'R
  double steering_rad = 0.0;     ///< mean command
  double tau_steering_m = 0.0;   ///< l_f (F'L + F'R) sin d_r, as in allocation.h
  double tau_diff_m = 0.0;       ///< d (F'R - F'L)(cos d_r + 1), as in allocation.h
  double span_s = 0.0;
};

/// The log with its windows and the mappings it was read with: what every comparison needs.
struct Evidence {
  const DrivingLog& log;
  const Vehicle& vehicle;
  std::span<const ColumnMapping> mappings;
  std::vector<EvidenceWindow> windows;  ///< side by side
  /// For medians, which need twenty: those of a shorter log overlap by two thirds, so that ten
  /// seconds are enough to tell a wrong unit.
  std::vector<EvidenceWindow> overlapping;

  bool has(LogChannel channel) const { return log[channel].has_value(); }
};

/// The windows are a second long, so that noise averages out.
Evidence evidence_of(const DrivingLog& log, const Vehicle& vehicle,
                     std::span<const ColumnMapping> mappings);

/// Windows of about this length side by side, each between readings.
std::vector<LogWindow> evidence_rows(const DrivingLog& log, double length_s);

/// The integral of a channel over a window, by trapezoids.
double integral_of(const DrivingLog& log, LogChannel channel, const LogWindow& window);

/// One number of every window.
template <class Member>
std::vector<double> series(const std::vector<EvidenceWindow>& windows, Member member) {
  std::vector<double> values;
  values.reserve(windows.size());
  for (const EvidenceWindow& w : windows) values.push_back(member(w));
  return values;
}

/// The partial regression of a rate on the two moments; 0 where a moment's share is not shown.
struct MomentShares {
  double steering = 0.0;
  double sides = 0.0;
};

MomentShares moment_shares(const std::vector<EvidenceWindow>& windows,
                           double (*rate)(const EvidenceWindow&));

/// `NAME="SOURCE"*FACTOR+OFFSET`, from the column that NAME was read from.
std::string scaled_mapping(std::span<const ColumnMapping> mappings, std::string_view column,
                           double factor, double offset = 0.0);
std::string scaled_mapping(const Evidence& evidence, std::string_view column, double factor,
                           double offset = 0.0);
/// The two forces, each from the other's column.
std::string swapped_mapping(const Evidence& evidence);

/// A vehicle that never moves: then no channel can be compared with another.
std::optional<Contradiction> rest_contradiction(const Evidence& evidence);
/// Units: time, forces, steering angle, yaw rate against heading, speed against positions.
std::vector<Contradiction> unit_contradictions(const Evidence& evidence);
/// Positions, or without them the heading, that go on elsewhere from one reading to the next.
std::optional<Contradiction> jump_contradiction(const Evidence& evidence);
/// Signs and sides: steering, forces, yaw rate, heading, y, direction of motion.
std::vector<Contradiction> sign_contradictions(const Evidence& evidence);

}  // namespace awmr
