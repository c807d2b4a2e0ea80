/// Options of the commands that simulate scenarios: `--plant` (the simulated vehicle model),
/// `--tyres` (its tyres), `--allocation`, and `--heading-rate-limit` (how fast the commanded
/// heading may change, simulate/validity.h).
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

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"
#include "awmr/validate/tyre_fit.h"
#include "option_values.h"

namespace awmr::cli {

struct PlantChoice {
  /// Simulated vehicle model for all scenarios; empty: as each scenario selects.
  std::optional<PlantKind> kind = {};
  /// A validation.json. Its fitted tyres replace the tyres of the scenarios and the default tyres.
  std::optional<std::filesystem::path> tyres_file = {};
  /// True (only for `compare`): unless `kind` is given, the ranking is repeated with the vehicle
  /// model that the scenario does not use.
  bool checks_other = false;
  bool runs_other() const { return checks_other && !kind; }
};

inline constexpr const char* kPlantOption = "--plant";
inline constexpr const char* kTyresOption = "--tyres";
/// Name of this option in the list of options in an output file.
inline constexpr const char* kPlantName = "plant";

/// Value of `--plant` for `compare`: each scenario runs with its own vehicle model, and the ranking
/// is repeated with the model that the scenario does not use.
inline constexpr const char* kBothPlants = "both";

inline void add_plant_of(CLI::App& command, PlantChoice& choice, std::vector<std::string> names,
                         const std::string& by_default) {
  const auto set = [&choice](const std::string& name) {
    choice.kind = value_in(kPlantKindNames, name);
  };
  command
      .add_option_function<std::string>(
          kPlantOption, set,
          "Vehicle to simulate in every scenario. model: the 3-DOF equations of model.json; "
          "four-wheel: a body on four tyres with a friction circle, and with the tyre values of "
          "the scenario or default values (default: " +
              by_default + ")")
      ->check(one_of(std::move(names)));
  add_file(command, kTyresOption, choice.tyres_file,
           "validation.json of validate --tyres: the tyre values of the four-wheel plant");
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
      "both: each scenario on its own plant (four-wheel if it has tyres, else model). Then "
      "the ranking is repeated on the plant that the scenario does not use, and with "
      "slower and faster gains");
}

/// Returns the tyres in the file of `--tyres`, or the default tyres without such a file. For a
/// file, also adds the finding `tyres-simulated` about their prediction errors. Errors: those of
/// read_tyres().
inline Result<Tyres<double>> tyres_of(const PlantChoice& choice, std::vector<Finding>& findings) {
  if (!choice.tyres_file) return Tyres<double>{};
  AWMR_ASSIGN_OR_RETURN(const TyreFit fit, read_tyres(*choice.tyres_file));
  findings.push_back(
      {choice.tyres_file->string(), 0, Severity::kNote, "tyres-simulated",
       fmt::format("the four-wheel plant has fitted tyres (friction coefficient {:.3g}, cornering "
                   "stiffness {:.3g} per rad); on the parts of the logs that were not used in the "
                   "fit, {}",
                   fit.tyres.friction, fit.tyres.cornering_per_rad,
                   fit.better ? fmt::format("the {} plant predicts better: rely on its results",
                                            name_in(kPlantKindNames, *fit.better))
                              : "neither plant predicts better")});
  return fit.tyres;
}

/// Applies the options to every scenario. Errors (input): a scenario uses a feature that the
/// four-wheel model does not support; a file with tyres is given, but no run uses tyres.
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
                       fmt::format("these tyres are for the four-wheel plant, which no run uses: "
                                   "remove this option, or give {} {}",
                                   kPlantOption, name_in(kPlantKindNames, PlantKind::kFourWheel)));
  }
  return {};
}

/// Describes the simulated vehicle model, for each scenario if the scenarios differ.
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

/// Appends the vehicle model to the options of an output file. Appends nothing without `--plant`,
/// if all scenarios use the 3-DOF model.
inline void describe_plant(const PlantChoice& choice, std::span<const Scenario> scenarios,
                           NamedOptions& options) {
  const bool is_model = std::none_of(scenarios.begin(), scenarios.end(),
                                     [](const Scenario& s) { return s.tyres.has_value(); });
  if (scenarios.empty() || (is_model && !choice.kind)) return;
  options.emplace_back(kPlantName, plants_text(scenarios));
}

/// Form of the allocation, that is, of the equations that compute wheel forces and steering angle:
/// exact, or for small angles. A given form replaces the forms of vehicle and scenarios.
using AllocationChoice = std::optional<AllocationForm>;

inline void add_allocation(CLI::App& command, AllocationChoice& choice) {
  add_choice(
      command, "--allocation", choice, kAllocationFormNames,
      "How the controller computes wheel forces and steering angle from thrust and yaw moment: "
      "exactly, or by the paper's equations for small angles (default: as the scenario or "
      "vehicle selects, else exact)");
}

/// Appends `--allocation` to the options of an output file, if it is given.
inline void describe_allocation(const AllocationChoice& choice, NamedOptions& options) {
  if (choice) options.emplace_back("allocation", name_in(kAllocationFormNames, *choice));
}

/// Makes the chosen form apply everywhere: sets it in the model's vehicle, and removes it from the
/// scenarios, whose form would have precedence. Does nothing without a choice.
inline void choose(const AllocationChoice& choice, Model& model, std::span<Scenario> scenarios) {
  if (!choice) return;
  model.vehicle.allocation = *choice;
  for (Scenario& scenario : scenarios) scenario.control.allocation.reset();
}

/// Adds `--heading-rate-limit`. `by_default`: text for the help about the case without the option.
inline void add_heading_rate_limit(CLI::App& command, HeadingRateChoice& choice,
                                   const char* by_default) {
  command
      .add_option(
          "--heading-rate-limit", choice,
          fmt::format("Limit of the rate of heading commands in closed-loop scenarios, deg/s. "
                      "'measured': yaw_rate_max_degps of vehicle.json or, if it is not given, the "
                      "highest yaw rate of the turning trials and fitted logs. 'none': only the "
                      "limits in the scenarios (default: {})",
                      by_default))
      ->check(CLI::Validator(fault_of_rate, "measured, none or deg/s", ""));
}

/// Appends `--heading-rate-limit` to the options of an output file, if it is given.
inline void describe_rate(const HeadingRateChoice& choice, NamedOptions& options) {
  if (!choice.empty()) options.emplace_back(kRateName, choice);
}

/// Describes the heading-rate limit. For 'measured', the text has no number, because the number is
/// in the model. Empty if only the scenarios limit the rate.
inline std::string words_of_rate(const HeadingRateChoice& choice) {
  if (choice == kNoRate) return {};
  if (choice == kMeasuredRate)
    return "heading commands limited to the highest yaw rate of the "
           "turning trials and fitted logs, or to yaw_rate_max_degps of vehicle.json\n";
  return fmt::format("heading commands limited to {} deg/s\n", choice);
}

}  // namespace awmr::cli
