/// Driving logs: commands and whatever was measured, by time. read_log() in read_trials.h reads them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/trials.h"

namespace awmr {

/// The quantities that a log may have measured: those of State.
enum class LogChannel { kX, kY, kHeading, kSpeed, kSway, kYawRate, kSteering };
inline constexpr std::size_t kChannelCount = 7;
inline constexpr std::array<LogChannel, kChannelCount> kChannels{
    LogChannel::kX,    LogChannel::kY,       LogChannel::kHeading, LogChannel::kSpeed,
    LogChannel::kSway, LogChannel::kYawRate, LogChannel::kSteering};

/// How a channel is called and converted.
struct ChannelInfo {
  std::string_view column;  ///< as in the CSV: "heading_deg"
  std::string_view name;    ///< in SI: "heading_rad"
  std::string_view unit;    ///< of the SI value: "rad"
  double to_si = 1.0;       ///< the SI value is the column's times this
};
const ChannelInfo& info(LogChannel channel);

/// A measured channel. A sensor slower than the log repeats its last value: only the row where a
/// value is new counts as measured. Of a coarse one every row counts. Readings that jump away and
/// back, that are stuck or at the end of the sensor's range do not: see channel_quality.h.
struct Measured {
  std::vector<double> value;  ///< by row, SI; heading unwrapped
  std::vector<bool> fresh;    ///< by row
  int fresh_count = 0;        ///< rows that count as measured
  bool held = false;          ///< slower than the log: repeats were found and set aside
  double quantum = 0.0;       ///< step of a coarse sensor, SI; 0: none was found
};

/// One log. Every vector has an entry for each row.
struct DrivingLog {
  std::string file;
  std::vector<int> line;            ///< of the file
  std::vector<std::size_t> mapped;  ///< indices of the TrialOptions' mappings that were used
  bool joined = false;              ///< of signals with times of their own: rows are uneven
  std::vector<double> t_s;          ///< s, strictly rising
  std::vector<double> force_left;   ///< F'L of each left wheel, over F_max, forward positive
  std::vector<double> force_right;  ///< F'R of each right wheel, over F_max, forward positive
  /// d_ro, rad, left positive: the servo's command. Absent where only its angle was logged, which
  /// then drives the model.
  std::optional<std::vector<double>> steering_command_rad;
  std::array<std::optional<Measured>, kChannelCount> measured;

  std::size_t rows() const { return t_s.size(); }
  const std::optional<Measured>& operator[](LogChannel c) const {
    return measured[static_cast<std::size_t>(c)];
  }
  std::optional<Measured>& operator[](LogChannel c) {
    return measured[static_cast<std::size_t>(c)];
  }
  /// The step between rows; of a joined log that which half of its time is made of.
  double median_step_s() const;
  /// d_r that drives the model, rad, left positive: the servo's command, or its angle where only
  /// that was logged.
  const std::vector<double>& driving_steering_rad() const;
  /// The column that it came from.
  std::string_view steering_column() const {
    return steering_command_rad ? "steering_cmd_deg" : "steering_deg";
  }
};

/// Rows further apart than this many median steps are a gap: what was commanded between is unknown.
inline constexpr double kGapSteps = 10.0;

}  // namespace awmr
