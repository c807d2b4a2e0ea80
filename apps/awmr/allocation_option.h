/// Command-line option `--allocation`, shared by several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "choices.h"

namespace awmr::cli {

/// Allocation form that overrides those of the vehicle and the scenarios; empty: no override.
using AllocationChoice = std::optional<AllocationForm>;

inline void add_allocation(CLI::App& command, AllocationChoice& choice) {
  const auto set = [&choice](const std::string& name) {
    choice = value_in(kAllocationFormNames, name);
  };
  command
      .add_option_function<std::string>(
          "--allocation", set,
          "Compute wheel forces and steering angle from thrust and yaw moment exactly, or by the "
          "paper's equations for small angles (default: from scenario or vehicle, else exact)")
      ->check(one_of(names_in(kAllocationFormNames)));
}

/// Returns the choice for the list of options in an output file; empty without a choice.
inline std::vector<std::pair<std::string, std::string>> options_of(const AllocationChoice& choice) {
  if (!choice) return {};
  return {{"allocation", std::string(name_in(kAllocationFormNames, *choice))}};
}

/// Sets the chosen form in the model's vehicle, and removes the scenarios' own forms, so that it
/// applies everywhere. Does nothing without a choice.
inline void choose(const AllocationChoice& choice, Model& model, std::span<Scenario> scenarios) {
  if (!choice) return;
  model.vehicle.allocation = *choice;
  for (Scenario& scenario : scenarios) scenario.control.allocation.reset();
}

}  // namespace awmr::cli
