/// Recovery in two steps, for several machines: the runs of a part, and the statistics of all runs.
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

/// A parameter and its simulated value, in its unit.
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

/// One simulated data set, identified.
struct RecoverRun {
  int index = 0;         ///< number among all runs, from 0; with the seed it determines the errors
  bool refused = false;  ///< a requested parameter was refused
  /// By RecoverPart::truths; absent without an interval.
  std::vector<std::optional<RecoverEstimate>> estimates;
};

/// The first run that was refused, with the reason.
struct RecoverRefusal {
  int run = 0;
  std::string message;
};

/// Some or all of the runs of a recovery.
struct RecoverPart {
  int all_runs = 0;                    ///< number in all parts
  std::string noise_text;              ///< as simulated
  std::vector<ParameterId> requested;  ///< empty: all that the trials identify
  std::vector<RecoverTruth> truths;    ///< of the evaluated parameters
  std::vector<RecoverRun> runs;        ///< by index
  std::optional<RecoverRefusal> refusal;
  std::optional<Error> error;  ///< error of the first run, if no run gave a model
};

/// Runs the part `shard`. `progress` and errors as in recover(), except that a part without any
/// result is not an error, because other parts can have results. Errors (input): also a part that
/// does not exist or is empty.
Result<RecoverPart> recover_part(const Model& model, const RecoverOptions& options,
                                 const Shard& shard, const std::function<void(int)>& progress);

/// Computes the statistics of the runs. Precondition: `whole` has all runs. Errors: that of the
/// first run, if all have one; (refused) no run gives one of the requested parameters, or any.
Result<Recovery> recovery_of(const RecoverPart& whole);

}  // namespace awmr
