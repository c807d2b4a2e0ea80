/// Tests how robust a ranking is: do the best modes of a scenario stay the best if one assumption
/// is changed? The changed assumptions are the plant (four wheels for the 3-DOF model, or the
/// reverse), the weights of the metrics, and the gains (slower or faster). Private to compare/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/compare/preferences.h"
#include "awmr/compare/ranking.h"
#include "awmr/compare/statistics.h"
#include "awmr/core/name_table.h"

namespace awmr {

/// Factor by which each weight is multiplied or divided, independently of the other weights, to
/// test the ranking with other weights. A larger factor leaves fewer rankings decided.
inline constexpr double kWeightFactor = 2.0;
/// Factor, sqrt(2), by which the bandwidths of heading loop and speed loop are multiplied or
/// divided, to test whether the ranking holds with slower and faster gains.
inline constexpr double kGainsFactor = 1.4142135623730951;

enum class DecisionKind {
  kDecided,    ///< one mode has rank 1 under all assumptions, and no NarrowLead
  kLevel,      ///< several modes have rank 1 under all assumptions
  kUndecided,  ///< no mode has rank 1 under all assumptions, or there is a NarrowLead
};
inline constexpr NameTable<DecisionKind, 3> kDecisionKindNames{
    {{"decided", DecisionKind::kDecided},
     {"level", DecisionKind::kLevel},
     {"undecided", DecisionKind::kUndecided}}};

/// A lead by one metric alone. The only mode of rank 1 is relevantly better than another mode in
/// just one ranked metric, and relevantly worse in at least one other. If the weight of this one
/// metric is divided by kWeightFactor, the mode that is behind reaches rank 1 as well.
struct NarrowLead {
  const MetricColumn* metric = nullptr;  ///< an entry of kMetricColumns
  std::vector<Contender> others;         ///< modes over which the lead is narrow
};

/// Decision on a scenario: the modes of rank 1 in the ranking, and the modes of rank 1 if one
/// assumption is changed. Modes that complete no run are left out.
struct Decision {
  std::vector<Contender> first;  ///< modes of rank 1 in the ranking
  /// Changed assumptions for which a ranking exists; always includes the change of weights.
  std::vector<Change> changes;
  std::optional<NarrowLead> narrow_lead = {};

  /// Modes that have rank 1 in the ranking and under every change.
  std::vector<Contender> never_behind() const;
  DecisionKind kind() const;
  /// True if one of the modes `first` also has rank 1 under the change.
  bool survives(const Change& change) const;
  /// If the two plants have different best modes, returns the names of trials that would show which
  /// plant describes the vehicle. Otherwise empty.
  std::vector<std::string_view> deciding_trials() const;
};

/// Names of the trials that show which plant describes the vehicle, as in comparison.json. `awmr
/// suggest` describes these trials.
inline constexpr std::string_view kDifferentialTurns = "differential-turns";
inline constexpr std::string_view kSteerWhileCoasting = "steer-while-coasting";

/// Repeats the ranking on the plant that the scenario does not use. For a single set of gains,
/// repeats it with slower and with faster gains as well. Uses at most the first kBatchRuns samples
/// of the comparison. If a scenario cannot be run with a change, the Change has the reason
/// (Change::not_run). Open-loop scenarios have no Change, because their modes are not ranked.
std::vector<Change> changes_of_runs(const Model& model, const std::vector<NamedGains>& gains,
                                    const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options);

/// Makes the Decision on a scenario. `ranking`: result of rank() for this scenario, not empty.
/// `changes` can contain changes of other scenarios, which are ignored.
Decision decide(const ScenarioRows& scenario, const ScenarioStatistics& statistics,
                const std::vector<RankedMode>& ranking, const std::vector<Change>& changes,
                const Preferences& preferences, std::uint64_t seed);

/// Text of a change, such as "on the four-wheel plant".
std::string text_of(const Change& change);

/// Verdict on a scenario in one sentence: the best mode, how far the other modes are behind, and
/// how robust the result is. A single mode of rank 1 is called "ahead here" instead of "best" if
/// the decision is DecisionKind::kUndecided.
std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::optional<Decision>& decision,
                       const std::vector<PairedDifference>& differences,
                       const Preferences& preferences = {});

}  // namespace awmr
