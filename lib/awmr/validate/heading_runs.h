/// Simulated runs for the heading and speed claims, and text of their results. Private to
/// validate/.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/validate/claims.h"

namespace awmr {

inline constexpr double kSpeed_mps = 1.0;                      ///< u_d               [paper 4.3]
inline const std::vector<double> kSimulated_deg{30.0, -30.0};  ///< commanded headings  [paper 4.3]
inline constexpr double kLargestStep_deg = 60.0;               ///< the step from 30 to -30 deg

/// Rounds to 1e-4, because further digits depend on rounding errors. + 0.0 changes -0 to 0.
inline double to_figure(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }

/// Value of a run. `value`: a member of Metrics, or a function of the run.
template <class Value>
std::optional<double> value_of(const ModeRun& run, Value value) {
  if constexpr (std::is_member_object_pointer_v<Value>) {
    return run.metrics.*value;
  } else {
    return value(run);
  }
}

/// Text of value_of() in each mode: "differential 0.1, steering 0.2, combined 0.3 UNIT", with
/// "none" for a mode without the value.
template <class Value>
std::string by_mode(const ModeRuns& runs, const std::string& unit, Value value) {
  std::string text;
  for (const ModeRun& run : runs) {
    const std::optional<double> number = value_of(run, value);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name_of(run.mode),
                        number ? fmt::format("{:.4g}", to_figure(*number)) : "none");
  }
  return text + (unit.empty() ? "" : " " + unit);
}

inline const ModeRun& in_mode(const ModeRuns& runs, YawMode mode) {
  return *std::find_if(runs.begin(), runs.end(),
                       [mode](const ModeRun& run) { return run.mode == mode; });
}

/// Inputs of the runs for the heading claims.
struct HeadingSetting : ClaimSetting {
  double allowed_s(YawMode mode) const {
    return allowed_settling_s(plant, model.vehicle, mode, radians(kLargestStep_deg), kSpeed_mps);
  }
  /// Time for which each heading is commanded, s: 1.5 times the longest allowed settling time of
  /// all modes, at least 10 s and at most 120 s.
  double hold_s() const {
    double longest_s = 10.0;
    for (const YawMode mode : kYawModes) longest_s = std::max(longest_s, 1.5 * allowed_s(mode));
    return std::min(longest_s, 120.0);
  }
  ModeRuns run(std::string name, const std::vector<double>& headings_deg) const {
    const HeadingStepsOptions options{
        .hold_s = hold_s(), .speed_mps = kSpeed_mps, .name = std::move(name)};
    return ClaimSetting::run(heading_steps(headings_deg, options));
  }
};

/// Checks C4: the speed converges to u_d. `runs`: headings of 30, then -30 deg.
Claim check_speed_converges(const HeadingSetting& setting, const ModeRuns& runs);
/// Checks C5, the speed drop by mode, with the same runs as C4. Claim::figure also has the speed
/// drops of runs with further limits of the wheel forces; these runs do not affect the verdict.
Claim check_speed_held(const HeadingSetting& setting, const ModeRuns& runs);

}  // namespace awmr
