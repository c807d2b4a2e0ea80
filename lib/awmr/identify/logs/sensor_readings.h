/// Simulated readings of all sensors of a log fit at the rows of a window, with derivatives: latency,
/// filters and smoothing included, biases not. Private to identify/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "awmr/identify/logs/simulated_vehicle.h"

namespace awmr {

/// Readings of one channel at all rows of a window, with derivatives, and their smoothing.
class ReadingSeries {
 public:
  /// Adds the reading at the next row. `row`: its derivatives.
  void add(double value, const std::vector<double>& row);
  /// Returns the smoothed reading at the place i; `row` gets its derivatives. A pair of rows i - n
  /// and i + n of which one is outside of the window counts as twice the row i.
  double smoothed(std::size_t i, const Smoothing& smoothing, std::vector<double>& row) const;

 private:
  std::vector<double> values_;
  std::vector<double> rows_;  ///< [place][column]
};

/// Readings of all channels at the rows of a window.
class SensorReadings {
 public:
  /// The arguments must outlive the object. `columns`: number of derivatives.
  SensorReadings(const LogModel& model, const FitWindow& window, const SimulatedVehicle& vehicle,
                 std::size_t columns);
  /// Adds the motion at the next row of the window.
  void add(const LinearMotion& now);
  /// The motions that were added; kept only if sensors read those of other rows.
  const std::vector<LinearMotion>& motions() const { return motions_; }
  /// Advances the filters to a row; to be called for every row in order.
  void go_to(std::size_t row, const LinearMotion& now);
  /// Returns the reading of a channel at the row at which go_to() was called last. row() then has
  /// its derivatives. For a smoothed channel, the motions of all rows must have been added.
  double read(LogChannel c, std::size_t row, const LinearMotion& now);
  std::vector<double>& row() { return row_; }

 private:
  double read_unsmoothed(LogChannel c, double t_s, const LinearMotion& now);

  const LogModel& model_;
  const FitWindow& window_;
  const SimulatedVehicle& vehicle_;
  LinearStepper back_;
  Sensors sensors_;
  /// Simulated filters, one per channel; empty for channels without a filter.
  std::array<std::optional<SmoothedChannel>, kChannelCount> filters_;
  bool keeps_motions_;
  std::vector<LinearMotion> motions_;
  std::array<ReadingSeries, kChannelCount> series_;  ///< of smoothed channels
  std::vector<double> row_;
};

}  // namespace awmr
