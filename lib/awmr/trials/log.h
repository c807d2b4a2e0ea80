/// Driving logs: commands and measurements by time. read_log() in read_trials.h reads them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/trials.h"

namespace awmr {

/// Quantities that a log may contain. They are the components of State (model/state.h), with its
/// units and signs; kSway is the lateral speed v.
enum class LogChannel { kX, kY, kHeading, kSpeed, kSway, kYawRate, kSteering };
inline constexpr std::size_t kChannelCount = 7;
inline constexpr std::array<LogChannel, kChannelCount> kChannels{
    LogChannel::kX,    LogChannel::kY,       LogChannel::kHeading, LogChannel::kSpeed,
    LogChannel::kSway, LogChannel::kYawRate, LogChannel::kSteering};

/// Names and units of a channel.
struct ChannelInfo {
  std::string_view column;  ///< name of the column in CSV files: "heading_deg"
  std::string_view name;    ///< name with the SI unit: "heading_rad"
  std::string_view unit;    ///< unit of the SI value: "rad"
  double to_si = 1.0;       ///< SI value = value in the column times `to_si`
};
const ChannelInfo& info(LogChannel channel);

/// A measured channel. A row is "fresh" if its value is a measurement. A sensor that is slower than
/// the log repeats its last value until its next reading; these repetitions are not fresh. A sensor
/// with coarse resolution is fresh in every row. Spikes, stuck and saturated values are not fresh
/// (channel_quality.h).
struct Measured {
  std::vector<double> value;  ///< one value per row, SI; the heading has no jumps by full turns
  std::vector<bool> fresh;    ///< for each row: true if the value is a measurement
  int fresh_count = 0;        ///< number of fresh rows
  /// True: the sensor is slower than the log, which repeats its last value.
  bool held = false;
  double quantum = 0.0;  ///< resolution of a coarse sensor, SI; 0: not detected
};

/// Rows [begin, end).
struct RowSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// One run of a driving log. Every vector has one entry per row.
struct DrivingLog {
  std::string file;
  int number = 1;         ///< position of its file among the log files, from 1
  std::vector<int> line;  ///< by row: line in the file
  /// Column mappings that were used: indices in TrialOptions::columns.
  std::vector<std::size_t> mapped;
  /// True: joined from signals of different rates; time steps are unequal.
  bool joined = false;
  /// True: rows were inserted between the rows of the file. Their commands are interpolated, and
  /// they have no measurements.
  bool has_interpolated_commands = false;
  /// True: commands are set-points, each constant until the next set-point. They replace commands
  /// that the logger had interpolated.
  bool has_held_set_points = false;
  /// By row: standard deviation, s, of the time at which the commands changed to those of the row.
  /// A log shows commands only at its rows, so this time can be uncertain. 0: the time is known.
  /// Empty: all times are known.
  std::vector<double> change_std_s = {};
  /// True: x (east) and y (north) were computed from latitude and longitude.
  bool is_geographic = false;
  std::vector<double> t_s;          ///< time, s, strictly rising
  std::vector<double> force_left;   ///< F'L of each left wheel, over F_max, forward positive
  std::vector<double> force_right;  ///< F'R of each right wheel, over F_max, forward positive
  /// d_ro, command of the steering servo, rad, left positive. Absent if the log has only the
  /// steering angle d_r, which is then the steering input of the model.
  std::optional<std::vector<double>> steering_command_rad;
  std::array<std::optional<Measured>, kChannelCount> measured;

  std::size_t rows() const { return t_s.size(); }
  const std::optional<Measured>& operator[](LogChannel c) const {
    return measured[static_cast<std::size_t>(c)];
  }
  std::optional<Measured>& operator[](LogChannel c) {
    return measured[static_cast<std::size_t>(c)];
  }
  /// Median time step between rows, s. In a joined log each step is weighted with its length.
  double median_step_s() const;
  /// Steering input of the model, rad, left positive: the servo's command d_ro, or its angle d_r if
  /// only that was logged.
  const std::vector<double>& driving_steering_rad() const;
  /// Name of the column from which the steering input was read.
  std::string_view steering_column() const {
    return steering_command_rad ? "steering_cmd_deg" : "steering_deg";
  }
};

/// True if the commanded left and right forces differ by more than 1 % of F_max in any row.
bool has_force_difference(const DrivingLog& log);

/// True if the largest and the smallest steering input (command or angle) of the log differ by more
/// than 1 mrad.
bool has_steering_changes(const DrivingLog& log);

/// A time step of more than this many median time steps is a gap. The commands during a gap are
/// unknown, so no simulation of the log crosses the gap.
inline constexpr double kGapSteps = 10.0;

}  // namespace awmr
