/// `--heading-rate-limit`, which commands take that drive scenarios.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/validity.h"
#include "numbers.h"

namespace awmr::cli {

/// As typed: deg/s, or "measured"; empty: no limit but the scenarios' own.
using HeadingRateChoice = std::string;

inline constexpr const char* kMeasuredRate = "measured";

inline void add_heading_rate_limit(CLI::App& command, HeadingRateChoice& choice) {
  const auto check = [](const std::string& text) -> std::string {
    if (text == kMeasuredRate) return {};
    std::string number = text;
    return within(0.1, 3600.0)(number).empty()
               ? std::string()
               : fmt::format("must be {}, or deg/s from 0.1 to 3600, found {}", kMeasuredRate,
                             text.empty() ? "nothing" : text);
  };
  command
      .add_option("--heading-rate-limit", choice,
                  "deg/s up to which a heading may be led to in every scenario that is not in open "
                  "loop, or 'measured': as fast as yaw resistance was (default: the scenarios' own "
                  "shaping)")
      ->check(CLI::Validator(check, "measured or deg/s", ""));
}

/// For an output's options; nothing where there is no choice.
inline std::vector<std::pair<std::string, std::string>> options_of_rate(
    const HeadingRateChoice& choice) {
  if (choice.empty()) return {};
  return {{"heading_rate_limit", choice}};
}

/// Puts the limit into every scenario. Errors (input): nothing says how fast was measured.
inline Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                                 std::span<Scenario> scenarios) {
  if (choice.empty()) return {};
  double limit_degps = 0.0;
  if (choice == kMeasuredRate) {
    const std::optional<double> measured = measured_yaw_rate_degps(model);
    if (!measured) {
      return input_error("--heading-rate-limit",
                         "the model does not say how fast it turned when yaw resistance was "
                         "measured; give deg/s, or yaw_rate_max_degps in the vehicle");
    }
    limit_degps = *measured;
  } else {
    limit_degps = std::stod(choice);
  }
  for (Scenario& scenario : scenarios) limit_heading_rate(limit_degps, scenario);
  return {};
}

}  // namespace awmr::cli
