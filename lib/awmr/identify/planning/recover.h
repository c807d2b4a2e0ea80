/// The user's own self-test: simulate trials at a model's values, identify them, compare, many
/// times.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/identify.h"
#include "awmr/identify/planning/synthetic.h"

namespace awmr {

/// Which trials are simulated.
enum class RecoverPlan {
  kTables,  ///< rows as the model's own trials
  kCurve,   ///< the same, with a coast-down curve in place of the stop times
  kLog,     ///< a driving log and nothing else
};

struct RecoverOptions {
  /// The trials that are to be recorded, or were.
  RecoverPlan plan = RecoverPlan::kTables;
  /// >= 2. The coverage errs by 0.22/sqrt(runs): 200 runs give 95 % to 1.5 %.
  int runs = 200;
  std::uint64_t seed = 1;
  /// >= 0; 0: one per core. Fewer leave cores to other work; the result does not depend on it.
  int threads = 0;
  /// The estimator under test.
  IdentifyOptions identify;
  /// Quantity with the simulated error; absent: as the estimator assumes. Another one shows the
  /// cost of a wrong assumption.
  std::optional<ErrorModel> error;
  /// Sensor noise of curves and logs. Use the robot's own values if they are known.
  SensorNoise sensors;
  /// Length and rate of a coast-down curve, > 0.
  double curve_s = 2.0;
  double curve_rate_hz = 100.0;
  /// The commands of a log; each run drives others.
  DrivePlan drive;
};

/// truth, bias, rmse and mean_std_error are in the parameter's unit.
struct RecoveredParameter {
  ParameterId id = ParameterId::kMassNorm;
  double truth = 0.0;
  double bias = 0.0;            ///< mean of estimate - truth
  double rmse = 0.0;            ///< root mean square of that
  double mean_std_error = 0.0;  ///< reported by the fits
  double coverage95 = 0.0;      ///< share of runs whose interval holds the truth
  double worst_error = 0.0;     ///< largest |estimate/truth - 1|; 0 where the truth is 0
  int runs = 0;                 ///< that gave an estimate with an interval
};

struct Recovery {
  std::vector<RecoveredParameter> parameters;
  std::string noise_text;  ///< as simulated
  int runs = 0;
  int failed = 0;  ///< runs in which something requested was refused
};

/// `progress` is called with the runs done so far, on the thread that called recover(), and last
/// with all of them. The log of a model of straight motion drives straight, and only the parameters
/// of straight motion are fitted. Errors (input): the model lacks a parameter that a trial of the
/// plan needs, or has no trials for the plan; fewer than 2 runs. (refused): no run gives what is
/// requested, or anything.
Result<Recovery> recover(const Model& model, const RecoverOptions& options,
                         const std::function<void(int)>& progress);

/// The bytes of recover.json.
std::string recovery_text(const Recovery& recovery, const Provenance& provenance);

/// The same in a line for each parameter, for a terminal.
std::string recovery_table(const Recovery& recovery);

/// The JSON Schema of recover.json.
std::string recover_schema();

}  // namespace awmr
