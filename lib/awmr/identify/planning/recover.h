/// Self-test of an identification (`awmr recover`): simulates a model's trials with noise many
/// times, identifies each set, and compares the estimates with the model's values.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/identify.h"
#include "awmr/identify/planning/synthetic.h"

namespace awmr {

/// Trials to simulate.
enum class RecoverPlan {
  /// Trial tables with the settings of the model's own trials.
  kTables,
  /// The same tables, but with a coast-down curve in place of the stop times.
  kCurve,
  kLog,  ///< a driving log instead of tables
};

/// Values of `--error`.
inline constexpr NameTable<ErrorModel, 4> kRecoverErrorNames{{{"log-force", ErrorModel::kLogForce},
                                                              {"force", ErrorModel::kForce},
                                                              {"speed", ErrorModel::kSpeed},
                                                              {"time", ErrorModel::kTime}}};

struct RecoverOptions {
  RecoverPlan plan = RecoverPlan::kTables;
  /// Number of runs, >= 2. Each run simulates and identifies one set of trials. The standard error
  /// of the coverage is 0.22/sqrt(runs): 1.5 % for 200 runs.
  int runs = 200;
  std::uint64_t seed = 1;
  /// Number of threads, >= 0; 0: one per core. The result does not depend on it.
  int threads = 0;
  /// The estimator under test.
  IdentifyOptions identify;
  /// Quantity that gets the simulated error. Absent: the quantity that has the error according to
  /// the estimator under test. Give another quantity to see the effect of a wrong assumption.
  std::optional<ErrorModel> error;
  /// Sensor noise of curves and logs. Use the robot's own values if they are known.
  SensorNoise sensors;
  /// Duration, s, and sample rate, Hz, of a coast-down curve, > 0.
  double curve_s = 2.0;
  double curve_rate_hz = 100.0;
  /// Duration and commands of a log. The random commands differ from run to run.
  DrivePlan drive;
};

/// Statistics of one parameter over the runs. truth (the model's value), bias, rmse and
/// mean_std_error are in the parameter's unit.
struct RecoveredParameter {
  ParameterId id = ParameterId::kMassNorm;
  double truth = 0.0;
  double bias = 0.0;            ///< mean of estimate - truth
  double rmse = 0.0;            ///< root mean square of estimate - truth
  double mean_std_error = 0.0;  ///< mean of the standard errors that the fits report
  double coverage95 = 0.0;      ///< fraction of `runs` whose 95 % interval contains the truth
  double worst_error = 0.0;     ///< largest |estimate/truth - 1| of a run; 0 if the truth is 0
  int runs = 0;                 ///< runs with an estimate and an interval
};

/// Statistics of all runs.
struct Recovery {
  std::vector<RecoveredParameter> parameters;
  std::string noise_text;  ///< description of the simulated noise
  int runs = 0;
  int failed = 0;  ///< number of runs in which a requested parameter was refused
  /// A note (`not-identifiable`) on quantities that the model identified, but no run.
  std::vector<Finding> findings = {};
};

/// Runs the self-test. `progress` is called on the calling thread with the number of completed
/// runs. If the model has only parameters of straight motion, the simulated log drives straight,
/// and the fit estimates only the surge law (a1, b1) and the mass m'. Errors (input): the model
/// lacks a parameter that a trial of the plan needs, or has no trials for the plan; fewer than 2
/// runs; a simulated log of fewer than 20 or more than a million rows; a time constant that is too
/// short to simulate (check_replay()). Errors (refused): no run estimates a requested parameter, or
/// any parameter.
Result<Recovery> recover(const Model& model, const RecoverOptions& options,
                         const std::function<void(int)>& progress);

/// Content of recover.json.
std::string recovery_text(const Recovery& recovery, const Provenance& provenance);

/// Table of the statistics, one line per parameter, to print on a terminal.
std::string recovery_table(const Recovery& recovery);

/// The JSON Schema of recover.json.
std::string recover_schema();

}  // namespace awmr
