/// The two steps of recover(): recover_part() executes a part of the runs, and recovery_of()
/// computes the statistics of all runs. Parts can be executed on different machines.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/core/shard.h"
#include "awmr/identify/planning/recover.h"

namespace awmr {

/// A parameter with its true value, at which the trials are simulated, in its unit.
struct RecoverTruth {
  ParameterId id = ParameterId::kMassNorm;
  double value = 0.0;

  bool operator==(const RecoverTruth&) const = default;
};

/// Estimate of one parameter in one run, in its unit.
struct RecoverEstimate {
  double value = 0.0;
  std::optional<double> std_error;
  Interval ci95;
};

/// Result of one run: the estimates from one simulated data set.
struct RecoverRun {
  /// Number of the run, from 0. The seed and this number determine the simulated errors.
  int index = 0;
  bool refused = false;  ///< true: a requested parameter was refused
  /// Estimates of the parameters in RecoverPart::truths, in this order. Absent for a parameter
  /// without an interval.
  std::vector<std::optional<RecoverEstimate>> estimates;
};

/// The first run in which a requested parameter was refused, with the reason.
struct RecoverRefusal {
  int run = 0;
  std::string message;
};

/// Some or all of the runs of a recovery.
struct RecoverPart {
  int all_runs = 0;                    ///< number of runs of all parts together
  std::string noise_text;              ///< description of the simulated noise
  std::vector<ParameterId> requested;  ///< empty: every parameter that the trials identify
  std::vector<RecoverTruth> truths;    ///< true values of the evaluated parameters
  /// Quantities that the model identified from its trials. Empty if the user requested parameters,
  /// or for RecoverPlan::kLog: then nothing is reported as left out.
  std::vector<ParameterId> identified = {};
  std::vector<RecoverRun> runs;  ///< in the order of their index
  std::optional<RecoverRefusal> refusal;
  std::optional<Error> error;  ///< error of the first run, if every run failed
};

/// Executes the runs of the part `shard`. `progress` is called as by recover(). Errors: those of
/// recover(), except that a part without any estimate is no error, because other parts may have
/// estimates. Errors (input): the part does not exist or has no runs.
Result<RecoverPart> recover_part(const Model& model, const RecoverOptions& options,
                                 const Shard& shard, const std::function<void(int)>& progress);

/// Computes the statistics of all runs. Precondition: `whole` has all runs. Errors: the error of
/// the first run, if every run failed. Errors (refused): no run estimates a requested parameter, or
/// any parameter.
Result<Recovery> recovery_of(const RecoverPart& whole);

}  // namespace awmr
