// suggest.json and the sheet for the field.

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/json.h"
#include "awmr/identify/planning/suggest.h"

namespace awmr {

std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance) {
  Json json = output_document("awmr.suggest/1", provenance);
  json["criterion"] = suggestion.criterion;
  json["assumptions"] = suggestion.assumptions;
  for (const MissingParameter& one : suggestion.missing) {
    json["missing"].push_back({{"parameter", info(one.id).name}, {"trial", one.trial}});
  }
  for (const ScrubTurn& turn : suggestion.scrub_turns) {
    json["scrub_turns"].push_back({{"force_left", turn.force.left},
                                   {"force_right", turn.force.right},
                                   {"yaw_rate_degps", turn.yaw_rate_degps}});
  }
  json["trials"] = Json::array();
  for (const SuggestedTrial& trial : suggestion.trials) {
    Json settings;
    for (const auto& [name, value] : trial.numbers) settings[name] = value;
    json["trials"].push_back({{"kind", name_in(kTrialKindNames, trial.kind)},
                              {"settings", settings},
                              {"words", trial.settings},
                              {"parameter", trial.parameter},
                              {"std_error_before", trial.std_error_before},
                              {"std_error_after", trial.std_error_after},
                              {"information_gain", trial.d_gain}});
  }
  return to_text(json);
}

namespace {

/// The trials that the model has not had, each with the parameters that it shows.
std::string missing_sheet(const std::vector<MissingParameter>& missing) {
  std::string text;
  for (auto one = missing.begin(); one != missing.end(); ++one) {
    const auto has_its_trial = [one](const MissingParameter& other) {
      return other.trial == one->trial;
    };
    if (std::find_if(missing.begin(), one, has_its_trial) != one) continue;  // told already
    std::string names;
    for (auto other = one; other != missing.end(); ++other) {
      if (!has_its_trial(*other)) continue;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", info(other->id).name);
    }
    text += fmt::format("[ ] for {}, of no value yet:\n       {}\n", names, one->trial);
  }
  return text;
}

/// The turns that tell whether the sides or the steering should turn the vehicle.
std::string scrub_sheet(const std::vector<ScrubTurn>& turns) {
  if (turns.empty()) return {};
  std::string text =
      "\nfor the choice between differential, steering and combined: steady circles by the sides'\n"
      "forces alone, wheels straight, as rows of the turning table (steering_deg 0)\n";
  for (const ScrubTurn& turn : turns) {
    text += fmt::format(
        "[ ]    turning   force_left {:.3g}, force_right {:.3g}: {:.3g} deg/s if nothing scrubs\n",
        turn.force.left, turn.force.right, turn.yaw_rate_degps);
  }
  return text;
}

}  // namespace

std::string field_sheet(const Suggestion& suggestion, std::size_t most) {
  std::string text = fmt::format("FIELD SHEET    ranked by: {}\n", suggestion.criterion);
  for (const std::string& assumption : suggestion.assumptions) {
    text += fmt::format("  assumed: {}\n", assumption);
  }
  text += '\n' + missing_sheet(suggestion.missing);
  std::size_t number = 1;
  for (const SuggestedTrial& trial : suggestion.trials) {
    if (number > most) break;
    text += fmt::format("[ ] {}. {:<9} {}\n", number++, name_in(kTrialKindNames, trial.kind),
                        trial.settings);
    text +=
        fmt::format("       {}: standard error {:.3g} -> {:.3g};  information +{:.1f}\n",
                    trial.parameter, trial.std_error_before, trial.std_error_after, trial.d_gain);
  }
  return text + scrub_sheet(suggestion.scrub_turns);
}

}  // namespace awmr
