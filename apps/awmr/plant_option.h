/// `--plant` and `--tyres`, shared by commands that simulate scenarios.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"
#include "awmr/validate/tyre_fit.h"
#include "choices.h"
#include "paths.h"

namespace awmr::cli {

struct PlantChoice {
  std::optional<PlantKind> kind = {};  ///< plant of every scenario; empty: each scenario's own
  /// validation.json whose tyres override the scenarios' and the defaults.
  std::optional<std::filesystem::path> tyres_file = {};
  bool checks_other = false;  ///< true (only `compare`): if `kind` is empty, the ranking is also
                              ///< tested on the other plant
  bool runs_other() const { return checks_other && !kind; }
};

inline constexpr const char* kPlantOption = "--plant";
inline constexpr const char* kTyresOption = "--tyres";
/// Name of the plant in the list of options in an output file.
inline constexpr const char* kPlantName = "plant";

/// Value of `--plant` for `compare`: each scenario on its own plant, with a check of the ranking on
/// the other plant.
inline constexpr const char* kBothPlants = "both";

inline void add_plant_of(CLI::App& command, PlantChoice& choice, std::vector<std::string> names,
                         const std::string& by_default) {
  const auto set = [&choice](const std::string& name) {
    choice.kind = value_in(kPlantKindNames, name);
  };
  command
      .add_option_function<std::string>(kPlantOption, set,
                                        "Simulated plant in every scenario: the model's 3-DOF "
                                        "equations, or the body on four tyres with a friction "
                                        "circle, with the scenario's tyres or their defaults "
                                        "(default: " +
                                            by_default + ")")
      ->check(one_of(std::move(names)));
  add_file(command, kTyresOption, choice.tyres_file,
           "validation.json of validate --tyres: the tyres of the four-wheel plant");
}

inline void add_plant(CLI::App& command, PlantChoice& choice) {
  add_plant_of(command, choice, names_in(kPlantKindNames),
               "four-wheel if a scenario has tyres, else model");
}

/// Adds `--plant` for `compare`, with `both` as default.
inline void add_plant_or_both(CLI::App& command, PlantChoice& choice) {
  std::vector<std::string> names = names_in(kPlantKindNames);
  names.emplace_back(kBothPlants);
  add_plant_of(
      command, choice, std::move(names),
      "both: each scenario on its own plant (four-wheel if it has tyres, else model), and a "
      "check of the ranking on the other plant and with slower and faster gains");
}

/// Reads the tyres from the file and adds a finding on their prediction errors (`tyres-simulated`).
/// Without a file, returns the default tyres. Errors: those of read_tyres().
inline Result<Tyres<double>> tyres_of(const PlantChoice& choice, std::vector<Finding>& findings) {
  if (!choice.tyres_file) return Tyres<double>{};
  AWMR_ASSIGN_OR_RETURN(const TyreFit fit, read_tyres(*choice.tyres_file));
  findings.push_back(
      {choice.tyres_file->string(), 0, Severity::kNote, "tyres-simulated",
       fmt::format("the four-wheel plant has fitted tyres (friction {:.3g}, {:.3g} per rad); on "
                   "the parts of the logs that were held out from the fit, {}",
                   fit.tyres.friction, fit.tyres.cornering_per_rad,
                   fit.better ? fmt::format("the {} plant predicts better: rely on results of it",
                                            name_in(kPlantKindNames, *fit.better))
                              : "neither plant predicts better")});
  return fit.tyres;
}

/// Applies the choice to every scenario. Errors (input): a scenario uses a feature that the
/// four-wheel plant does not support; no run uses the tyres of the file.
inline Status choose(const PlantChoice& choice, const Tyres<double>& tyres,
                     std::span<Scenario> scenarios) {
  std::vector<Fault> faults;
  for (Scenario& scenario : scenarios) {
    if (choice.kind == PlantKind::kModel) scenario.tyres.reset();
    if (scenario.tyres && choice.tyres_file) scenario.tyres = tyres;
    if (choice.kind != PlantKind::kFourWheel) continue;
    if (!scenario.tyres) scenario.tyres = tyres;
    for (const TyreConflict& conflict : tyre_conflicts(scenario)) {
      faults.push_back(
          {ErrorCode::kConflict,
           fmt::format("{} {}", kPlantOption, name_in(kPlantKindNames, *choice.kind)),
           fmt::format("scenario '{}', /{}: {}", scenario.name, conflict.key, conflict.message)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  const bool has_tyres =
      std::ranges::any_of(scenarios, [](const Scenario& s) { return s.tyres.has_value(); });
  if (choice.tyres_file && !has_tyres && !choice.runs_other()) {
    return input_error(ErrorCode::kConflict, kTyresOption,
                       fmt::format("no run uses the four-wheel plant, which these tyres are for: "
                                   "remove this option, or give {} {}",
                                   kPlantOption, name_in(kPlantKindNames, PlantKind::kFourWheel)));
  }
  return {};
}

/// Describes the plant: once if it is the same for all scenarios, else for each scenario.
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

/// Returns the plant for the list of options in an output file. Empty if `--plant` is not given and
/// all scenarios use the 3-DOF model.
inline std::vector<std::pair<std::string, std::string>> options_of(
    const PlantChoice& choice, std::span<const Scenario> scenarios) {
  const bool is_model = std::none_of(scenarios.begin(), scenarios.end(),
                                     [](const Scenario& s) { return s.tyres.has_value(); });
  if (scenarios.empty() || (is_model && !choice.kind)) return {};
  return {{kPlantName, plants_text(scenarios)}};
}

}  // namespace awmr::cli
