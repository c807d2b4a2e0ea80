/// A drive and the runs that foretell it as series of window means, channel by channel. Private to
/// this folder.
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

/// One channel of a drive, from where the scenario begins.
struct DriveChannel {
  std::string name;
  std::string unit;
  /// What a run's row says of it: what the controller was told, where it is told this at all.
  std::function<double(const RunRow& row)> of_run;
  double noise = 0.0;           ///< standard deviation of a reading
  bool noise_from_log = false;  ///< estimated, as nobody gives it
  bool noise_in_run = false;    ///< the rows of a run have it already
  std::vector<double> t_s;      ///< of the scenario, by row that was measured
  std::vector<double> measured;
};

/// The means of half seconds, and how many rows each is of.
struct WindowMeans {
  std::vector<double> mean;
  std::vector<int> rows;
};
inline constexpr double kWindow_s = 0.5;

/// The state in which the drive begins.
struct DriveStart {
  State<double> state{};
  State<double> error{};  ///< standard deviation of what was read of it
};

/// The first row that commands anything, or that at or after from_s, which is no time before the log.
/// Errors (input): there is none.
Result<std::size_t> first_row_of(const DrivingLog& log, const std::optional<double>& from_s);

/// The noise of a channel's readings from row `first` on, taken to be white.
/// Precondition: the log has the channel.
double noise_in(const DrivingLog& log, LogChannel which, std::size_t first);

/// The vehicle's conditions; noise that it does not give is that of the log's readings.
LoopConditions conditions_in(const DrivingLog& log, std::size_t first, const Vehicle& vehicle);

/// The channels that the log has, over duration_s from its row `first`. Noise of the
/// controller's sensors is the scenario's, which has to have them, that of others the log's own.
std::vector<DriveChannel> channels_of(const DrivingLog& log, std::size_t first, double duration_s,
                                      const Scenario& scenario);

/// The readings up to the first row, of half a second at most, in place of the scenario's initial
/// state where there are any.
DriveStart start_of(const DrivingLog& log, std::size_t first,
                    const std::vector<DriveChannel>& channels, const Scenario& scenario);

/// Only windows that end by duration_s.
WindowMeans means_of(const DriveChannel& channel, double duration_s);
/// What would have been recorded of the run at the same times. random: for the noise that its rows
/// are without; nullptr for none.
WindowMeans means_of(const DriveChannel& channel, const Run& run, double sample_time_s,
                     double duration_s, Random* random);

}  // namespace awmr
