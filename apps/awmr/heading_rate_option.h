/// Option `--heading-rate-limit`, shared by commands that simulate scenarios (simulate/validity.h).
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/validity.h"

namespace awmr::cli {

/// Adds the option. `by_default`: text for the help that describes the behaviour without the
/// option.
inline void add_heading_rate_limit(CLI::App& command, HeadingRateChoice& choice,
                                   const char* by_default) {
  command
      .add_option("--heading-rate-limit", choice,
                  fmt::format("Rate limit of heading commands in closed-loop scenarios, deg/s; "
                              "'measured': the highest measured yaw rate (yaw_rate_max_degps of "
                              "vehicle.json, else of turning trials and fitted logs); 'none': "
                              "only the shaping in the scenarios (default: {})",
                              by_default))
      ->check(CLI::Validator(fault_of_rate, "measured, none or deg/s", ""));
}

/// Returns the choice for the list of options in an output file; empty without a choice.
inline std::vector<std::pair<std::string, std::string>> options_of_rate(
    const HeadingRateChoice& choice) {
  if (choice.empty()) return {};
  return {{kRateName, choice}};
}

/// Describes the heading-rate limit without the number of 'measured', which needs the model. Empty
/// if only the scenarios limit the rate.
inline std::string words_of_rate(const HeadingRateChoice& choice) {
  if (choice == kNoRate) return {};
  if (choice == kMeasuredRate)
    return "heading commands limited to the highest yaw rate of the "
           "turning trials and fitted logs, or to yaw_rate_max_degps of vehicle.json\n";
  return fmt::format("heading commands limited to {} deg/s\n", choice);
}

}  // namespace awmr::cli
