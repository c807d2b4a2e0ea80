/// Tunes the gains by a global and then a local search. Constraints: T2 < T1 with a margin, and the
/// limits of the sampled loop.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/progress.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard.h"
#include "awmr/core/units.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Definition of the reaching time constant, which has to be below T1.
enum class ReachingForm {
  kPaper,   ///< T2 = eps/(2 mu), of V = S^2/2                                          [paper (95)]
  kStrict,  ///< eps/mu = 2 T2, of S itself
};
inline constexpr NameTable<ReachingForm, 2> kReachingFormNames{
    {{"paper", ReachingForm::kPaper}, {"strict", ReachingForm::kStrict}}};

/// Weights of the objective's terms, >= 0 and not all 0. Each term is the ratio of a metric to its
/// value with the baseline gains in the same mode and scenario (see objective.h).
struct ObjectiveWeights {
  double settling = 1.0;           ///< heading: settling time; the run's duration if it never
                                   ///< settles
  double itae = 0.5;               ///< heading: integral of t |psi_d - psi|, t from each step
  double overshoot = 1.0;          ///< heading: travel beyond the command
  double control_variation = 0.5;  ///< total variation of the commands
  double effort = 0.25;            ///< magnitude of the commands
  double speed_itae = 0.25;  ///< speed: integral of t |u_d - u|; with weight 0, mu_s and eps_s are
                             ///< not determined
};

/// Bounds of the search. Symbols and units as in model/gains.h. Absent: from 1/kBoundFactor to
/// kBoundFactor times the gains of pole placement, both those with the smallest mu and those with
/// wide layers (pole_placement.h). The constraints exclude gains that are too fast for the sampled
/// loop.
struct GainBounds {
  std::optional<Interval> lambda = {};         ///< 1/s
  std::optional<Interval> mu = {};             ///< rad/s^2
  std::optional<Interval> epsilon = {};        ///< rad/s
  std::optional<Interval> speed_mu = {};       ///< m/s^2
  std::optional<Interval> speed_epsilon = {};  ///< m/s
};
inline constexpr double kBoundFactor = 10.0;

/// Absolute limits of the gains, independent of the baseline.
struct TuningLimits {
  /// Largest RMS rate of the steering command due to sensor noise, deg/s, > 0, while a heading is
  /// held at the largest u_d in the mode that steers most. Absent, nominal gains: no limit. Absent,
  /// robust gains: the larger of two rates. One is 0.9 of the servo's rate limit, at most its range
  /// 2 d_max over its time constant. The other is 1.25 times the rate due to the feed-forward g3(r)
  /// of a noisy yaw rate, which no gains reduce.
  std::optional<double> steering_rate_rms_degps = {};
  double damping = 0.7;           ///< smallest damping ratio without latency, (0, 1]
  double late_damping = 0.25;     ///< the same with latency and motor lag, (0, 1]
  double delayed_damping = 0.05;  ///< with twice the latency plus one sample, (0, 1]
  /// Largest share of the weaker mode's turning authority that heading noise may use, (0, 1].
  double noise_share = 0.25;
};

/// Conditions of the constraints, from the scenarios and the vehicle.
struct ExaminedRange {
  double speed_mps = 1.0;                 ///< largest u_d, >= 0
  double step_rad = radians(60.0);        ///< largest change of the commanded heading, >= 0
  double yaw_rate_radps = radians(60.0);  ///< largest in the runs, > 0
};

/// Gains whose metrics normalise the objective.
struct Baseline {
  Gains<double> gains{};
  std::string source;  ///< kPolePlacement, kPaperSource or the file that they were read from
};
inline constexpr const char* kPolePlacement = "pole-placement";
inline constexpr const char* kPaperSource = "paper";

/// Search of a disturbance observer's bandwidth together with the gains.
struct ObserverSearch {
  Interval bandwidth_radps{0.2, 20.0};  ///< rad/s
  /// Largest moment (m) and force (dimensionless) that the observer compensates, > 0. Absent:
  /// kObserverShare of the weaker mode's turning authority, and kObserverShare of the wheel force
  /// that remains at the largest u_d.
  std::optional<double> yaw_max_m, surge_max;
};
inline constexpr double kObserverShare = 0.5;

/// Number of draws in the search of three modes. With fewer modes the number of runs stays the
/// same: 12 draws with one mode. The final search uses all draws.
inline constexpr int kSearchedDraws = 4;
/// Relative change of the objective that is irrelevant: among gains within it, a rule selects.
inline constexpr double kIndifferent = 1e-3;
/// Relaxation of an active constraint, to measure its cost.
inline constexpr double kWider = 0.1;

/// Unmodelled variation that neither trials nor data sheets determine: payload, battery voltage,
/// values missing in a paper. Successive draws use successive combinations; the nominal plant is
/// not varied.
struct UnmodelledVariation {
  std::vector<double> mass_factors = {};    ///< of m' and I'z alike; empty: 1
  std::vector<Interval> wheel_forces = {};  ///< F' of one wheel over F_max; empty: the vehicle's

  std::size_t combinations() const;  ///< >= 1
  bool any() const { return !mass_factors.empty() || !wheel_forces.empty(); }
};
inline constexpr double kLeastMassFactor = 0.1, kMostMassFactor = 10.0;
inline constexpr std::size_t kMostOpenValues = 20;  ///< of mass_factors and of wheel_forces, each

/// Upper limit, > 0, of a run's metric (run_figure_names()), in the metric's unit.
struct GoalLimit {
  std::string figure;
  double most = 0.0;
};

/// Goal: at least this share of the draws meets every limit in all scenarios.
struct TuningGoal {
  std::vector<GoalLimit> at_most;  ///< at least one, each metric once
  double share = 0.95;             ///< [kLeastShare, kMostShare]
  std::optional<YawMode> mode;     ///< absent: in each mode
  /// true: the objective has a penalty for missing the goal. false: a constraint; gains that miss
  /// it on the draws of the search are rejected.
  bool is_soft = false;
};
inline constexpr double kLeastShare = 0.5, kMostShare = 0.999;
inline constexpr std::size_t kMostGoals = 20;
/// Default number of draws that goals are evaluated on.
inline constexpr int kGoalDraws = 500;
inline constexpr int kFewestSamples = 16, kMostSamples = 100'000;
inline constexpr std::size_t kRunFigures = 6;  ///< names in run_figure_names()
bool is_run_figure(std::string_view name);
std::vector<std::string> run_figure_names();

struct TuneOptions {
  /// true: only the model's own values, with noise-free sensors without latency and motors without
  /// lag. false (robust): also `draws` plants from the model's covariance, under LoopConditions.
  /// Every constraint holds for all of these plants.
  bool nominal = false;
  int draws = 32;                 ///< 0 ... 1000
  int evaluation_draws = 50;      ///< new draws for the evaluation of the gains, 0 ... 100000
  UnmodelledVariation open = {};  ///< robust search only
  /// Part of the evaluation, for several machines: each runs the whole search, but evaluates only
  /// the new draws of its part (tune_shard.h).
  std::optional<Shard> shard = {};
  /// Share of the draws in the tail, (0, 1]: the worst ones. The objective averages the mean over
  /// all draws and the mean over the tail (CVaR).
  double tail_share = 0.2;
  TuningLimits limits = {};
  /// The only mode to tune for; absent: all modes of the vehicle. It does not change the default
  /// scenarios.
  std::optional<YawMode> mode = {};
  /// Absent: the fastest poles that the constraints allow (pole_placement.h).
  std::optional<Baseline> baseline = {};
  /// Largest ratio of the control variation to the baseline's in each mode, > 0, of a robust
  /// search. Absent: no limit.
  std::optional<double> activity_max = {};
  /// kPaper: the paper's condition, which allows twice the eps/mu.
  ReachingForm form = ReachingForm::kStrict;
  /// Reaching time constant <= margin T1, in (0, 1). The smaller, the more the two phases differ in
  /// speed.
  double margin = 0.8;
  ObjectiveWeights weights;
  int global_evaluations = 80;  ///< >= 1
  /// >= 0, all local searches together; 0: no local search.
  int local_evaluations = 80;
  /// Seed of the draws, their noise, the global search and the sensitivity samples. The gains of
  /// other seeds show how much they depend on chance.
  std::uint64_t seed = 1;
  /// Each needs heading guidance and a unique name. Empty: default_tuning_scenarios().
  std::vector<Scenario> scenarios;
  GainBounds bounds;
  std::optional<ObserverSearch> observer = {};  ///< absent: no observer is tuned
  std::vector<TuningGoal> goals = {};           ///< robust search only
  /// Number of samples of the sensitivity analysis of the tuned loop (GlobalSensitivity): 0 (none)
  /// or kFewestSamples to kMostSamples. Robust search only.
  int sensitivity = 0;
  Progress progress = {};  ///< counts the runs of the search, of all plants
};

/// A constraint that is active at the gains.
struct ActiveConstraint {
  std::string name;  ///< of a constraint or a goal, or "activity, MODE"
  /// Relative improvement of the objective if the limit is relaxed by kWider, >= 0.
  double wider_gains = 0.0;
};

/// On which side of its limit a value must be.
enum class Sense { kAtMost, kAtLeast };
inline constexpr NameTable<Sense, 2> kSenseNames{
    {{"at-most", Sense::kAtMost}, {"at-least", Sense::kAtLeast}}};

struct ConstraintReport {
  std::string name;     ///< "T2 < T1 (strict)", ...
  double value = 0.0;   ///< with these gains
  double limit = 0.0;   ///< limit of the value
  double margin = 0.0;  ///< distance of the value from its limit, >= 0 when it holds
  Sense sense = Sense::kAtMost;
  std::string meaning{};
  bool required = true;  ///< false: reported only (the form of T2 < T1 that was not requested)
};

/// Score of one set of gains in one scenario and mode.
struct ModeScore {
  std::string scenario;
  YawMode mode{};
  Metrics metrics{};
  double unsettled_s = 0.0;  ///< substitute for an absent settling time (objective.h)
  double objective =
      0.0;  ///< weighted geometric mean of its terms over the baseline's; 1 for itself
  bool has_failed = false;  ///< the run broke off; its metrics are those up to that time
};

/// Evaluation of a search that improved on all earlier ones.
struct SearchStep {
  int evaluation = 0;      ///< from 1
  double objective = 0.0;  ///< the gains meet every constraint
};

/// Progress of a search, in the order of its evaluations.
struct SearchHistory {
  std::vector<SearchStep> best;  ///< at most kMostHistorySteps; the last one is the search's result
  int global_evaluations = 0;    ///< the first ones, of the global search; the others are local
  int evaluations = 0;
};
/// A longer history is thinned to evenly spaced steps, including the first and the last.
inline constexpr std::size_t kMostHistorySteps = 200;

/// Metrics of a run for goals and evaluation. The objective has others (objective.h).
struct RunOutcome {
  YawMode mode{};
  bool completed = false;  ///< settled after every step
  bool broke_off = false;  ///< its metrics are those up to that time
  /// In the order of run_figure_names(). The settling time of a run that does not settle is the
  /// scenario's duration.
  std::array<double, kRunFigures> figures{};
};
/// The runs of one set of gains, by draw, then mode, then scenario.
struct EvaluatedRuns {
  std::string gains;  ///< as in EvaluatedGains
  std::vector<RunOutcome> outcomes;
};

/// A metric of the runs of one set of gains in one mode, over the evaluation draws.
struct EvaluatedFigure {
  std::string name;  ///< "heading_iae_degs"
  double median = 0.0;
  double q95 = 0.0;
  double tail_mean = 0.0;  ///< over the worst tail_share of the draws (CVaR)
};

/// EvaluatedGains::gains of the tuned gains.
inline constexpr const char* kRobustGains = "robust";

/// One set of gains in one mode, over the evaluation draws.
struct EvaluatedGains {
  /// kRobustGains, "baseline", "paper" (where the baseline is another), "unobserved" (without their
  /// observer)
  std::string gains;
  YawMode mode{};
  double completed_share = 0.0;  ///< settled after every step
  std::vector<EvaluatedFigure> figures;
  std::string scenario = {};  ///< empty: over all of them
};

/// Fraction of a metric's variance that is due to one input (tune/sobol.h).
struct SobolIndex {
  double first = 0.0;               ///< first order: in [0, 1], apart from the sampling error
  double total = 0.0;               ///< total, >= 0: including interactions with other inputs
  Interval first_ci95, total_ci95;  ///< by bootstrap
};
struct SensitiveFigure {
  YawMode mode{};
  std::string name;                  ///< "settling_time_s"
  double mean = 0.0;                 ///< in its unit
  double deviation = 0.0;            ///< standard deviation, >= 0
  std::vector<SobolIndex> by_input;  ///< in the order of GlobalSensitivity::inputs
};
/// Sensitivity of the tuned loop to the assumptions of the search (global_sensitivity.h).
struct GlobalSensitivity {
  int samples = 0;  ///< N: the loop is run for N (2 + inputs) samples
  std::vector<std::string> inputs;
  std::vector<SensitiveFigure> figures;  ///< by mode, then figure
};

/// Result of a goal on fresh draws.
enum class GoalVerdict {
  kMet,     ///< the whole interval is at or above the goal's share
  kMissed,  ///< the whole interval is below the goal's share
  kOpen,    ///< neither: more draws are needed
};
inline constexpr NameTable<GoalVerdict, 3> kGoalVerdictNames{
    {{"met", GoalVerdict::kMet}, {"missed", GoalVerdict::kMissed}, {"open", GoalVerdict::kOpen}}};

/// A goal in one mode with one set of gains, over the evaluation draws.
struct EvaluatedGoal {
  TuningGoal goal;
  YawMode mode{};
  std::string gains;  ///< as in EvaluatedGains
  int held = 0;       ///< draws that meet every limit
  int runs = 0;       ///< draws
  Interval ci95;      ///< of the share, by Clopper and Pearson
  GoalVerdict verdict = GoalVerdict::kOpen;
};

/// Conditions of a robust search, and results of its gains.
struct RobustTuning {
  LoopConditions conditions;
  bool from_covariance = false;           ///< false: the model has none, so only noise was drawn
  std::vector<EvaluatedGains> evaluated;  ///< by gains, then mode; empty for a part
  /// The same by scenario, then gains, then mode; empty with a single scenario.
  std::vector<EvaluatedGains> evaluated_by_scenario;
  std::vector<EvaluatedGoal> goals;  ///< by gains, then goal, then mode; empty for a part
  std::vector<EvaluatedRuns> runs;   ///< for a part: of its draws, by gains
  std::optional<GlobalSensitivity> sensitivity;  ///< absent if not requested
};

/// Settling time against control variation, both as means over the modes, scenarios and plants of
/// the search. A run that does not settle counts with the scenario's duration.
struct TradeOffPoint {
  double settling_time_s = 0.0;
  double control_variation = 0.0;  ///< 1/s, as Metrics::control_variation
};
struct NamedTradeOff {
  std::string gains;  ///< "tuned", "baseline", "paper", "lqi"
  TradeOffPoint point;
};
struct TradeOff {
  /// Pareto front of the feasible gains that the search evaluated, sorted by settling time.
  std::vector<TradeOffPoint> front;
  /// Named gains on the same runs. Gains with a run that breaks off are left out. "lqi": the LQI
  /// law (control/heading_lqi.h) by Bryson's rule. Its acceptable values are a sixth of the step,
  /// the step in 1.5 s, that error for 4 s, and a quarter of the weaker mode's turning authority.
  std::vector<NamedTradeOff> named;
};

/// Worst case of a metric of the loop over the model's confidence set.
struct WorstCase {
  double value = 0.0;
  double yaw_rate_radps = 0.0;
  /// The parameters that the loop depends on, with their values in the worst case.
  std::vector<std::pair<ParameterId, double>> parameters = {};
};
struct ModeCertificate {
  YawMode mode{};
  WorstCase damping = {};         ///< smallest damping ratio; <= 0: unstable
  WorstCase delay_margin_s = {};  ///< additional delay at the stability limit, s; infinity: none
};
/// Lower bounds of damping and delay margin over the model's 95 % confidence set
/// (tune/certificate.h), for the sampled heading loop with hold, servo, latency and motor lag.
struct Certificate {
  int parameters = 0;          ///< number with a covariance; 0: only the model's own values
  int degrees_of_freedom = 0;  ///< of the confidence ellipsoid
  Interval yaw_rate_radps;     ///< examined
  double latency_s = 0.0;      ///< of the readings
  double motor_time_constant_s = 0.0;
  std::vector<ModeCertificate> modes;

  double damping_min() const;
  double delay_margin_s() const;
};
inline constexpr double kCertifiedShare = 0.95;

struct Tuning {
  Gains<double> gains{};
  std::vector<ConstraintReport> constraints;
  double objective = 0.0;  ///< mean of `scores`
  std::vector<ModeScore> scores;
  Baseline baseline;
  TuningLimits limits;  ///< of the search, with the defaults filled in
  ExaminedRange examined;
  double baseline_objective = 0.0;
  std::vector<ModeScore> baseline_scores;
  std::string algorithm;
  int evaluations = 0;
  std::string stop_reason;
  std::uint64_t seed = 0;
  int simulated = 0;  ///< evaluations with runs; the others violate a constraint
  /// Range of mu in which, with mu/epsilon constant, the constraints are met and the objective is
  /// within kIndifferent of the best. The smallest mu is selected. The same for mu_s and epsilon_s.
  Interval mu_as_good, speed_mu_as_good;
  std::vector<ActiveConstraint> active;
  std::string arithmetic;  ///< how the runs were rounded: as BatchArithmetic::rounding
  SearchHistory history;
  /// The tuned gains in a scenario that the search did not use; the baseline's objective there is
  /// 1. For information only.
  std::vector<ModeScore> held_out_scores;
  double held_out_objective = 0.0;
  std::optional<Certificate> certificate;  ///< always present in the result of tune()
  TradeOff trade_off;
  std::optional<RobustTuning> robust;  ///< absent for nominal gains
};

/// Default tuning scenario: from rest, a heading and then its opposite. Speed, angle and time are
/// scaled to the vehicle:
///   u_d   0.3 of the speed at full thrust, or the speed at a third of the thrust if that is higher;
///         at most 0.6 of the highest measured speed, or 10 m/s without measured speeds
///   psi   30 deg; less if the weaker mode takes longer than 20 s
///   hold  1.6 times the time of the weaker mode for 2 psi, at no more than the measured yaw rates;
///         5, 10, 15 or 20 s
/// The paper's vehicle has 30 then -30 deg at 1 m/s, 10 s each. [paper 4.3] Errors (input): as
/// Model::plant.
Result<Scenario> default_tuning_scenario(const Model& model);
/// Default tuning scenarios:
///   1. default_tuning_scenario(): the step favours fast gains, in turns that extrapolate the
///      model;
///   2. the same with the heading limited to the highest measured yaw rate, if the model has it:
///      favours gains that are accurate where the model is valid. Left out if `said` is a rate or
///      "none", which the caller applies;
///   3. with an observer: the last of these with a constant disturbance. Its moment is kPush of the
///      weaker mode's turning authority, its force kPush of g1(u_d) against the motion. Without a
///      disturbance, an observer would only add noise.
/// Errors (input): as Model::plant.
Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& said = {});
inline constexpr double kPush = 0.1;
/// Suffix of the name of a default scenario with a heading-rate limit.
inline constexpr std::string_view kLedSuffix = "_led";
/// Scenario for the evaluation after the search: twice the heading of default_tuning_scenario(),
/// then 0, at 0.7 of its speed. Errors (input): as Model::plant.
Result<Scenario> held_out_scenario(const Model& model);

/// Tunes the gains. Deterministic: model, options, seed and `arithmetic` determine every bit of the
/// result, for any number of cores. Errors (refused): no gains within the bounds meet the
/// constraints, the activity limit and the goals that are not soft; the message names the most
/// violated one. Errors (input): the model lacks a parameter; margin, weights, limits, bounds or
/// scenarios are invalid; runs with the baseline break off; the evaluations would take more than
/// 1e11 RK4 steps (some hours).
Result<Tuning> tune(const Model& model, const TuneOptions& options);

/// Content of gains.json.
std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance);

/// The JSON Schema of gains.json as gains_text() writes it.
std::string gains_schema();

}  // namespace awmr
