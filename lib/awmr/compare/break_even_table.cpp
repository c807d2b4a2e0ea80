// Text of the break-even analysis for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "awmr/compare/break_even.h"

namespace awmr {
namespace {

/// Text about one pair of modes with the measured scrub: in how many scenarios the first mode is
/// still ahead, is no longer ahead, or the result is undecided. For undecided results, adds the yaw
/// rates at which scrub was not measured, and the number of turns that would decide a result.
/// `all`: the entries of the pair.
std::string decided(const std::vector<const BreakEven*>& all) {
  std::map<Lead, int> count;
  int at_other_rates = 0;
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0.0;
  std::optional<int> turns;
  for (const BreakEven* entry : all) {
    ++count[*lead_of(*entry)];
    if (entry->yaw_coulomb_m && turns_at_other_rates(*entry)) {
      ++at_other_rates;
      slowest = std::min(slowest, entry->fastest_degps);
      fastest = std::max(fastest, entry->fastest_degps);
    }
    if (entry->turns_to_decide) {
      turns = std::min(turns.value_or(*entry->turns_to_decide), *entry->turns_to_decide);
    }
  }
  std::string text = fmt::format(
      "    with the measured scrub, by number of scenarios: still ahead in {}, no longer in {}, "
      "undecided in {}\n",
      count[Lead::kKept], count[Lead::kLost], count[Lead::kOpen]);
  if (at_other_rates > 0) {
    const Interval rates = *all.front()->measured_degps;
    text += fmt::format(
        "    {} of the undecided results are for yaw rates of {:.3g} to {:.3g} deg/s, but scrub "
        "was measured at {:.3g} to {:.3g} deg/s\n",
        at_other_rates, slowest, fastest, rates.lo, rates.hi);
  }
  if (turns) {
    text += fmt::format(
        "    about {} differential turns in total would decide at least one of the undecided "
        "results\n",
        *turns);
  }
  return text;
}

std::string pair_text(const std::pair<YawMode, YawMode>& modes,
                      const std::vector<const BreakEven*>& all) {
  const BreakEven& least =
      **std::min_element(all.begin(), all.end(), [](const auto* a, const auto* b) {
        return a->yaw_coulomb_m.value_or(a->most_m) < b->yaw_coulomb_m.value_or(b->most_m);
      });
  const auto lasting = std::count_if(all.begin(), all.end(), [](const BreakEven* entry) {
    return !entry->yaw_coulomb_m.has_value();
  });
  std::string text = fmt::format("  {} ahead of {} in {} scenario{}: ", name_of(modes.first),
                                 name_of(modes.second), all.size(), all.size() == 1 ? "" : "s");
  if (least.yaw_coulomb_m) {
    text += fmt::format("until {:.3g} m ({})", *least.yaw_coulomb_m, least.scenario);
  }
  if (lasting > 0) {
    text += fmt::format("{}in {} for any scrub up to {:.3g} m", least.yaw_coulomb_m ? "; " : "",
                        lasting, least.most_m);
  }
  text += '\n';
  return all.front()->measured_m ? text + decided(all) : text;
}

std::string measured_text(const BreakEven& entry) {
  if (!entry.measured_m) {
    return "not measured in this vehicle.\n"
           "  Record differential turns with straight wheels (awmr suggest lists them) in the "
           "turning table\n";
  }
  if (!entry.measured_degps) {
    return fmt::format(
        "this vehicle: at least {:.3g} m,\n  because the vehicle did not turn with this moment "
        "(awmr suggest lists larger forces)\n",
        entry.measured_m->lo);
  }
  return fmt::format("measured in this vehicle: {:.3g} to {:.3g} m\n", entry.measured_m->lo,
                     entry.measured_m->hi);
}

}  // namespace

std::string break_even_table(const std::vector<BreakEven>& entries) {
  std::string text =
      "break-even: tyre scrub (Coulomb yaw moment of a differential turn) at which a mode is no "
      "longer ahead\n";
  if (entries.empty()) {
    return text + "  neither differential nor combined is ahead of another mode\n";
  }
  std::map<std::pair<YawMode, YawMode>, std::vector<const BreakEven*>> pairs;
  for (const BreakEven& entry : entries) pairs[{entry.mode, entry.against}].push_back(&entry);
  for (const auto& [modes, all] : pairs) text += pair_text(modes, all);
  return text +
         fmt::format("  largest possible scrub at tyre friction 0.8: {:.3g} m; ",
                     entries.front().sliding_m) +
         measured_text(entries.front());
}

}  // namespace awmr
