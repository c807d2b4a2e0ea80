/// Inputs of the meter from a scenario, and metrics from its sums. Private to this folder.
#pragma once

#include <cstddef>

#include "awmr/simulate/meter.h"
#include "awmr/simulate/metrics.h"

namespace awmr {

/// End of a run.
struct Ending {
  RunEnd end = RunEnd::kDuration;
  double t_s = 0.0;  ///< of its last row
  int missed_waypoints = 0;
};

/// Times of the rows of a run, in sequence.
class MeterClock {
 public:
  /// `last`: index of the last row of a full run, from 0. The scenario must outlive the clock.
  MeterClock(const Scenario& scenario, std::size_t last) : scenario_(&scenario), last_(last) {}
  MetricsTime next(double t_s);

 private:
  const Scenario* scenario_;
  std::size_t last_;
  std::size_t row_ = 0;
  double before_s_ = 0.0;
  double goal_before_rad_ = 0.0;
};

/// Constants of a run's metering (meter.h), and the metrics computed from its sums.
MetricsVehicle<double> metered_vehicle(const AllocationLimits<double>& limits);
MetricsTask metrics_task(const Scenario& scenario);
Metrics metrics_of(MetricsAccumulator<double> sums, const Ending& ending, const Scenario& scenario);

/// True if every sum is finite.
bool is_finite(const MetricsAccumulator<double>& sums);

}  // namespace awmr
