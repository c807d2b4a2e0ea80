#include "awmr/compare/ranking_entry.h"

#include <algorithm>
#include <tuple>

#include "awmr/core/binomial.h"

namespace awmr {
namespace {

RankingEntry entry_of(const ScenarioRows& scenario, std::size_t mode,
                      const std::vector<ScoredMetric>& scoring) {
  const ModeRows& rows = scenario.modes[mode];
  RankingEntry entry{
      .mode = mode, .rows = &rows, .log_scores = log_scores(rows, scoring), .mean_losses = {}};
  for (const ScoredMetric& scored : scoring) {
    entry.mean_losses.push_back(mean_log_loss(rows, scored));
  }
  return entry;
}

/// Order of modes with equal scores: by mode, then by name of the gains, so that the order in which
/// the user gives the gains does not matter.
bool is_before(const ModeRows& a, const ModeRows& b) {
  return std::tie(a.contender.mode, a.contender.gains) <
         std::tie(b.contender.mode, b.contender.gains);
}

}  // namespace

bool complete_alike(const ModeRows& a, const ModeRows& b) {
  const auto first = a.counted();
  const auto second = b.counted();
  const std::size_t apart = a.completed_count() > b.completed_count()
                                ? a.completed_count() - b.completed_count()
                                : b.completed_count() - a.completed_count();
  if ((a.completed_count() == 0) != (b.completed_count() == 0)) return false;
  if (first.size() < 2) return apart == 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].metrics.completed && !second[i].metrics.completed) ++only_first;
    if (second[i].metrics.completed && !first[i].metrics.completed) ++only_second;
  }
  return mcnemar_p(only_first, only_second) >= kSignificance;
}

std::vector<RankingEntry> sorted_entries(const ScenarioRows& scenario,
                                         const std::vector<ScoredMetric>& scoring) {
  std::vector<RankingEntry> entries;
  for (std::size_t mode = 0; mode < scenario.modes.size(); ++mode) {
    entries.push_back(entry_of(scenario, mode, scoring));
  }
  const auto most = std::max_element(
      scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& a, const ModeRows& b) {
        const std::size_t first = a.completed_count();
        const std::size_t second = b.completed_count();
        return first < second || (first == second && is_before(b, a));
      });
  for (RankingEntry& entry : entries) entry.completes = complete_alike(*entry.rows, *most);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const RankingEntry& a, const RankingEntry& b) {
                     if (a.completes != b.completes) return a.completes;
                     if (!a.completes && a.rows->completed_count() != b.rows->completed_count()) {
                       return a.rows->completed_count() > b.rows->completed_count();
                     }
                     const double first = a.log_score();
                     const double second = b.log_score();
                     return first < second || (!(second < first) && is_before(*a.rows, *b.rows));
                   });
  return entries;
}

}  // namespace awmr
