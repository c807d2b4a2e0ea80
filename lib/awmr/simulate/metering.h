/// Constants and times for the metrics accumulator (meter.h), and the metrics computed from its
/// sums at the end of a run. Private to this folder.
#pragma once

#include <cstddef>

#include "awmr/simulate/meter.h"
#include "awmr/simulate/metrics.h"

namespace awmr {

/// How and when a run ended.
struct Ending {
  RunEnd end = RunEnd::kDuration;
  double t_s = 0.0;  ///< time of the last row
  int missed_waypoints = 0;
};

/// Computes the time data of each row of a run, in sequence.
class MeterClock {
 public:
  /// `last`: index of the last row, from 0, if the run does not end early. The scenario must
  /// outlive the clock.
  MeterClock(const Scenario& scenario, std::size_t last) : scenario_(&scenario), last_(last) {}
  MetricsTime next(double t_s);

 private:
  const Scenario* scenario_;
  std::size_t last_;
  std::size_t row_ = 0;
  double before_s_ = 0.0;
  double goal_before_rad_ = 0.0;
};

/// Returns the data of the vehicle that the accumulator needs.
MetricsVehicle<double> metered_vehicle(const Controller<double>& controller);
/// Returns the properties of the scenario that the accumulator needs.
MetricsTask metrics_task(const Scenario& scenario);
/// Computes the metrics of a run from the sums over all of its rows. Precondition: at least one
/// row.
Metrics metrics_of(MetricsAccumulator<double> sums, const Ending& ending, const Scenario& scenario);

/// True if every sum is finite.
bool is_finite(const MetricsAccumulator<double>& sums);

}  // namespace awmr
