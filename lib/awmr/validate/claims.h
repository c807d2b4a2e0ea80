/// Checks of the paper's claims C1 to C14 by simulation of a model. Private to validate/.
///
/// The paper uses terms without numbers ("fast", "slight", "no overshoot"). Each check therefore
/// has a numerical criterion for "reproduced", chosen by this project and printed in the output
/// (Claim::tolerance). A claim that does not meet its criterion is reported as not reproduced, with
/// the simulated numbers (Claim::figure).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// Checks C8 to C12: waypoints, line, obstacles, timed path, best modes. Returns the claims for
/// each setting. Precondition: that of run_all().
///                                                                   [paper 5, section 7]
std::vector<std::vector<Claim>> check_guidance_claims(std::span<const ClaimSetting> settings);

/// Longest settling time that counts as fast in C3, s: the heading step divided by the largest
/// steady yaw rate of the mode, plus 4 (T1 + 2 T2). T1 = 1/lambda and T2 = epsilon/(2 mu) are time
/// constants of the heading law with the paper's gains. The sliding variable S decays with 2 T2,
/// then the heading error with T1. The factor 4 is because e^-4 = 1.8 % is within the settling band
/// of 2 %.
double allowed_settling_s(const Plant<double>& plant, const Vehicle& vehicle, YawMode mode,
                          double step_rad, double speed_mps);
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

}  // namespace awmr
