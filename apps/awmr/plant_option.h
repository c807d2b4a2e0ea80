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

inline void add_plant(CLI::App& command, PlantChoice& choice) {
  const auto set = [&choice](const std::string& name) { choice = value_in(kPlantKindNames, name); };
  command
      .add_option_function<std::string>(kPlantOption, set,
                                        "What moves in every scenario: the model's 3-DOF "
                                        "equations, or its body on four tyres with "
                                        "a circle of friction, those of the scenario's tyres or "
                                        "their defaults (default: four-wheel "
                                        "where a scenario has tyres, else model)")
      ->check(one_of(names_in(kPlantKindNames)));
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
