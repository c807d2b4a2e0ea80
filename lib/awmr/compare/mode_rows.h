/// Rows of a comparison, grouped by scenario and contender. Private to compare/.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"

namespace awmr {

/// Rows of one contender in one scenario: sample 0 (the nominal model), then the drawn samples.
struct ModeRows {
  Contender contender;
  std::span<const ComparisonRow> rows;  ///< sample 0 first, then the drawn samples; never empty

  const Metrics& nominal() const { return rows.front().metrics; }
  /// Rows from which all statistics are computed: the rows of the drawn samples or, without drawn
  /// samples, the row of the nominal run.
  std::span<const ComparisonRow> counted() const {
    return rows.size() > 1 ? rows.subspan(1) : rows;
  }
  std::size_t completed_count() const;
  /// Share of the counted runs that complete the scenario, in [0, 1].
  double completed_share() const;
  std::string label() const { return contender.label(); }
};

/// Rows of one scenario, by contender.
struct ScenarioRows {
  std::string scenario;
  std::vector<ModeRows> modes;
};

/// Precondition: all samples are complete (evaluated_part()).
std::vector<ScenarioRows> group(const Comparison& comparison);
/// Returns the comparison without the samples that are not finished for all contenders.
Comparison evaluated_part(const Comparison& comparison);

}  // namespace awmr
