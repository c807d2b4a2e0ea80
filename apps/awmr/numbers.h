/// Checks numbers that are given on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>

namespace awmr::cli {

/// Largest random seed.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::uint64_t>::max();

/// Accepts a number if it is finite and from `min` to `max`, no text follows it, and it fits the
/// type of the option: a whole number for integers, without minus sign for unsigned ones. CLI11
/// alone does not check this. It converts -1 and 10^23 to 2^64 - 1, and accepts nan in every range.
template <class Number>
CLI::Validator within(Number min, Number max) {
  static_assert(std::is_arithmetic_v<Number>);
  const auto check = [min, max](const std::string& text) -> std::string {
    const std::size_t sign = !text.empty() && text.front() == '+' ? 1 : 0;
    const char* const end = text.data() + text.size();
    Number value{};
    const auto [stop, fault] = std::from_chars(text.data() + sign, end, value);
    bool good = fault == std::errc() && stop == end && value >= min && value <= max;
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (good) return {};
    const char* const kind = std::is_integral_v<Number> ? "whole number" : "number";
    return fmt::format("must be a {} from {} to {}, found {}", kind, min, max,
                       text.empty() ? "nothing" : text);
  };
  return {check, fmt::format("in [{}, {}]", min, max), ""};
}

}  // namespace awmr::cli
