/// Channels of a logged drive and of its simulations, averaged over windows of half a second. Private
/// to validate/.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "awmr/core/random.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"
#include "awmr/trials/log.h"

namespace awmr {

/// One channel of a drive, from the beginning of the scenario.
struct DriveChannel {
  std::string name;
  std::string unit;
  /// Value of the channel in a row of a simulated run: the reading of the controller's sensor, or the
  /// state if the controller has no such sensor.
  std::function<double(const RunRow& row)> of_run;
  double noise = 0.0;           ///< standard deviation of the noise of a reading
  bool noise_from_log = false;  ///< the noise was estimated from the log, because it is not given
  bool noise_in_run = false;    ///< the rows of a simulated run already include the noise
  std::vector<double> t_s;      ///< scenario time of each measured row
  std::vector<double> measured;
};

/// Means over windows of half a second, and the number of rows in each window.
struct WindowMeans {
  std::vector<double> mean;
  std::vector<int> rows;
};
inline constexpr double kWindow_s = 0.5;

/// State at the beginning of the drive.
struct DriveStart {
  State<double> state{};
  State<double> error{};  ///< standard deviation of each measured component, 0 for the others
};

/// Index of the row at which the drive begins: the first row at or after from_s or, if that is
/// absent, the first row with a command. Errors (input): there is no such row, or from_s is before
/// the log.
Result<std::size_t> first_row_of(const DrivingLog& log, const std::optional<double>& from_s);

/// Standard deviation of the noise in a channel's readings from row `first` on, assumed to be white.
/// Precondition: the log has the channel.
double noise_in(const DrivingLog& log, LogChannel which, std::size_t first);

/// Noise, latency and lag of the vehicle. Noise that the vehicle file does not give is estimated from
/// the log.
LoopConditions conditions_in(const DrivingLog& log, std::size_t first, const Vehicle& vehicle);

/// The channels of the log, over duration_s from row `first`. The noise of the controller's sensors
/// is that of the scenario, which must have it. The noise of other channels is estimated from the
/// log.
std::vector<DriveChannel> channels_of(const DrivingLog& log, std::size_t first, double duration_s,
                                      const Scenario& scenario);

/// Initial state: the mean of the readings in the half second up to row `first`. Components without
/// readings are those of the scenario's initial state.
DriveStart start_of(const DrivingLog& log, std::size_t first,
                    const std::vector<DriveChannel>& channels, const Scenario& scenario);

/// Means of the measured values, for the windows that end by duration_s.
WindowMeans means_of(const DriveChannel& channel, double duration_s);
/// The same for a simulated run, at the times of the log's rows. `random` adds the noise that the
/// rows of the run do not include; nullptr: no noise is added.
WindowMeans means_of(const DriveChannel& channel, const Run& run, double sample_time_s,
                     double duration_s, Random* random);

}  // namespace awmr
