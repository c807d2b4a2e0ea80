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

/// Factor by which weights are multiplied or divided, independently of each other.
inline constexpr double kWeightFactor = 2.0;
/// Factor by which the rates of both closed loops are multiplied or divided: sqrt(2).
inline constexpr double kGainsFactor = 1.4142135623730951;

enum class DecisionKind {
  kDecided,    ///< one mode is of rank 1 in all settings
  kLevel,      ///< several modes are
  kUndecided,  ///< no mode is
};
inline constexpr NameTable<DecisionKind, 3> kDecisionKindNames{
    {{"decided", DecisionKind::kDecided},
     {"level", DecisionKind::kLevel},
     {"undecided", DecisionKind::kUndecided}}};

/// Result of a scenario: the modes of rank 1, and whether they remain so under every change.
struct Decision {
  std::vector<Contender> first;  ///< of rank 1 in the ranking
  std::vector<Change> changes;   ///< changes with a ranking; never empty, because that of weights
                                 ///< needs no runs

  /// Contenders of rank 1 in the ranking and under every change.
  std::vector<Contender> never_behind() const;
  DecisionKind kind() const;
  /// True if one of `first` is of rank 1 under the change.
  bool survives(const Change& change) const;
  /// Trials that discriminate between the two plants, if their best modes differ.
  std::vector<std::string_view> deciding_trials() const;
};

/// Names of trials in comparison.json, which `awmr suggest` describes.
inline constexpr std::string_view kDifferentialTurns = "differential-turns";
inline constexpr std::string_view kSteerWhileCoasting = "steer-while-coasting";

/// The best modes on the other plant and, for a single set of gains, with slower and faster gains.
/// Uses the draws of the comparison, at most one batch of samples. A setting in which a scenario
/// cannot be run has the reason.
std::vector<Change> changes_of_runs(const Model& model, const std::vector<NamedGains>& gains,
                                    const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options);

/// `ranking`: rank() of the same scenario, not empty. Only `changes` of the scenario are used.
Decision decide(const ScenarioRows& scenario, const std::vector<PairedDifference>& differences,
                const std::vector<RankedMode>& ranking, const std::vector<Change>& changes,
                const Preferences& preferences, std::uint64_t seed);

/// End of a verdict: "; undecided: ...", "; combined keeps a first place ...", and modes that
/// complete no run under a change.
std::string decision_text(const Decision& decision);

/// One or two sentences: the best mode, its lead and the confidence in it. A mode that loses
/// rank 1 under a change is not called best.
std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::optional<Decision>& decision,
                       const std::vector<PairedDifference>& differences,
                       const Preferences& preferences = {});

}  // namespace awmr
