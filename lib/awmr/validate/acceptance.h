/// A drive of the vehicle under its controller, against what model, gains and scenario foretell: the
/// last link of the chain from the first trial to the flashed gain.
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
  int draws = 200;  ///< foretold drives, 39 ... 10000: fewer cannot tell one in twenty
  std::uint64_t seed = 1;
  /// Time in the log, s, at which the scenario begins. Absent: the first row that commands anything.
  std::optional<double> from_s = {};
  int threads = 0;  ///< 0: every core
};

/// One channel of the drive against the foretold ones. Both are averaged over windows of half a
/// second; the distance of a window is that of its mean from the mean of the foretold, over their
/// standard deviation.
struct ChannelAcceptance {
  std::string channel;  ///< "heading_rad", "force_left"
  std::string unit;
  int samples = 0;              ///< rows that were compared
  double noise = 0.0;           ///< standard deviation of a reading's noise, in the unit
  bool noise_from_log = false;  ///< estimated from the log: neither scenario nor vehicle gives it
  double distance = 0.0;        ///< the largest of a window
  double allowed = 0.0;  ///< what 95 % of the foretold drives keep to in every channel at once
  bool inside = false;
  std::optional<double> outside_since_s =
      {};                   ///< of the scenario: the first window beyond `allowed`
  double difference = 0.0;  ///< measured less foretold, where the distance is largest, in the unit
};

/// A single change that would bring the model nearer to the drive.
struct Suspect {
  std::string what;    ///< "mass_norm", "gyro bias"
  double value = 0.0;  ///< what it would have to be: times the model's, or in the unit
  std::string unit;    ///< "times" for a factor
  /// By how much it lessens the sum of squared distances, of it: 1 explains all.
  double explained = 0.0;
};

struct Acceptance {
  std::string file;
  std::string scenario;
  YawMode mode{};
  double from_s = 0.0;      ///< of the log: where the scenario begins
  double duration_s = 0.0;  ///< that was compared: to the end of the log or of the shortest run
  int draws = 0;
  /// Share of foretold drives that are as far off as this one or farther, itself among them.
  double p_value = 0.0;
  bool inside = false;  ///< p_value > 0.05
  std::vector<ChannelAcceptance> channels = {};
  std::vector<Suspect> suspects =
      {};  ///< of a drive outside, what explains most first; at most four
};

/// Simulates the scenario for draws of the model's covariance (model alone where it has none), with
/// the sensors' noise and lateness and the motors' lag of scenario or vehicle, from the state in
/// which the log begins. Of what neither gives, noise is the log's own, and lateness and lags are
/// drawn between 0 and twice those of LoopConditions.
/// Errors (input): as simulate() and PlantSampler; the log commands nothing, or is compared over less
/// than 2 s; nothing was measured; from_s is not within the log; options out of range.
Result<Acceptance> accept_drive(const DrivingLog& log, const Model& model,
                                const Gains<double>& gains, const Scenario& scenario,
                                const AcceptanceOptions& options);

/// For a terminal.
std::string acceptance_table(const Acceptance& acceptance);

}  // namespace awmr
