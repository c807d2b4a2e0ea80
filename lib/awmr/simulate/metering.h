/// Between a scenario and the meter of its runs. Private to this folder.
#pragma once

#include "awmr/simulate/meter.h"
#include "awmr/simulate/metrics.h"

namespace awmr {

/// How a run ended.
struct Ending {
  RunEnd end = RunEnd::kDuration;
  double t_s = 0.0;  ///< of its last row
  int missed_waypoints = 0;
};

/// The parts of a run's metering (meter.h) that do not change over it, and what its sums come to.
MeteredVehicle<double> metered_vehicle(const AllocationLimits<double>& limits);
MeteredCourse metered_course(const Scenario& scenario);
Metrics metrics_of(MeterSums<double> sums, const Ending& ending, const Scenario& scenario);

}  // namespace awmr
