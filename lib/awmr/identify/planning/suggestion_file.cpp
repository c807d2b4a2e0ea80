// Text and JSON Schema of suggest.json, and the field sheet of `awmr suggest`.

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/json/json.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/findings_json.h"

namespace awmr {

std::string suggestion_text(const Suggestion& suggestion, const Provenance& provenance) {
  Json json = output_document("awmr.suggest/1", provenance);
  json["criterion"] = suggestion.criterion;
  json["assumptions"] = suggestion.assumptions;
  for (const MissingParameter& one : suggestion.missing) {
    json["missing"].push_back({{"parameter", info(one.id).name}, {"trial", one.trial}});
  }
  for (const ScrubTurn& turn : suggestion.scrub_turns) {
    json["scrub_turns"].push_back({{"yaw_rate_degps", turn.yaw_rate_degps},
                                   {"force_left", turn.least.left},
                                   {"force_right", turn.least.right},
                                   {"most_force_left", turn.most.left},
                                   {"most_force_right", turn.most.right}});
  }
  if (!suggestion.about_scrub.empty()) json["about_scrub"] = suggestion.about_scrub;
  if (const auto& coasting = suggestion.coasting) {
    json["steer_while_coasting"] = {{"speed_mps", coasting->speed_mps},
                                    {"steering_deg", coasting->steering_deg},
                                    {"rolling_yaw_rate_degps", coasting->rolling_yaw_rate_degps}};
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

/// Part of the field sheet: trials for parameters without a value. One trial may measure several of
/// these parameters.
std::string missing_sheet(const std::vector<MissingParameter>& missing) {
  std::string text;
  for (auto one = missing.begin(); one != missing.end(); ++one) {
    const auto has_its_trial = [one](const MissingParameter& other) {
      return other.trial == one->trial;
    };
    if (std::find_if(missing.begin(), one, has_its_trial) != one) continue;  // listed before
    std::string names;
    for (auto other = one; other != missing.end(); ++other) {
      if (!has_its_trial(*other)) continue;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", info(other->id).name);
    }
    text += fmt::format(
        "[ ] for {}, not identified yet:\n"
        "       {}\n",
        names, one->trial);
  }
  return text;
}

/// Part of the field sheet: differential turns that measure the tyre scrub.
std::string scrub_sheet(const Suggestion& suggestion) {
  if (suggestion.about_scrub.empty()) return {};
  std::string text = fmt::format(
      "\nfor the choice between differential, steering and combined yaw control:\n  "
      "{}\n",
      suggestion.about_scrub);
  if (suggestion.scrub_turns.empty()) return text;
  text +=
      "  Drive steady differential turns with straight wheels (rows of the turning table, "
      "steering_deg 0).\n"
      "  Increase the forces from the first pair towards the second until the vehicle turns at:\n";
  for (const ScrubTurn& turn : suggestion.scrub_turns) {
    text += fmt::format(
        "[ ]    turning   {:.3g} deg/s: force_left {:.3g}, force_right {:.3g} to {:.3g}, {:.3g}\n",
        turn.yaw_rate_degps, turn.least.left, turn.least.right, turn.most.left, turn.most.right);
  }
  return text;
}

/// Part of the field sheet: the turn with the motors off (CoastingTurn).
std::string coasting_sheet(const Suggestion& suggestion) {
  const auto& coasting = suggestion.coasting;
  if (!coasting) return {};
  return fmt::format(
      "\n"
      "for the choice between the 3-DOF model and the four-wheel plant (simulate --plant):\n"
      "[ ]    steer while coasting: at {:.3g} m/s switch the motors off, steer {:.3g} deg at once, "
      "log yaw\n"
      "       rate and speed. Predicted yaw rate: 3-DOF model 0 deg/s, wheels that roll without "
      "slip {:.3g} deg/s\n",
      coasting->speed_mps, coasting->steering_deg, coasting->rolling_yaw_rate_degps);
}

void describe_suggestion(JsonObject& json) {
  json.schema("awmr.suggest/1");
  read_provenance(json);
  json.string("criterion");
  json.strings("assumptions");
  for (JsonObject& missing : json.optional_objects("missing")) {
    missing.string("parameter");
    missing.string("trial");
    missing.reject_unknown_keys();
  }
  for (JsonObject& turn : json.optional_objects("scrub_turns")) {
    for (const char* key :
         {"force_left", "force_right", "most_force_left", "most_force_right", "yaw_rate_degps"}) {
      turn.number(key);
    }
    turn.reject_unknown_keys();
  }
  json.optional_string("about_scrub");
  if (auto coasting = json.optional_object("steer_while_coasting")) {
    for (const char* key : {"speed_mps", "steering_deg", "rolling_yaw_rate_degps"}) {
      coasting->number(key, kPositive);
    }
    coasting->reject_unknown_keys();
  }
  for (JsonObject& trial : json.objects("trials")) {
    trial.choice("kind", kTrialKindNames);
    JsonObject settings = trial.object("settings");
    for (const std::string& name : settings.keys()) settings.number(name);
    trial.string("words");
    trial.string("parameter");
    for (const char* key : {"std_error_before", "std_error_after", "information_gain"}) {
      trial.number(key);
    }
    trial.reject_unknown_keys();
  }
  read_findings(json);
  json.reject_unknown_keys();
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
        fmt::format("       {}: standard error {:.3g} -> {:.3g};  information gain {:.1f}\n",
                    trial.parameter, trial.std_error_before, trial.std_error_after, trial.d_gain);
  }
  return text + scrub_sheet(suggestion) + coasting_sheet(suggestion);
}

std::string suggest_schema() {
  return json_schema_text("awmr.suggest/1", "The trials to record next", describe_suggestion);
}

}  // namespace awmr
