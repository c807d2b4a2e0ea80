/// Sensor models of a log fit, with derivatives: latency, filter, symmetric smoothing, wheel slip,
/// scale error, mounting of the sway sensor, and bias. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/identify/logs/filtered_channel.h"
#include "awmr/identify/logs/smoothing_kernel.h"
#include "awmr/identify/logs/wheel_slip.h"

namespace awmr {

/// Symmetric smoothing of a channel over the rows of the log.
struct Smoothing {
  SmoothingKernel kernel;
  std::size_t column;   ///< column of the variance of the kernel, s^2
  double rows2_per_s2;  ///< variance of the kernel in rows^2 over that in s^2
};

/// Errors of the sensors at one point of the search, with the columns of the derivatives with
/// respect to them.
struct SensorTerms {
  std::array<double, kChannelCount> bias{};
  std::array<std::optional<std::size_t>, kChannelCount> bias_column{};
  std::array<std::optional<DelayColumn>, kChannelCount> delay{};
  std::array<std::optional<SensorFilter>, kChannelCount> lag{};
  std::array<std::optional<Smoothing>, kChannelCount> smoothing{};
  std::array<std::optional<OffsetColumn>, kChannelCount> scale{};
  std::vector<WheelSlip> slips;
  std::optional<OffsetColumn> sway_offset;
  std::optional<OffsetColumn> sway_angle;

  bool any_delayed() const;
  bool any_smoothed() const;
};

/// Computes the readings of the sensors for the motion at one time. Latency, filters, smoothing and
/// bias are not applied here.
class LogSensors {
 public:
  /// All arguments must outlive the object. `columns`: number of derivatives.
  LogSensors(const LogSignals& signals, const SensorTerms& terms, const CommandPath& path,
             const Plant<double>& plant, const std::vector<ParameterColumn>& parameters,
             std::size_t columns);
  /// Returns the reading of channel c for the motion at the time t. Afterwards, row() returns the
  /// derivatives of the reading.
  double read(LogChannel c, const LinearMotion& motion, double t_s);
  const std::vector<double>& row() const { return row_; }

 private:
  double sway(const LinearMotion& motion);
  double scaled(LogChannel c, double value);

  const LogSignals& signals_;
  const SensorTerms& terms_;
  const CommandPath& path_;
  SlippingWheels wheels_;
  std::vector<double> row_;
};

}  // namespace awmr
