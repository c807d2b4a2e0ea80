/// Channels of a logged drive and of simulated runs of the same scenario, averaged over windows of
/// half a second, and the search for the cause of their difference. Private to validate/.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/core/random.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"
#include "awmr/trials/log.h"
#include "awmr/validate/acceptance.h"

namespace awmr {

/// Measured values of one channel of a drive, from the beginning of the scenario.
struct DriveChannel {
  std::string name;
  std::string unit;
  /// Returns the value of the channel in a row of a simulated run. For a measured quantity, it is
  /// the reading of the controller's sensor, or the true state if the controller has no such
  /// sensor.
  std::function<double(const RunRow& row)> of_run;
  double noise = 0.0;           ///< standard deviation of the noise of a reading, in `unit`
  bool noise_from_log = false;  ///< true: `noise` was estimated from the log
  bool noise_in_run = false;    ///< true: the values of of_run() include the noise
  std::vector<double> t_s;      ///< scenario time of each measured row
  std::vector<double> measured;
};

/// Means of a channel over windows of half a second, and the number of rows in each window.
struct WindowMeans {
  std::vector<double> mean;  ///< mean of each window; 0 for a window without rows
  std::vector<int> rows;
};
inline constexpr double kWindow_s = 0.5;

/// State at the beginning of the drive.
struct DriveStart {
  State<double> state{};
  State<double> error{};  ///< standard deviation of each measured component; 0: not measured
};

/// Index of the row at which the drive begins: the first row at or after from_s. If from_s is
/// absent, it is the first row with a command other than 0, but not a row that add_row_of_rest()
/// added. Errors (input): there is no such row, or from_s is before the log.
Result<std::size_t> first_row_of(const DrivingLog& log, const std::optional<double>& from_s);

/// Sensor noise, sensor latency and motor lag of the vehicle. Noise that vehicle.json does not give
/// is estimated from the log. If the log lacks the channel, the noise keeps its default.
LoopConditions conditions_in(const DrivingLog& log, std::size_t first, const Vehicle& vehicle);

/// Returns the measured channels of the log and its commands, over duration_s from row `first`,
/// each with the standard deviation of its noise. For a sensor of the controller, this is the noise
/// and rounding of the scenario. For other sensors, and if the scenario gives 0, it is estimated
/// from the log. Commands have no noise. Precondition: the scenario has `sensors`.
std::vector<DriveChannel> channels_of(const DrivingLog& log, std::size_t first, double duration_s,
                                      const Scenario& scenario);

/// Initial state of the drive: for each component the mean of its readings in the half second up to
/// row `first`, or the scenario's initial value if there are no readings.
DriveStart start_of(const DrivingLog& log, std::size_t first,
                    const std::vector<DriveChannel>& channels, const Scenario& scenario);

/// Means of the measured values, for the windows that end at duration_s or before.
WindowMeans means_of(const DriveChannel& channel, double duration_s);
/// Window means of the values in a simulated run, at the times of the log's rows. Noise drawn from
/// `random` is added, unless the run already includes noise (noise_in_run) or `random` is null.
WindowMeans means_of(const DriveChannel& channel, const Run& run, double sample_time_s,
                     double duration_s, Random* random);

/// Mean and standard deviation of a channel over the predicted drives, by window.
struct PredictedBand {
  std::vector<double> mean;
  std::vector<double> spread;  ///< standard deviation, with a small lower bound > 0
};

/// A channel of the logged drive, its prediction, and the distances of the predicted drives.
struct ComparedChannel {
  DriveChannel channel;
  WindowMeans measured;
  PredictedBand predicted;
  std::vector<double> largest;  ///< for each predicted drive, its largest distance in this channel
  double usual = 0.0;           ///< 95 % quantile of `largest` over the predicted drives
};

/// Tries each fault hypothesis. It changes a parameter (except exponents), the force or lag of the
/// motors, or the bias or latency of a sensor, or adds a constant external force or moment. For
/// each hypothesis, searches the value that minimises the sum of squared distances between the
/// simulated run and the drive. The controller stays the same. Returns the hypotheses that remove
/// at least 30 % of this sum, best first, at most four.
std::vector<FaultHypothesis> fault_hypotheses(const Model& model,
                                              const Controller<double>& controller,
                                              const Scenario& scenario,
                                              const AcceptanceOptions& options, double duration_s,
                                              const std::vector<ComparedChannel>& channels);

}  // namespace awmr
