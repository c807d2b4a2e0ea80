/// Checks of the paper's claims C1 to C14 by simulation of a model. Private to validate/.
///
/// The paper uses terms without numbers ("fast", "slight", "no overshoot"). Each check therefore
/// has a numerical criterion for "reproduced", chosen by this project and printed in the output
/// (Claim::tolerance). A claim that does not meet its criterion is reported as not reproduced, with
/// the simulated numbers (Claim::figure).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/core/units.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"
#include "awmr/validate/validate.h"

namespace awmr {

/// tau_speed (surge force divided by F_max) at the paper's full thrust.              [paper 3.5]
inline constexpr double kFullThrust = 2.0;
inline constexpr double kSpeed_mps = 1.0;                      ///< u_d               [paper 4.3]
inline const std::vector<double> kSimulated_deg{30.0, -30.0};  ///< commanded headings  [paper 4.3]
inline constexpr double kLargestStep_deg = 60.0;               ///< the step from 30 to -30 deg

/// Run of a claim's scenario in one mode.
struct ModeRun {
  YawMode mode{};
  Run run;
  Metrics metrics;
};
using ModeRuns = std::array<ModeRun, std::size(kYawModes)>;

/// Common inputs of the claims' simulations.
struct ClaimSetting {
  const Model& model;
  const Plant<double>& plant;  ///< plant of `model`
  ModeGains gains;
  BatchArithmetic arithmetic;   ///< arithmetic of the runs
  ControlOptions control = {};  ///< control options of every scenario

  /// Simulates the scenario in all three modes. Preconditions: the model has every parameter, and a
  /// 95 % interval for each parameter that the scenario's `corner` sets to an end of its interval.
  ModeRuns run(const Scenario& scenario) const;
};
/// ClaimSetting::run() for each setting, in one batch. Precondition: all settings have the same
/// control, arithmetic and sample time.
std::vector<ModeRuns> run_all(std::span<const ClaimSetting> settings, Scenario scenario);

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

template <class Condition>
bool all_modes(const ModeRuns& runs, Condition condition) {
  return std::all_of(runs.begin(), runs.end(), condition);
}

/// Evaluates the condition of a claim in each mode.
template <class Condition>
std::vector<ClaimInMode> verdicts_by_mode(const ModeRuns& runs, Condition condition) {
  std::vector<ClaimInMode> verdicts;
  for (const ModeRun& run : runs) verdicts.push_back({run.mode, condition(run)});
  return verdicts;
}

/// Longest settling time that counts as fast in C3, s: the heading step divided by the largest
/// steady yaw rate of the mode, plus 4 (T1 + 2 T2). T1 = 1/lambda and T2 = epsilon/(2 mu) are time
/// constants of the heading law with the paper's gains. The sliding variable S decays with 2 T2,
/// then the heading error with T1. The factor 4 is because e^-4 = 1.8 % is within the settling band
/// of 2 %.
double allowed_settling_s(const Plant<double>& plant, const Vehicle& vehicle, YawMode mode,
                          double step_rad, double speed_mps);

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

/// Checks C1: at full thrust and straight ahead, u settles at u_max.             [paper 3.5.1]
Claim check_straight_run(const Model& model, const Plant<double>& plant,
                         const ControlOptions& control = {});
/// Checks C2: with constant thrust and yaw moment the path tends to a circle.    [paper 3.5.2]
Claim check_circle(const Model& model, const Plant<double>& plant,
                   const ControlOptions& control = {});
/// Checks C14: the gains lambda 3, mu 50, epsilon 12 of the heading law give the time constants
/// T1 = 0.33 s and T2 = 0.12 s.                                                  [paper 4.1]
Claim check_time_constants(const std::optional<ModeGains>& gains);
/// Checks C3 to C7 with common runs of heading steps, and C13 with its own run.
///                                                                 [paper 4.3, section 6]
std::vector<Claim> check_heading_claims(const ClaimSetting& setting);

/// Checks C4: the speed converges to u_d. `runs`: headings of 30, then -30 deg.
Claim check_speed_converges(const HeadingSetting& setting, const ModeRuns& runs);
/// Checks C5, the speed drop by mode, with the same runs as C4. Claim::figure also has the speed
/// drops of runs with further limits of the wheel forces; these runs do not affect the verdict.
Claim check_speed_held(const HeadingSetting& setting, const ModeRuns& runs);

/// Checks C8 to C12: waypoints, line, obstacles, timed path, best modes. Returns the claims for
/// each setting. Precondition: that of run_all().
///                                                                   [paper 5, section 7]
std::vector<std::vector<Claim>> check_guidance_claims(std::span<const ClaimSetting> settings);

/// Number of reversals of a signal. A reversal is counted when the signal has moved back by more
/// than `band` from its last maximum or minimum.
int reversals(std::span<const double> signal, double band);

/// Checks all claims, in the paper's order; without gains, only the claims C1, C2 and C14.
std::vector<Claim> check_claims(const Model& model, const std::optional<ModeGains>& gains,
                                const BatchArithmetic& arithmetic);
/// check_claims() for each model, with the given control options. Precondition: each model has
/// every parameter, and all models have the same sample time.
std::vector<std::vector<Claim>> check_claims_of(std::span<const Model> models,
                                                const std::optional<ModeGains>& gains,
                                                const BatchArithmetic& arithmetic,
                                                const ControlOptions& control);

/// Returns all combinations ("cases") of the settings that the paper does not give.
///
/// The paper prints neither the limits of the wheel force F' nor how the combined mode divides the
/// yaw moment at a limit. Its allocation is an approximation for small steering angles. With its
/// m', the largest thrust needs more tyre force than friction permits. The cases combine
///
///     allocation   exact, paper (control/allocation.h)
///     F'           [-1, 1], [0, 1] (the paper's own normalisation), [0, 0.5]
///     m', I'z      as in the model, and multiplied so that tau_speed = 2 needs a friction of 0.8:
///                  2 F_max <= 0.8 m g with F_max = m/m'  =>  m' >= 2/(0.8 g)
///     split        redistribute, fixed half
///
/// If the model's m' already is at least 2/(0.8 g), m' and I'z are not varied.
std::vector<ClaimCase> open_cases(const Model& model);

/// Adds to each claim its verdict in all cases, and the settings on which the verdict depends.
/// `claims` must be the result of check_claims() with the same gains. The result does not depend on
/// the number of cores.
void add_open_cases(const Model& model, const std::optional<ModeGains>& gains,
                    const BatchArithmetic& arithmetic, std::vector<Claim>& claims,
                    const Progress& progress = {});

/// Lists the settings on which the verdict depends, most decisive first. "wheel_force (8 of 12)"
/// means: there are 12 combinations of all settings except wheel_force; in 8 of them, a change of
/// wheel_force alone changes the verdict. Empty if the verdict is the same in all cases.
std::string decisive_settings(const std::vector<ClaimCase>& cases);

}  // namespace awmr
