/// Between a scenario and the meter of its runs. Private to this folder.
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

/// When the rows of a run are, one after the other.
class MeterClock {
 public:
  /// `last`: of the rows of a run to its end, counted from 0. The scenario outlives the clock.
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
MetricsCourse metered_course(const Scenario& scenario);
Metrics metrics_of(MetricsAccumulator<double> sums, const Ending& ending, const Scenario& scenario);

/// True where every sum is finite.
bool is_finite(const MetricsAccumulator<double>& sums);

}  // namespace awmr
