/// Simulated readings of all sensors of a log fit at the rows of a window, and their derivatives
/// with respect to the columns of the fit (its unknowns, see LinearMotion). Biases are not
/// included. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/identify/logs/simulation/simulated_vehicle.h"

namespace awmr {

/// Readings of one channel at all rows of a window, their derivatives with respect to the columns
/// of the fit, and the smoothing of both.
class ReadingSeries {
 public:
  /// Adds the reading at the next row. `row`: its derivatives, one per column of the fit.
  void add(double value, const std::vector<double>& row);
  /// Returns the reading at the row with the index i, and sets `row` to its derivatives with
  /// respect to the columns. If `smoothing` is present, the reading is a weighted mean over pairs
  /// of rows i - n and i + n (SmoothingKernel). If one row of a pair is outside of the window, row
  /// i replaces both.
  double read(std::size_t i, const std::optional<Smoothing>& smoothing,
              std::vector<double>& row) const;

 private:
  std::vector<double> values_;
  std::vector<double> rows_;  ///< [index of the row][column]
};

/// Computes the readings of all sensors row by row, while the motion of a window is simulated. They
/// include latency and filters, but not symmetric smoothing, which needs later rows.
class SensorReadings {
 public:
  /// The arguments must outlive the object. `columns`: number of columns of the fit.
  SensorReadings(const LogModel& model, const FitWindow& window, const SimulatedVehicle& vehicle,
                 std::size_t columns);
  /// Advances to the next row of the window (first call: to the first row). `now`: simulated motion
  /// there.
  void go_on(const LinearMotion& now);
  /// Returns the reading of a channel at this row. Also stores its derivatives, one per column of
  /// the fit; row() returns them.
  double read(LogChannel c, const LinearMotion& now);
  std::vector<double>& row() { return row_; }

 private:
  /// Returns the motion `before_s.value` seconds before this row (earlier_motion()).
  LinearMotion earlier(const TermColumn& before_s);
  /// Returns the motion whose speed and yaw rate are the means of the averaging time of channel c.
  /// `end`: the motion at the end of this time, `late_s` seconds before this row.
  LinearMotion averaged(LogChannel c, LinearMotion end, double late_s);
  /// Returns the reading of channel c for the motion at the time t, without latency, filters,
  /// smoothing and bias. Also sets row_ to its derivatives. The functions below are its parts.
  double reading_of(LogChannel c, const LinearMotion& motion, double t_s);
  double sway(const LinearMotion& motion);
  double add_speed_offset(const LinearMotion& motion);
  double add_antenna(LogChannel c, const LinearMotion& motion);
  double add_deviation(double heading_rad);
  double scaled(LogChannel c, double value);

  const LogModel& model_;
  const FitWindow& window_;
  const SimulatedVehicle& vehicle_;
  const SensorTerms& terms_;
  SlippingWheels wheels_;
  LinearStepper back_;
  /// Simulated filters, one per channel; empty for channels without a filter.
  std::array<std::optional<FilteredChannel>, kChannelCount> filters_;
  std::size_t rows_ = 0;               ///< number of rows up to now
  std::vector<LinearMotion> motions_;  ///< motions at these rows; empty unless any_earlier()
  std::vector<double> row_;
};

}  // namespace awmr
