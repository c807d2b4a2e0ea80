/// Objective J that the search minimises. Private to tune/.
///
/// J of a run compares its metrics x_i with the metrics x0_i of the baseline gains on the same
/// vehicle, in the same mode and scenario:
///
///     ln J = sum_i w_i ln((x_i + f_i)/(x0_i + f_i)) / sum_i w_i,   w_i: weights
///
/// The metrics are settling time, heading ITAE, overshoot, control variation, effort and speed
/// ITAE. f_i is a floor in the unit of x_i. It makes a metric of 0, such as no overshoot, possible,
/// and differences below it hardly change J. With the baseline gains, J is exactly 1.
///
/// For several vehicles, ln J of a mode and scenario is the average of two means: over all
/// vehicles, and over the worst tail_share of them (CVaR). The objective is the geometric mean of J
/// over modes and scenarios. Each soft goal adds max(0, q - 1) in each of its modes, with q the
/// quantile of its excess over the limit (goals.h).
///
/// J uses geometric means, because another baseline then only multiplies J by a constant. The
/// baseline changes the optimum only through the choice of the worst vehicles and the weight of
/// soft goals. In a sum of the ratios, a metric that is large with the baseline would hardly count.
#pragma once

#include <array>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "awmr/simulate/batch.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// One term of the objective: metric x_i, weight and floor.
struct ObjectiveTerm {
  const char* name;                  ///< key of the weight in tune.json and gains.json
  double ObjectiveWeights::*weight;  ///< w_i
  const char* figure;                ///< key of x_i in gains.json
  double floor;                      ///< f_i in the unit of x_i, > 0
};
inline constexpr ObjectiveTerm kObjectiveTerms[] = {
    {"settling", &ObjectiveWeights::settling, "settling_time_s", 0.05},
    {"itae", &ObjectiveWeights::itae, "heading_itae_degs2", 0.1},
    {"overshoot", &ObjectiveWeights::overshoot, "overshoot_deg", 0.5},
    {"control_variation", &ObjectiveWeights::control_variation, "control_variation", 0.01},
    {"effort", &ObjectiveWeights::effort, "control_effort", 1e-3},
    {"speed_itae", &ObjectiveWeights::speed_itae, "speed_itae_m_s", 1e-3},
};

/// Substitute for the settling time, s, of a run that does not settle after every step:
///   T max(1, ITAE/sum_j(b T_j^2/2))
/// T is the scenario's duration, T_j the time for which heading step j is commanded, and b = 0.5
/// deg the narrowest settling band. If the substitute were T alone, all gains that do not settle
/// would have the same settling time, and the search would select the least active of them.
/// Precondition: heading guidance.
double unsettled_s(const Scenario& scenario, double itae_degs2);

/// The metrics x_i of one run, in the order of kObjectiveTerms. An absent settling time is replaced
/// by ModeScore::unsettled_s, other absent metrics by 0.
std::array<double, std::size(kObjectiveTerms)> figures_of(const ModeScore& score);

/// Returns the objective J of one run. It is exactly 1 with the baseline gains, and infinite or NaN
/// if a metric is.
double objective_of(const ModeScore& score, const ModeScore& baseline,
                    const ObjectiveWeights& weights);

/// Returns the modes that are tuned: `mode` if it is given, else all modes of the vehicle.
std::span<const YawMode> tuned_modes(const Vehicle& vehicle, std::optional<YawMode> mode);

/// Vehicles, modes and scenarios in which the gains are scored.
struct ObjectiveSetting {
  /// Not empty. The first is the nominal vehicle, whose plant the controller uses.
  std::vector<DrawnVehicle> vehicles;
  Vehicle vehicle;
  ObjectiveWeights weights;
  std::vector<Scenario> scenarios;  ///< scenarios with heading guidance; not empty
  double tail_share = 1.0;  ///< fraction of the vehicles in the tail, the worst ones, (0, 1]
  /// The seed and the index of a vehicle select its random numbers.
  std::uint64_t seed = 0;
  BatchArithmetic arithmetic = {};  ///< instruction set and rounding of the runs
  std::vector<TuningGoal> goals = {};
  std::optional<YawMode> mode = {};  ///< the only mode to score; absent: all modes of the vehicle

  std::span<const YawMode> modes() const { return tuned_modes(vehicle, mode); }
};

/// Standard normal random numbers for the sensor noise of all runs, sorted by scenario, then
/// vehicle. Empty if they would need more memory than kMaxNoiseBytes; each run then generates the
/// same numbers itself.
using RunNoise = std::vector<std::vector<DrawnNoise>>;
inline constexpr double kMaxNoiseBytes = 64e6;
RunNoise draw_noise(const ObjectiveSetting& setting);

/// Objective and metrics of one set of gains.
struct Evaluation {
  /// Scores of the first vehicle, sorted by mode, then scenario.
  std::vector<ModeScore> scores;
  /// For each mode, the sum of the control variation of all runs, divided by that of the baseline.
  std::vector<double> mode_activity;
  /// Quantile of the excess of each goal in each mode (goals.h), sorted by goal, then mode. A goal
  /// is met if its quantile is at most 1.
  std::vector<double> goal_quantile;
  /// Settling time and control variation, as means over all runs.
  TradeOffPoint trade_off;
  /// Geometric mean over the modes, plus the terms of soft goals. Finite if `valid`.
  double objective = 0.0;
  bool valid = false;  ///< true: the objective is finite, and no run breaks off
};

/// Evaluates gains. Thread-safe; the runs of a call are distributed over the cores.
class Objective {
 public:
  Objective(ObjectiveSetting setting, const Gains<double>& baseline);

  /// Simulates every mode of every vehicle for each set of gains that was not evaluated before. The
  /// result of a set depends neither on the sets that are evaluated together with it nor on the
  /// number of cores.
  std::vector<Evaluation> operator()(std::span<const Gains<double>> gains) const;
  Evaluation operator()(const Gains<double>& gains) const;
  const Evaluation& baseline() const { return baseline_; }
  const ObjectiveSetting& setting() const { return setting_; }
  std::span<const YawMode> modes() const { return setting_.modes(); }
  std::span<const TuningGoal> goals() const { return setting_.goals; }
  std::size_t draws() const { return setting_.vehicles.size() - 1; }

 private:
  Evaluation evaluate(std::vector<ModeScore> scores) const;
  double evaluate_mode(std::span<const ModeScore> scores, std::size_t mode,
                       Evaluation& evaluation) const;
  TradeOffPoint trade_off(std::span<const ModeScore> scores) const;

  ObjectiveSetting setting_;
  RunNoise noise_;
  /// Scores of the baseline gains, sorted by vehicle, then mode, then scenario.
  std::vector<ModeScore> baseline_scores_;
  Evaluation baseline_;
  /// Cache of evaluations by gains, because the stages of a search repeat some gains.
  using GainNumbers = std::array<double, sizeof(Gains<double>) / sizeof(double)>;
  mutable std::map<GainNumbers, Evaluation> known_;
  mutable std::mutex known_mutex_;
};

/// Simulates all runs of each set of gains. Returns for each set its scores, sorted by vehicle,
/// then mode, then scenario. `noise`: draw_noise() of the setting.
std::vector<std::vector<ModeScore>> run_all(const ObjectiveSetting& setting, const RunNoise& noise,
                                            std::span<const Gains<double>> gains);

/// Returns the average of two means: over all values, and over the tail. The tail is the largest
/// `tail_share` of the values, at least one value.
double mean_and_tail(std::vector<double> values, double tail_share);

}  // namespace awmr
