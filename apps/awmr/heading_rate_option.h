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

/// As typed: deg/s, "measured" or "none"; empty where it was not: a command's own default.
using HeadingRateChoice = std::string;

inline constexpr const char* kMeasuredRate = "measured";
inline constexpr const char* kNoRate = "none";
/// Under which an output's options say what was chosen.
inline constexpr const char* kRateName = "heading_rate_limit";

/// What is wrong with a choice as typed; empty: nothing.
inline std::string fault_of_rate(const std::string& text) {
  if (text == kMeasuredRate || text == kNoRate) return {};
  std::string number = text;
  if (within(0.1, 3600.0)(number).empty()) return {};
  return fmt::format("must be {}, {}, or deg/s from 0.1 to 3600, found {}", kMeasuredRate, kNoRate,
                     text.empty() ? "nothing" : text);
}

/// `by_default`: what the command does without the option, in words.
inline void add_heading_rate_limit(CLI::App& command, HeadingRateChoice& choice,
                                   const char* by_default) {
  command
      .add_option("--heading-rate-limit", choice,
                  fmt::format("deg/s up to which a heading may be led to in every scenario that is "
                              "not in open loop; 'measured': as fast as yaw resistance was; "
                              "'none': by the scenarios' own shaping alone (default: {})",
                              by_default))
      ->check(CLI::Validator(fault_of_rate, "measured, none or deg/s", ""));
}

/// What a comparison does where nothing was typed: no faster than was measured, where that is known.
/// What parts the modes in faster turns is the model's extrapolation.
inline HeadingRateChoice rate_to_compare_at(const HeadingRateChoice& typed, const Model& model) {
  if (!typed.empty()) return typed;
  return measured_yaw_rate_degps(model) ? kMeasuredRate : kNoRate;
}

/// For an output's options; nothing where there is no choice.
inline std::vector<std::pair<std::string, std::string>> options_of_rate(
    const HeadingRateChoice& choice) {
  if (choice.empty()) return {};
  return {{kRateName, choice}};
}

/// Puts the limit into every scenario. Errors (input): nothing says how fast was measured.
inline Status limit_heading_rate(const HeadingRateChoice& choice, const Model& model,
                                 std::span<Scenario> scenarios) {
  if (choice.empty() || choice == kNoRate) return {};
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
