/// Which trial to record next: what each candidate would do to the model's uncertainty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/synthetic.h"
#include "awmr/model/model.h"

namespace awmr {

/// What one number of the model should become surer of.
struct SuggestTarget {
  std::string name;  ///< a parameter, or a closed-loop metric
  /// Its value at a plant. Its variance is grad^T C grad with the gradient by differences.
  std::function<double(const Plant<double>&)> value;
};

struct SuggestOptions {
  std::string parameter =
      {};  ///< to be ranked by; empty: A-optimal, the sum of squared relative errors
  SensorNoise sensors = {};                 ///< of curves and logs to come
  int repeats = 3;                          ///< runs of one candidate
  std::vector<SuggestTarget> metrics = {};  ///< closed-loop figures, worked out by the caller
};

/// A trial that could be recorded.
struct SuggestedTrial {
  TrialKind kind = TrialKind::kSurge;
  std::string settings;                                 ///< in words, for the field sheet
  std::vector<std::pair<std::string, double>> numbers;  ///< the same, for scripts
  std::string parameter = {};                           ///< what it is ranked by
  double std_error_before = 0.0;
  double std_error_after = 0.0;
  double d_gain = 0.0;  ///< ln det C before - after: bits of information, D-optimality
};

struct Suggestion {
  std::string criterion;               ///< in words
  std::vector<SuggestedTrial> trials;  ///< best first
  std::vector<std::string> assumptions;
};

/// Information adds up: C_after = (C^-1 + J^T W J)^-1 with J the derivatives of what the candidate
/// would measure. Errors (input): the model lacks a parameter or any covariance; an unknown
/// parameter name.
Result<Suggestion> suggest(const Model& model, const SuggestOptions& options);

/// The bytes of suggest.json.
std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance);
/// A sheet for the field: what to set, how long, what to write down.
std::string field_sheet(const Suggestion& suggestion, std::size_t most);

}  // namespace awmr
