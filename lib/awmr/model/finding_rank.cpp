#include "awmr/model/finding_rank.h"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

namespace awmr {
namespace {

struct CodeEffect {
  std::string_view code;
  Effect effect;
};

constexpr CodeEffect kEffects[] = {
    {"not-identifiable", Effect::kWithdrawn},
    {"no-interval", Effect::kWithdrawn},
    {"not-converged", Effect::kWithdrawn},
    {"no-degrees-of-freedom", Effect::kWithdrawn},
    {"too-few-rows", Effect::kWithdrawn},
    {"exponent-at-bound", Effect::kWithdrawn},
    {"turns-like-a-car", Effect::kWithdrawn},
    {"model-inadequate", Effect::kWithdrawn},
    {"power-law-inadequate", Effect::kWithdrawn},
    {"family-by-coastdown", Effect::kWithdrawn},
    {"estimates-disagree", Effect::kWithdrawn},
    {"logs-disagree", Effect::kWithdrawn},
    {"speed-controlled", Effect::kWithdrawn},
    {"held-out-misses", Effect::kWithdrawn},
    {"changed-in-log", Effect::kWithdrawn},
    {"fragile-mass", Effect::kWithdrawn},
    {"gains-of-another-mode", Effect::kWithdrawn},
    {"gains-of-another-model", Effect::kWithdrawn},
    {"gains-changed", Effect::kWithdrawn},
    {"result-of-another-model", Effect::kWithdrawn},
    {"result-without-origin", Effect::kWithdrawn},
    {"log-of-the-fit", Effect::kWithdrawn},
    {"unstable-gains", Effect::kWithdrawn},
    {"incomplete-if-changed", Effect::kWithdrawn},
    {"table-contradiction", Effect::kContradiction},
    {"log-contradiction", Effect::kContradiction},
    {"contradiction", Effect::kContradiction},
    {"inertia-mismatch", Effect::kContradiction},
    {"scale-mismatch", Effect::kContradiction},
    {"servo-rate", Effect::kContradiction},
    {"heading-offset", Effect::kContradiction},
    {"implausible-vehicle", Effect::kContradiction},
    {"implausible-deceleration", Effect::kContradiction},
    {"coast-below-surge", Effect::kContradiction},
    {"negative-scrub", Effect::kContradiction},
    {"assumed-sway", Effect::kAssumption},
    {"noise-model", Effect::kAssumption},
    {"not-timed", Effect::kAssumption},
    {"single-stop-time", Effect::kAssumption},
    {"family-undecided", Effect::kAssumption},
};

}  // namespace

Effect effect_of(const Finding& finding) {
  if (finding.severity == Severity::kError) return Effect::kRefusal;
  for (const CodeEffect& one : kEffects) {
    if (one.code != finding.code) continue;
    if (finding.severity == Severity::kWarning || one.effect == Effect::kAssumption) {
      return one.effect;
    }
  }
  return finding.severity == Severity::kWarning ? Effect::kDoubt : Effect::kNote;
}

std::vector<const Finding*> by_effect(const std::vector<Finding>& findings) {
  enum class Group { kRefused, kFirstOfCode, kRepeated, kNote };
  using Turn = std::tuple<Group, Effect, const Finding*>;
  std::set<std::string_view> seen;
  std::vector<Turn> turns;
  for (const Finding& finding : findings) {
    const bool is_repeated = !seen.insert(finding.code).second;
    const Effect effect = effect_of(finding);
    const Group group = effect == Effect::kRefusal ? Group::kRefused
                        : effect == Effect::kNote  ? Group::kNote
                        : is_repeated              ? Group::kRepeated
                                                   : Group::kFirstOfCode;
    turns.emplace_back(group, effect, &finding);
  }
  std::stable_sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  });
  std::vector<const Finding*> order;
  for (const Turn& turn : turns) order.push_back(std::get<2>(turn));
  return order;
}

}  // namespace awmr
