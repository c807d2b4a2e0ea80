#include "awmr/tune/unsettled_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "awmr/simulate/meter.h"
#include "awmr/tune/settling.h"

namespace awmr {
namespace {

/// Half width of the settling band, for messages.
std::string settling_band() {
  return fmt::format("the larger of {:g} deg and {:g} % of the step", meter::kSettledLeastDeg,
                     100.0 * meter::kSettledShare);
}

/// Returns the part of a message that reports the effect of friction.
std::string friction_text(const FrictionEffect& friction) {
  std::string text = fmt::format(
      ". Without the dry (Coulomb) friction in yaw, {:.0f} % settle: it can hold the vehicle "
      "{:.2g} deg from the commanded heading, and the settling band is {}",
      100.0 * friction.share_without, friction.error_deg, settling_band());
  if (friction.observer_radps > 0.0) {
    text += fmt::format(
        ". The disturbance observer (bandwidth {:.3g} rad/s) needs {:.2g} s to remove 95 % of this "
        "error",
        friction.observer_radps, 3.0 / friction.observer_radps);
  }
  return text;
}

/// Returns the part of a message that reports the effect of sensor noise.
std::string noise_text(const NoiseEffect& noise) {
  const std::string longer = fmt::format(
      " in {:g} times the duration (the limits make the gains slow)", noise.time_factor);
  return fmt::format(
      ". With noise-free sensors{}, {:.0f} % settle{}: {} the heading out of the settling band, "
      "{}. Use sensors with less noise, or filter their readings and enter the new `noise` and "
      "`noise_correlation_s` in vehicle.json{}",
      noise.is_of_identified ? " and the identified values of all parameters" : "",
      100.0 * noise.share_without, noise.time_factor > 1.0 ? longer : "",
      noise.is_of_identified ? "noise and errors of the model together move" : "the noise moves",
      settling_band(),
      noise.is_of_identified ? ", and record trials that reduce the errors (awmr suggest)" : "");
}

/// Returns the end of a message about runs that do not settle: why the mode cannot turn the
/// vehicle, or the changes with which the runs settle.
std::string advice_for(const UnsettledRuns& found) {
  if (!found.why.empty()) return ": " + found.why;
  std::string advice = found.friction ? friction_text(*found.friction) : "";
  if (const auto& variation = found.variation) {
    advice += fmt::format(
        ". Without `{}` of tune.json, {:.0f} % settle, so this variation of the vehicle keeps runs "
        "from settling. Give a smaller variation",
        variation->key, 100.0 * variation->share_without);
    if (found.changes.empty()) return advice;
  }
  if (found.noise) return advice + noise_text(*found.noise);
  if (const auto& error = found.error) {
    advice += fmt::format(
        ". With the identified values of all parameters, {:.0f} % settle, so errors of the model "
        "keep runs from settling. The error of {} has the largest effect: with its "
        "identified value alone, {:.0f} % settle. Record {}, and identify again",
        100.0 * error->share_of_identified, error->quantity, 100.0 * error->settled_share,
        error->trial);
    if (found.changes.empty()) return advice;
  }
  const std::string runs = fmt::format("{:g} % of the runs of {} vehicle{}", 100.0 * kSettledShare,
                                       found.vehicles, found.vehicles == 1 ? "" : "s");
  return advice + ". " +
         (found.changes.empty() ? no_change_settles(runs) : describe(found.changes, runs));
}

/// Place in tune.json that the advice is about; empty if it is about other files.
std::string pointer_of(const UnsettledRuns& found) {
  if (found.variation) return "/" + found.variation->key;
  return found.changes.empty() ? "" : found.changes.front().pointer;
}

}  // namespace

std::string run_name(const std::string& scenario, YawMode mode) {
  return fmt::format("{}{}{}", scenario, scenario.empty() ? "" : ", ", name_of(mode));
}

std::vector<UnsettledText> unsettled_texts(std::span<const UnsettledRuns> unsettled) {
  struct Group {
    std::string runs;
    std::string advice;
    std::string pointer;
  };
  std::vector<Group> groups;
  for (const UnsettledRuns& one : unsettled) {
    const std::string runs =
        fmt::format("{:.0f} % ({})", 100.0 * one.settled_share, run_name(one.scenario, one.mode));
    const std::string advice = advice_for(one);
    const auto known = std::ranges::find(groups, advice, &Group::advice);
    if (known == groups.end()) {
      groups.push_back({runs, advice, pointer_of(one)});
    } else {
      known->runs += ", " + runs;
    }
  }
  std::vector<UnsettledText> texts;
  for (const auto& [runs, advice, pointer] : groups) {
    texts.push_back(
        {fmt::format("of the runs with the tuned gains, {} settle after every heading step{}", runs,
                     advice),
         pointer});
  }
  return texts;
}

}  // namespace awmr
