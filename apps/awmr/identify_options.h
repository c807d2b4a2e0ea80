/// The names of identify's options, one table for the command line and the project file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/identify.h"

namespace awmr::cli {

template <class T>
struct Named {
  std::string_view name;
  T value;
};

inline constexpr Named<Method> kMethods[] = {{"log-linear", Method::kLogLinear},
                                             {"nonlinear", Method::kNonlinear},
                                             {"trajectory", Method::kTrajectory}};
inline constexpr Named<ErrorModel> kNoises[] = {
    {"force", ErrorModel::kForce}, {"speed", ErrorModel::kSpeed}, {"time", ErrorModel::kTime}};
inline constexpr Named<Loss> kLosses[] = {{"squares", Loss::kSquared},
                                          {"huber", Loss::kHuber},
                                          {"cauchy", Loss::kCauchy},
                                          {"tukey", Loss::kTukey}};
inline constexpr Named<Preference> kPreferences[] = {{"printed", Preference::kPrinted},
                                                     {"timed", Preference::kTimed}};

template <class T, std::size_t N>
std::vector<std::string> names_of(const Named<T> (&table)[N]) {
  std::vector<std::string> names;
  for (const Named<T>& entry : table) names.emplace_back(entry.name);
  return names;
}

template <class T, std::size_t N>
std::string name_in(const Named<T> (&table)[N], T value) {
  for (const Named<T>& entry : table) {
    if (entry.value == value) return std::string(entry.name);
  }
  return {};
}

/// Precondition: the name is in the table.
template <class T, std::size_t N>
T value_in(const Named<T> (&table)[N], std::string_view name) {
  for (const Named<T>& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return table[0].value;
}

/// `NAME` for surge and yaw, `surge=NAME` or `yaw=NAME` for one; NAME is a family or `auto`.
/// Errors: an unknown name, with those there are; dead-zone for yaw alone.
Status add_family(std::string_view text, IdentifyOptions& options);

/// A parameter's name, `all`, `input_delay_s` or `bias.CHANNEL` (`bias.yaw_rate_radps`, ...).
Status add_asked(std::string_view name, IdentifyOptions& options);

/// The options in words, for the model's provenance.
std::vector<std::pair<std::string, std::string>> described(const IdentifyOptions& options);

}  // namespace awmr::cli
