/// A recovery in two steps, so that machines can share it: the results of the runs of a part, and
/// the statistics of all runs.
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

/// A parameter and the value that it was simulated with, in its unit.
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
  int index = 0;         ///< of all runs, from 0: with the seed it decides on the errors
  bool refused = false;  ///< something requested was refused
  /// By RecoverPart::truths; absent where the run gave no interval.
  std::vector<std::optional<RecoverEstimate>> estimates;
};

/// The first run with a reason for a refusal.
struct RecoverRefusal {
  int run = 0;
  std::string message;
};

/// Some of the runs of a recovery, or all of them.
struct RecoverPart {
  int all_runs = 0;                  ///< of all parts
  std::string noise_text;            ///< as simulated
  std::vector<ParameterId> asked;    ///< empty: all that the trials identify
  std::vector<RecoverTruth> truths;  ///< of the evaluated parameters
  std::vector<RecoverRun> runs;      ///< by index
  std::optional<RecoverRefusal> refusal;
  std::optional<Error> error;  ///< why no run gave a model at all: that of the first
};

/// The runs of a part: those of `shard`. `progress` and errors as in recover(), but that a part whose
/// runs give nothing is a part all the same: others may give something. Errors (input) also: there is
/// no such part, or it would be empty.
Result<RecoverPart> recover_part(const Model& model, const RecoverOptions& options,
                                 const Shard& shard, const std::function<void(int)>& progress);

/// Computes the statistics of the runs. Precondition: `whole` has all of them. Errors: those of the
/// runs, if all have one; (refused) no run gives a requested parameter, or any.
Result<Recovery> recovery_of(const RecoverPart& whole);

}  // namespace awmr
