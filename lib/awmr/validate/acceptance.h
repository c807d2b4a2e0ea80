/// Acceptance test: a drive of the vehicle under its controller, compared with the prediction from
/// model, gains and scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/trials/log.h"

namespace awmr {

struct AcceptanceOptions {
  YawMode mode = YawMode::kCombined;
  int draws = 200;  ///< predicted drives, 39 ... 10000: fewer cannot resolve a probability of 1/20
  std::uint64_t seed = 1;
  /// Time in the log, s, at which the scenario begins. Absent: the first row with a command.
  std::optional<double> from_s = {};
  int threads = 0;  ///< 0: every core
};

/// One channel of the drive, compared with the predicted drives. All are averaged over windows of
/// half a second. The distance of a window is the difference of its mean from the mean prediction,
/// divided by the standard deviation of the predictions.
struct ChannelAcceptance {
  std::string channel;  ///< "heading_rad", "force_left"
  std::string unit;
  int samples = 0;              ///< rows compared
  double noise = 0.0;           ///< standard deviation of a reading's noise, in the unit
  bool noise_from_log = false;  ///< estimated from the log: not given by scenario or vehicle
  double distance = 0.0;        ///< largest distance of a window
  double allowed = 0.0;  ///< 95 % of the predicted drives stay within it in all channels at once
  bool inside = false;
  std::optional<double> outside_since_s =
      {};                   ///< in scenario time: the first window beyond `allowed`
  double difference = 0.0;  ///< measured minus predicted at the largest distance, in the unit
};

/// A single change of the model that reduces its distance from the drive.
struct FaultHypothesis {
  std::string what;    ///< "mass_norm", "gyro bias"
  double value = 0.0;  ///< best value: a factor of the model's, or in the unit
  std::string unit;    ///< "times" for a factor
  /// Fraction of the sum of squared distances removed by this change, in [0, 1].
  double explained = 0.0;
};

struct Acceptance {
  std::string file;
  std::string scenario;
  YawMode mode{};
  double from_s = 0.0;      ///< time in the log at which the scenario begins
  double duration_s = 0.0;  ///< compared duration: to the end of the log or of the shortest run
  int draws = 0;
  /// Fraction of drives that are at least as far off as this one, itself included.
  double p_value = 0.0;
  bool inside = false;  ///< p_value > 0.05
  std::vector<ChannelAcceptance> channels = {};
  std::vector<FaultHypothesis> hypotheses =
      {};  ///< for a drive outside: best explanation first; at most four
};

/// Simulates the scenario for draws of the model's covariance (only the model if it has none), from
/// the state at the beginning of the log. Sensor noise and latency and motor lag are those of
/// scenario or vehicle. If neither gives them, noise is estimated from the log, and latencies and
/// lags are drawn between 0 and twice those of LoopConditions.
/// Errors (input): as simulate() and PlantSampler; the log has no command, or is compared over less
/// than 2 s; nothing was measured; from_s is not within the log; options out of range.
Result<Acceptance> accept_drive(const DrivingLog& log, const Model& model,
                                const Gains<double>& gains, const Scenario& scenario,
                                const AcceptanceOptions& options);

/// Text table for a terminal.
std::string acceptance_table(const Acceptance& acceptance);

}  // namespace awmr
