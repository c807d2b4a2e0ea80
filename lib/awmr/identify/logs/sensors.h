/// Sensor models of a log fit: latency, filter, symmetric smoothing, wheel slip and bias, with
/// derivatives. Private to identify/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "awmr/identify/logs/smoothed_channel.h"
#include "awmr/identify/logs/wheel_slip.h"

namespace awmr {

/// Errors of the sensors at one point of the search, one per channel, with their columns.
struct SensorTerms {
  std::array<double, kChannelCount> bias{};
  std::array<std::optional<std::size_t>, kChannelCount> bias_column{};
  std::array<std::optional<DelayColumn>, kChannelCount> delay{};
  std::array<std::optional<SensorFilter>, kChannelCount> lag{};
  std::array<std::optional<OffsetColumn>, kChannelCount> smoothing{};  ///< s of smoothing_of(), s^2
  std::vector<WheelSlip> slips;
  std::optional<OffsetColumn> sway_offset;
  std::optional<OffsetColumn> sway_angle;

  /// True if a sensor reads the motion at other times than that of its row.
  bool reads_other_times() const;
  /// True if a sensor reads the motion also after the time of its row.
  bool reads_later() const;
};

/// One of the times that make up a reading, with its weight. The derivatives are by s of
/// smoothing_of().
struct ReadingTime {
  double t_s;
  double weight = 1.0;
  double weight_by = 0.0;  ///< 1/s^2
  double time_by = 0.0;    ///< 1/s
};

/// The times at which a sensor with latency, smoothing or both reads the motion for a row at t.
/// `row_spacing_s`: of the logs.
std::vector<ReadingTime> reading_times(const SensorTerms& terms, LogChannel channel, double t_s,
                                       double row_spacing_s);

/// Readings of the sensors at the motion of one time, without latency, filter, smoothing and bias.
class Sensors {
 public:
  /// All arguments must outlive the object. `columns`: number of derivatives.
  Sensors(const LogSignals& signals, const SensorTerms& terms, const CommandPath& path,
          const Plant<double>& plant, const std::vector<ParameterColumn>& parameters,
          std::size_t columns);
  /// Returns the reading at the time t of the motion. row() then has its derivatives.
  double read(LogChannel c, const LinearMotion& motion, double t_s);
  const std::vector<double>& row() const { return row_; }

 private:
  double sway(const LinearMotion& motion);

  const LogSignals& signals_;
  const SensorTerms& terms_;
  const CommandPath& path_;
  SlippingWheels wheels_;
  std::vector<double> row_;
};

}  // namespace awmr
