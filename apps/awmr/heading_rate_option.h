/// Option `--heading-rate-limit` of the commands that simulate scenarios. It limits how fast the
/// commanded heading may change (simulate/validity.h).
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "awmr/simulate/validity.h"

namespace awmr::cli {

/// Adds the option. `by_default`: text for the help, which describes what happens without the
/// option.
inline void add_heading_rate_limit(CLI::App& command, HeadingRateChoice& choice,
                                   const char* by_default) {
  command
      .add_option(
          "--heading-rate-limit", choice,
          fmt::format("Limit of the rate of heading commands in closed-loop scenarios, deg/s. "
                      "'measured': the highest yaw rate in vehicle.json (yaw_rate_max_degps) or, "
                      "without it, in the turning trials and fitted logs. 'none': no limit except "
                      "those in the scenarios (default: {})",
                      by_default))
      ->check(CLI::Validator(fault_of_rate, "measured, none or deg/s", ""));
}

/// Returns the option and its value, for the list of options in an output file; empty if the option
/// is not given.
inline std::vector<std::pair<std::string, std::string>> options_of_rate(
    const HeadingRateChoice& choice) {
  if (choice.empty()) return {};
  return {{kRateName, choice}};
}

/// Describes the heading-rate limit. If the choice is 'measured', the text has no number, because
/// the number is in the model. Empty if only the scenarios limit the rate.
inline std::string words_of_rate(const HeadingRateChoice& choice) {
  if (choice == kNoRate) return {};
  if (choice == kMeasuredRate)
    return "heading commands limited to the highest yaw rate of the "
           "turning trials and fitted logs, or to yaw_rate_max_degps of vehicle.json\n";
  return fmt::format("heading commands limited to {} deg/s\n", choice);
}

}  // namespace awmr::cli
