/// Robustness of a ranking against changes of the plant, of the weights within a factor 2 and of
/// the gains. Private to this folder.
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

/// Weights are doubled and halved, each by itself.
inline constexpr double kWeightFactor = 2.0;
/// Rates of both closed loops are multiplied and divided by this, > 1: sqrt(2).
inline constexpr double kGainsFactor = 1.4142135623730951;

enum class DecisionKind {
  kDecided,    ///< one mode is never behind
  kLevel,      ///< several are never behind
  kUndecided,  ///< every mode is behind in some setting
};
inline constexpr NameTable<DecisionKind, 3> kDecisionKindNames{
    {{"decided", DecisionKind::kDecided},
     {"level", DecisionKind::kLevel},
     {"undecided", DecisionKind::kUndecided}}};

/// Result of a scenario: its first ranks, and whether they hold under every change.
struct Decision {
  std::vector<Contender> first;  ///< of rank 1 in the ranking itself
  std::vector<Change> changes;   ///< those that have a ranking; never empty: weights need no runs

  /// Contenders of rank 1 in the ranking and under every change.
  std::vector<Contender> never_behind() const;
  DecisionKind kind() const;
  /// Whether the change leaves one of `first` in the first place.
  bool survives(const Change& change) const;
  /// Trials that show which of the two plants is right, if their best modes differ.
  std::vector<std::string_view> deciding_trials() const;
};

/// Names of trials in comparison.json, which `awmr suggest` describes.
inline constexpr std::string_view kDifferentialTurns = "differential-turns";
inline constexpr std::string_view kSteerWhileCoasting = "steer-while-coasting";

/// The first modes on the other plant and, for one set of gains, with slower and faster gains: at
/// most as many samples as are run at a time, the same draws as the comparison's. A setting in
/// which a scenario cannot be run has the reason.
std::vector<Change> changes_of_runs(const Model& model, const std::vector<NamedGains>& gains,
                                    const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options);

/// `ranking` is rank() of the same scenario, and not empty; of `changes` those of the scenario count.
Decision decide(const ScenarioRows& scenario, const std::vector<PairedDifference>& differences,
                const std::vector<RankedMode>& ranking, const std::vector<Change>& changes,
                const Preferences& preferences, std::uint64_t seed);

/// "; undecided: ...", "; combined keeps a first place ...", and who completes no run of a change:
/// the end of a verdict.
std::string decision_text(const Decision& decision);

/// One sentence (or two) on who is best, by what, and how sure that is. A mode that is first and does
/// not survive a change is not called best.
std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::optional<Decision>& decision,
                       const std::vector<PairedDifference>& differences,
                       const Preferences& preferences = {});

}  // namespace awmr
