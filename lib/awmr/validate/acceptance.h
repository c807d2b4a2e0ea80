/// Acceptance test: compares a logged drive of the vehicle under its controller with simulated
/// drives of the same scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/trials/log.h"

namespace awmr {

struct AcceptanceOptions {
  YawMode mode = YawMode::kCombined;
  /// Number of predicted drives, 39 ... 10000. Below 39, the p-value is too coarse for the limit
  /// 0.05.
  int draws = 200;
  std::uint64_t seed = 1;
  /// Time in the log, s, at which the scenario begins. Absent: the time of the first row with a
  /// command other than 0.
  std::optional<double> from_s = {};
  int threads = 0;  ///< number of threads; 0: one per core
};

/// One channel of the drive, compared with the predicted drives. Measured and predicted values are
/// averaged over windows of half a second. The distance of a window is |measured mean - mean of the
/// predicted drives|, divided by the standard deviation of the predicted drives.
struct ChannelAcceptance {
  std::string channel;  ///< name: "heading_rad", "force_left"
  std::string unit;
  int samples = 0;     ///< number of rows compared
  double noise = 0.0;  ///< standard deviation of the noise of a reading, in `unit`
  /// True: `noise` was estimated from the log, because neither scenario nor vehicle gives it.
  bool noise_from_log = false;
  double distance = 0.0;  ///< largest distance of a window, >= 0
  /// Limit of `distance`. The limits of all channels are chosen together, so that 95 % of the
  /// predicted drives are within every limit.
  double allowed = 0.0;
  bool inside = false;  ///< true: distance <= allowed
  /// Scenario time, s, of the first window whose distance is larger than allowed, if any
  std::optional<double> outside_since_s = {};
  /// measured minus predicted mean, in `unit`, in the window with the largest distance
  double difference = 0.0;
};

/// A possible cause of the difference between logged drive and prediction: a change of one property
/// of the vehicle or its sensors, or an external force.
struct FaultHypothesis {
  std::string what;    ///< changed quantity: "mass_norm", "bias of the yaw rate"
  double value = 0.0;  ///< value with which the simulation is nearest to the drive, in `unit`
  std::string unit;    ///< unit of `value`; "times": a factor on the model's value
  /// Fraction in [0, 1] of the sum of squared distances that disappears with this change.
  double explained = 0.0;
};

/// Result of accept_drive().
struct Acceptance {
  std::string file;
  std::string scenario;
  YawMode mode{};
  double from_s = 0.0;  ///< time in the log at which the scenario begins
  /// Duration of the comparison, s. The comparison ends when the log, the scenario or the shortest
  /// simulated run ends.
  double duration_s = 0.0;
  int draws = 0;
  /// Fraction of all drives (predicted and logged) that are at least as far from the prediction as
  /// the logged drive.
  double p_value = 0.0;
  bool inside = false;  ///< true: p_value > 0.05, the drive agrees with the prediction
  std::vector<ChannelAcceptance> channels = {};
  /// The best hypotheses, best first, at most four; empty if the drive is inside.
  std::vector<FaultHypothesis> hypotheses = {};
};

/// Simulates the scenario with vehicles drawn from the model's covariance, and compares the logged
/// drive with these predicted drives. (Without a covariance, all vehicles equal the model.) The
/// predicted drives start from the state at the beginning of the logged drive. Sensor noise, sensor
/// latency and motor lag are those of the scenario or the vehicle. If neither gives a value,
/// accept_drive() estimates the noise from the log, and draws latencies and lag between 0 and twice
/// the defaults of LoopConditions. Errors (input): the vehicle does not have the yaw mode of the
/// options; the log has no command, or less than 2 s of the scenario; from_s is not within the log;
/// options.draws is out of range; the errors of simulate(), controller_for() and PlantSampler.
Result<Acceptance> accept_drive(const DrivingLog& log, const Model& model, const ModeGains& gains,
                                const Scenario& scenario, const AcceptanceOptions& options);

std::string acceptance_table(const Acceptance& acceptance);

}  // namespace awmr
