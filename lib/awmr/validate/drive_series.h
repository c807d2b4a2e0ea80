/// A drive and its predictions as series of window means, by channel. Private to this folder.
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
  /// Value in a run's row: the controller's reading, if the controller has this sensor.
  std::function<double(const RunRow& row)> of_run;
  double noise = 0.0;           ///< standard deviation of a reading
  bool noise_from_log = false;  ///< estimated, because it is not given
  bool noise_in_run = false;    ///< the rows of a run include it already
  std::vector<double> t_s;      ///< scenario time of each measured row
  std::vector<double> measured;
};

/// Means over half seconds, and the number of rows in each.
struct WindowMeans {
  std::vector<double> mean;
  std::vector<int> rows;
};
inline constexpr double kWindow_s = 0.5;

/// State at the beginning of the drive.
struct DriveStart {
  State<double> state{};
  State<double> error{};  ///< standard deviation of the measured components
};

/// The first row with a command, or the first row at or after from_s, which must not be before the
/// log. Errors (input): there is none.
Result<std::size_t> first_row_of(const DrivingLog& log, const std::optional<double>& from_s);

/// Noise of a channel's readings from row `first` on, assumed to be white. Precondition: the log
/// has the channel.
double noise_in(const DrivingLog& log, LogChannel which, std::size_t first);

/// The vehicle's conditions; missing noise is estimated from the log.
LoopConditions conditions_in(const DrivingLog& log, std::size_t first, const Vehicle& vehicle);

/// The channels of the log, over duration_s from row `first`. The noise of the controller's sensors
/// is taken from the scenario, which must have it; that of other channels is estimated from the
/// log.
std::vector<DriveChannel> channels_of(const DrivingLog& log, std::size_t first, double duration_s,
                                      const Scenario& scenario);

/// Initial state from the readings up to the first row (at most half a second); the scenario's
/// initial state where there are none.
DriveStart start_of(const DrivingLog& log, std::size_t first,
                    const std::vector<DriveChannel>& channels, const Scenario& scenario);

/// Means of the windows that end by duration_s.
WindowMeans means_of(const DriveChannel& channel, double duration_s);
/// Means of the run at the times of the log's rows. random: adds noise that the run's rows do not
/// include; nullptr: none.
WindowMeans means_of(const DriveChannel& channel, const Run& run, double sample_time_s,
                     double duration_s, Random* random);

}  // namespace awmr
