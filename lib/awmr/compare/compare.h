/// The three yaw-control modes on the same scenarios: metrics, paired differences, ranking.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

struct CompareOptions {
  int samples = 0;  ///< Monte-Carlo samples beside the nominal model (sample 0), >= 0
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per core; results do not depend on it
};

struct ComparisonRow {
  std::string scenario;
  YawMode mode{};
  int sample = 0;  ///< 0: the model's own values
  Metrics metrics;
};

struct Comparison {
  std::vector<ComparisonRow> rows;  ///< by scenario, mode, sample
};

/// Samples draw the fitted parameters from the model's covariance (draw.h), the same draw for all
/// three modes and every scenario; the controller keeps the model's own values.
/// Errors (input): the model lacks a parameter, or, with samples, a covariance to draw from; no
/// scenario, or two of the same name; a negative number of samples or threads.
Result<Comparison> compare(const Model& model, const std::string& model_file,
                           const Gains<double>& gains, const std::vector<Scenario>& scenarios,
                           const CompareOptions& options);

/// The bytes of comparison.csv: the contract's columns, `completed` as 1 or 0, empty cells where a
/// metric has no meaning.
std::string comparison_csv(const Comparison& comparison);
/// The bytes of comparison.json.
std::string comparison_text(const Comparison& comparison, const CompareOptions& options,
                            const Provenance& provenance);

/// Figures by scenario and mode, and the ranking, as a table for a terminal.
std::string comparison_table(const Comparison& comparison);

}  // namespace awmr
