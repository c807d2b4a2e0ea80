/// `--plant`, shared by commands that simulate scenarios.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"
#include "choices.h"

namespace awmr::cli {

/// Plant that overrides the scenarios'; empty: no override.
using PlantChoice = std::optional<PlantKind>;

inline constexpr const char* kPlantOption = "--plant";
/// Key of the plant among the options recorded in an output.
inline constexpr const char* kPlantName = "plant";

/// Of `compare`: the plants that the scenarios say, and whether the others change the verdict.
inline constexpr const char* kBothPlants = "both";

inline void add_plant_of(CLI::App& command, PlantChoice& choice, std::vector<std::string> names,
                         const std::string& by_default) {
  const auto set = [&choice](const std::string& name) { choice = value_in(kPlantKindNames, name); };
  command
      .add_option_function<std::string>(kPlantOption, set,
                                        "What moves in every scenario: the model's 3-DOF "
                                        "equations, or its body on four tyres with "
                                        "a circle of friction, those of the scenario's tyres or "
                                        "their defaults (default: " +
                                            by_default + ")")
      ->check(one_of(std::move(names)));
}

inline void add_plant(CLI::App& command, PlantChoice& choice) {
  add_plant_of(command, choice, names_in(kPlantKindNames),
               "four-wheel where a scenario has tyres, else model");
}

/// The same of `compare`, which without a choice checks its verdicts on the other plant.
inline void add_plant_or_both(CLI::App& command, PlantChoice& choice) {
  std::vector<std::string> names = names_in(kPlantKindNames);
  names.emplace_back(kBothPlants);
  add_plant_of(command, choice, std::move(names),
               "both: four-wheel where a scenario has tyres, else model, and who is first on the "
               "other one and with slower and faster gains");
}

/// Applies the choice to every scenario. Errors (input): a scenario uses a feature that the
/// four-wheel plant does not support.
inline Status choose(const PlantChoice& choice, std::span<Scenario> scenarios) {
  if (!choice) return {};
  std::vector<Fault> faults;
  for (Scenario& scenario : scenarios) {
    if (*choice == PlantKind::kModel) {
      scenario.tyres.reset();
      continue;
    }
    if (!scenario.tyres) scenario.tyres.emplace();
    for (const TyreConflict& conflict : tyre_conflicts(scenario)) {
      faults.push_back(
          {fmt::format("{} {}", kPlantOption, name_in(kPlantKindNames, *choice)),
           fmt::format("scenario '{}', /{}: {}", scenario.name, conflict.key, conflict.message)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

/// Describes the plant: once if all scenarios share it, else per scenario.
inline std::string plants_text(std::span<const Scenario> scenarios) {
  std::vector<std::string> plants;
  for (const Scenario& scenario : scenarios) plants.push_back(plant_text(scenario));
  if (std::adjacent_find(plants.begin(), plants.end(), std::not_equal_to<>()) == plants.end()) {
    return plants.front();
  }
  std::string text;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    text += fmt::format("{}{}: {}", i == 0 ? "" : "; ", scenarios[i].name, plants[i]);
  }
  return text;
}

/// Entry for the options recorded in an output; empty if all scenarios use the model's plant and
/// there is no choice.
inline std::vector<std::pair<std::string, std::string>> options_of(
    const PlantChoice& choice, std::span<const Scenario> scenarios) {
  const bool is_model = std::none_of(scenarios.begin(), scenarios.end(),
                                     [](const Scenario& s) { return s.tyres.has_value(); });
  if (scenarios.empty() || (is_model && !choice)) return {};
  return {{kPlantName, plants_text(scenarios)}};
}

}  // namespace awmr::cli
