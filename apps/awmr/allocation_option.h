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

/// Form of the equations that compute wheel forces and steering angle (exact, or for small angles),
/// if given on the command line. Overrides the form in the vehicle and the scenarios. Empty: no
/// override.
using AllocationChoice = std::optional<AllocationForm>;

inline void add_allocation(CLI::App& command, AllocationChoice& choice) {
  const auto set = [&choice](const std::string& name) {
    choice = value_in(kAllocationFormNames, name);
  };
  command
      .add_option_function<std::string>(
          "--allocation", set,
          "How the controller computes wheel forces and steering angle from thrust and yaw moment: "
          "exactly, or by the paper's equations for small angles (default: as the scenario or "
          "vehicle selects, else exact)")
      ->check(one_of(names_in(kAllocationFormNames)));
}

/// Returns the option and its value, for the list of options in an output file; empty if the option
/// is not given.
inline std::vector<std::pair<std::string, std::string>> options_of(const AllocationChoice& choice) {
  if (!choice) return {};
  return {{"allocation", std::string(name_in(kAllocationFormNames, *choice))}};
}

/// Makes the chosen form apply everywhere: sets it in the model's vehicle, and removes the forms in
/// the scenarios, which would have precedence. Does nothing without a choice.
inline void choose(const AllocationChoice& choice, Model& model, std::span<Scenario> scenarios) {
  if (!choice) return;
  model.vehicle.allocation = *choice;
  for (Scenario& scenario : scenarios) scenario.control.allocation.reset();
}

}  // namespace awmr::cli
