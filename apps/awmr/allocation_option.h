/// `--allocation`, which several commands take.
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

/// How forces follow from the laws, in place of what vehicle and scenarios say; none: as they say.
using AllocationChoice = std::optional<AllocationForm>;

inline void add_allocation(CLI::App& command, AllocationChoice& choice) {
  const auto set = [&choice](const std::string& name) {
    choice = value_in(kAllocationFormNames, name);
  };
  command
      .add_option_function<std::string>(
          "--allocation", set,
          "Forces and angle by the exact inverse, or by the paper's small angles (default: as "
          "scenario and vehicle say, else exact)")
      ->check(one_of(names_in(kAllocationFormNames)));
}

/// For an output's options; nothing where there is no choice.
inline std::vector<std::pair<std::string, std::string>> options_of(const AllocationChoice& choice) {
  if (!choice) return {};
  return {{"allocation", std::string(name_in(kAllocationFormNames, *choice))}};
}

/// Puts the choice into the model's vehicle and every scenario.
inline void choose(const AllocationChoice& choice, Model& model, std::span<Scenario> scenarios) {
  if (!choice) return;
  model.vehicle.allocation = *choice;
  for (Scenario& scenario : scenarios) scenario.control.allocation.reset();
}

}  // namespace awmr::cli
