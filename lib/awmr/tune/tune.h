/// Gains by search: a global one, then a local one, under T2 < T1 with a margin and the sampled
/// loop's own limits.
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

/// The time constant that has to be below T1.
enum class ReachingForm {
  kPaper,   ///< T2 = eps/(2 mu), of V = S^2/2                                          [paper (95)]
  kStrict,  ///< eps/mu = 2 T2, of S itself
};
inline constexpr NameTable<ReachingForm, 2> kReachingFormNames{
    {{"paper", ReachingForm::kPaper}, {"strict", ReachingForm::kStrict}}};

/// Weights of the objective's terms, >= 0 and not all 0; each term is over its value with the
/// baseline's gains in the same mode and scenario (see objective.h).
struct ObjectiveWeights {
  double settling = 1.0;           ///< heading: settling time; the whole run where it never settles
  double itae = 0.5;               ///< heading: integral of t |psi_d - psi|, t from each step
  double overshoot = 1.0;          ///< heading: travel beyond the command
  double control_variation = 0.5;  ///< how restless the commands are
  double effort = 0.25;            ///< how large the commands are
  double speed_itae = 0.25;  ///< speed: integral of t |u_d - u|; without it mu_s, eps_s are free
};

/// Bounds of the search. Symbols and units as in model/gains.h. Absent: kBoundFactor either side of
/// pole placement, with the least mu that dominates and with wide layers; the constraints exclude
/// gains that are too fast for the sampled loop.
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
  /// RMS rate of the steering command, deg/s, > 0, that the readings' noise makes while a heading is
  /// held at the largest u_d in the mode that steers most. Absent: none for nominal gains; else 0.9
  /// of the servo's rate limit, at most its range 2 d_max over its time constant, or 1.25 times what
  /// the g3 that is fed forward of a noisy yaw rate makes with any gains, if that is more.
  std::optional<double> steering_rate_rms_degps = {};
  double damping = 0.7;           ///< smallest ratio of the loop without latency, (0, 1]
  double late_damping = 0.25;     ///< the same with latency and motor lag, (0, 1]
  double delayed_damping = 0.05;  ///< with twice the latency and a sample more, (0, 1]
  /// Share of the weaker mode's turning authority that the noise of a heading may take, (0, 1].
  double noise_share = 0.25;
};

/// Conditions of the constraints, from the scenarios and the vehicle.
struct ExaminedRange {
  double speed_mps = 1.0;                 ///< largest u_d, >= 0
  double step_rad = radians(60.0);        ///< largest change of the commanded heading, >= 0
  double yaw_rate_radps = radians(60.0);  ///< fastest that the runs reach, > 0
};

/// Gains that the objective is normalised by.
struct Baseline {
  Gains<double> gains{};
  std::string source;  ///< kPolePlacement, kPaperSource or the file that they were read from
};
inline constexpr const char* kPolePlacement = "pole-placement";
inline constexpr const char* kPaperSource = "paper";

/// A disturbance observer that is searched with the gains: its bandwidth.
struct ObserverSearch {
  Interval bandwidth_radps{0.2, 20.0};  ///< rad/s
  /// Largest moment and force that it compensates, m and dimensionless, > 0. Absent: kObserverShare
  /// of the weaker mode's turning authority, and of the force that the wheels have left at the
  /// largest u_d.
  std::optional<double> yaw_max_m, surge_max;
};
inline constexpr double kObserverShare = 0.5;

/// Draws that the search of three modes runs, and as many runs with fewer modes: 12 draws with one. Gains are
/// finished on all of them.
inline constexpr int kSearchedDraws = 4;
/// A share of the objective that does not matter: what it leaves open is settled by a rule.
inline constexpr double kIndifferent = 1e-3;
/// Relaxation of an active constraint, to measure its cost.
inline constexpr double kWider = 0.1;

/// Unmodelled variation that neither trials nor data sheets determine: payload, battery voltage,
/// values missing in a paper. The draws take the combinations in turn; the nominal plant has none.
struct UnmodelledVariation {
  std::vector<double> mass_factors = {};    ///< of m' and I'z alike; empty: 1
  std::vector<Interval> wheel_forces = {};  ///< F' of one wheel over F_max; empty: the vehicle's

  std::size_t combinations() const;  ///< >= 1
  bool any() const { return !mass_factors.empty() || !wheel_forces.empty(); }
};
inline constexpr double kLeastMassFactor = 0.1, kMostMassFactor = 10.0;
inline constexpr std::size_t kMostOpenValues = 20;  ///< of masses, and of forces

/// A figure of a run (run_figure_names()) and the most that it may be, > 0, in the figure's unit.
struct GoalLimit {
  std::string figure;
  double most = 0.0;
};

/// A share of the draws in which every limit is kept, in all scenarios.
struct TuningGoal {
  std::vector<GoalLimit> at_most;  ///< at least one, each figure once
  double share = 0.95;             ///< [kLeastShare, kMostShare]
  std::optional<YawMode> mode;     ///< absent: in each mode
  /// true: striven for, by what it is missed by in the objective; false: no gains that miss it on the
  /// draws of the search are taken.
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
  /// On the model's own values, with true readings at once and motors without lag, as a simulation
  /// alone would have it. Else robust: `draws` plants from the model's covariance in addition to its
  /// own, under LoopConditions. Every constraint holds for all of them.
  bool nominal = false;
  int draws = 32;                 ///< 0 ... 1000
  int evaluation_draws = 50;      ///< fresh draws for the evaluation of the gains, 0 ... 100000
  UnmodelledVariation open = {};  ///< of a robust search
  /// A part of the evaluation, for several machines: the whole search, and the fresh draws of the
  /// part (tune_shard.h).
  std::optional<Shard> shard = {};
  /// Share of the worst draws that count as the tail: the objective is the mean of the mean over all
  /// draws and of that over the tail (CVaR), (0, 1].
  double tail_share = 0.2;
  TuningLimits limits = {};
  /// The only mode that the gains are tuned for; absent: all of the vehicle's. Default scenarios are the same.
  std::optional<YawMode> mode = {};
  /// Absent: pole placement, the fastest that the constraints allow.
  std::optional<Baseline> baseline = {};
  /// Largest control variation over the baseline's in each mode, > 0, of a robust search; absent: no
  /// such limit.
  std::optional<double> activity_max = {};
  /// kPaper where the paper's own condition is to be kept; it admits twice the eps/mu.
  ReachingForm form = ReachingForm::kStrict;
  /// Reaching time constant <= margin T1, in (0, 1). A smaller one parts the two phases further.
  double margin = 0.8;
  ObjectiveWeights weights;
  int global_evaluations = 80;  ///< >= 1
  /// >= 0, of the local searches together; 0: the best of the global search is the answer.
  int local_evaluations = 80;
  /// Seed of the draws, their noise, the global search and the sensitivity samples. The gains of
  /// other seeds show how much they depend on chance.
  std::uint64_t seed = 1;
  /// Each has to hold headings, under a name of its own; empty: default_tuning_scenarios().
  std::vector<Scenario> scenarios;
  GainBounds bounds;
  std::optional<ObserverSearch> observer = {};  ///< absent: gains alone are searched
  std::vector<TuningGoal> goals = {};           ///< of a robust search
  /// Samples that say which of what was assumed moves the tuned loop: 0 (none) or kFewestSamples to
  /// kMostSamples; of a robust search.
  int sensitivity = 0;
  Progress progress = {};  ///< by runs of the search, each plant's counted
};

/// A constraint that is active at the gains.
struct ActiveConstraint {
  std::string name;  ///< of the constraint; "activity, MODE"; a goal
  /// The share of the objective that is gained where it may be broken by kWider, >= 0.
  double wider_gains = 0.0;
};

/// On which side of its limit a value must be.
enum class Sense { kAtMost, kAtLeast };
inline constexpr NameTable<Sense, 2> kSenseNames{
    {{"at-most", Sense::kAtMost}, {"at-least", Sense::kAtLeast}}};

struct ConstraintReport {
  std::string name;     ///< "T2 < T1 (strict)", ...
  double value = 0.0;   ///< of these gains
  double limit = 0.0;   ///< that the value must keep
  double margin = 0.0;  ///< distance of the value from its limit, >= 0 when it holds
  Sense sense = Sense::kAtMost;
  std::string meaning{};
  bool required = true;  ///< false: reported only (the form of T2 < T1 that was not requested)
};

/// One set of gains on one scenario in one mode.
struct ModeScore {
  std::string scenario;
  YawMode mode{};
  Metrics metrics{};
  double unsettled_s =
      0.0;  ///< takes the place of the settling time that a run does not have (objective.h)
  double objective =
      0.0;  ///< weighted geometric mean of its terms over the baseline's; 1 for itself
  bool has_failed = false;  ///< the run broke off: its metrics are those of what came before
};

/// A search's evaluation that was better than all before it.
struct SearchStep {
  int evaluation = 0;      ///< from 1
  double objective = 0.0;  ///< of gains that meet every constraint
};

/// Progress of a search, in the order of its evaluations.
struct SearchHistory {
  std::vector<SearchStep>
      best;  ///< kMostHistorySteps at most; the last are the gains that it ended at
  int global_evaluations = 0;  ///< those of the global search; behind them the local one's
  int evaluations = 0;
};
/// A longer history is thinned to evenly spaced steps, including the first and the last.
inline constexpr std::size_t kMostHistorySteps = 200;

/// Metrics of a run for goals and evaluation. The objective has others (objective.h).
struct RunOutcome {
  YawMode mode{};
  bool completed = false;  ///< settled after every step
  bool broke_off = false;  ///< its figures are those of what came before
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

/// Share of an input in the variance of a metric (tune/sobol.h).
struct SobolIndex {
  double first = 0.0;  ///< first order: in [0, 1] but for what too few samples leave open
  double total = 0.0;  ///< total, >= 0: with what it does together with others
  Interval first_ci95, total_ci95;  ///< by bootstrap
};
struct SensitiveFigure {
  YawMode mode{};
  std::string name;                  ///< "settling_time_s"
  double mean = 0.0;                 ///< in its unit
  double deviation = 0.0;            ///< standard deviation, >= 0
  std::vector<SobolIndex> by_input;  ///< in the order of GlobalSensitivity::inputs
};
/// Which of what was assumed moves the loop with the tuned gains.
struct GlobalSensitivity {
  int samples = 0;  ///< of the inputs, twice and once more for each input
  std::vector<std::string> inputs;
  std::vector<SensitiveFigure> figures;  ///< by mode, then figure
};

/// Result of a goal on fresh draws.
enum class GoalVerdict {
  kMet,     ///< all of the interval of the share is at or above that of the goal
  kMissed,  ///< all of it is below
  kOpen,    ///< neither: more draws are needed
};
inline constexpr NameTable<GoalVerdict, 3> kGoalVerdictNames{
    {{"met", GoalVerdict::kMet}, {"missed", GoalVerdict::kMissed}, {"open", GoalVerdict::kOpen}}};

/// A goal in one mode with one set of gains, over the evaluation draws.
struct EvaluatedGoal {
  TuningGoal goal;
  YawMode mode{};
  std::string gains;  ///< as in EvaluatedGains
  int held = 0;       ///< draws in which every limit is kept
  int runs = 0;       ///< draws
  Interval ci95;      ///< of the share, by Clopper and Pearson
  GoalVerdict verdict = GoalVerdict::kOpen;
};

/// Conditions of a robust search, and results of its gains.
struct RobustTuning {
  LoopConditions conditions;
  bool from_covariance = false;  ///< false: the model has none, so that only noise was drawn
  std::vector<EvaluatedGains> evaluated;  ///< by gains, then mode; empty of a part
  /// The same by scenario first; empty where there is one.
  std::vector<EvaluatedGains> evaluated_by_scenario;
  std::vector<EvaluatedGoal> goals;  ///< by gains, then goal, then mode; empty of a part
  std::vector<EvaluatedRuns> runs;   ///< of a part: those of its draws, by gains
  std::optional<GlobalSensitivity> sensitivity;  ///< absent if not requested
};

/// Settling against command activity: means over the modes, scenarios and plants of the search. A run that does not
/// settle counts with the scenario's duration.
struct TradeOffPoint {
  double settling_time_s = 0.0;
  double control_variation = 0.0;  ///< 1/s, as Metrics::control_variation
};
struct NamedTradeOff {
  std::string gains;  ///< "tuned", "baseline", "paper", "lqi"
  TradeOffPoint point;
};
struct TradeOff {
  /// Pareto front of the feasible gains that the search evaluated, by settling time.
  std::vector<TradeOffPoint> front;
  /// On the same runs; without those whose runs break off. "lqi": the LQI law (control/heading_lqi.h) by
  /// Bryson's rule, with a sixth of the step, the step in 1.5 s, four seconds of that error and a quarter of the
  /// weaker mode's turning authority.
  std::vector<NamedTradeOff> named;
};

/// Worst case of a metric of the loop over the model's confidence set.
struct WorstCase {
  double value = 0.0;
  double yaw_rate_radps = 0.0;
  /// That the loop depends on, with their values there.
  std::vector<std::pair<ParameterId, double>> parameters = {};
};
struct ModeCertificate {
  YawMode mode{};
  WorstCase damping = {};         ///< smallest damping ratio; <= 0: not stable
  WorstCase delay_margin_s = {};  ///< further delay that is borne, s; infinity: any
};
/// Damping and delay margin of the sampled heading loop with hold, servo, latency and motor lag that hold for all
/// of the model's 95 % confidence set (tune/certificate.h).
struct Certificate {
  int parameters = 0;          ///< fitted ones with a covariance; 0: the model's own values alone
  int degrees_of_freedom = 0;  ///< of their ellipsoid
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
  TuningLimits limits;  ///< that the search kept, each with its value
  ExaminedRange examined;
  double baseline_objective = 0.0;
  std::vector<ModeScore> baseline_scores;
  std::string algorithm;
  int evaluations = 0;
  std::string stop_reason;
  std::uint64_t seed = 0;
  int simulated = 0;  ///< evaluations that were simulated; the others broke a constraint beforehand
  /// Where mu and epsilon are scaled together and the objective rises by at most kIndifferent, the
  /// constraints being met; the least mu is taken. Then the same of mu_s and epsilon_s.
  Interval mu_as_good, speed_mu_as_good;
  std::vector<ActiveConstraint> active;
  std::string arithmetic;  ///< how the runs were rounded: as BatchArithmetic::rounding
  SearchHistory history;
  /// The tuned gains on a scenario that the search never saw, and how the baseline would score 1
  /// there: for information, it decides nothing.
  std::vector<ModeScore> held_out_scores;
  double held_out_objective = 0.0;
  std::optional<Certificate> certificate;  ///< tune() gives one
  TradeOff trade_off;
  std::optional<RobustTuning> robust;  ///< absent for nominal gains
};

/// The scenario tuned on when none is given: a heading, then its opposite, from rest, at the speed, by the
/// angle and for the time that suit the vehicle:
///   u_d   0.3 of the speed at full thrust, or that at a third of the thrust if it is faster; at most
///         0.6 of the fastest measured speed; 10 m/s at most where nothing was measured
///   psi   30 deg; less where the weaker mode turns too slowly for 20 s
///   hold  1.6 times what the weaker mode takes for 2 psi, no faster than turning was measured; in
///         steps of 5 s from 5 to 20 s
/// The paper's vehicle has 30 then -30 deg at 1 m/s, 10 s each. [paper 4.3] Errors (input): as
/// Model::plant.
Result<Scenario> default_tuning_scenario(const Model& model);
/// The same, then, where the model says how fast yaw resistance was measured, with the heading
/// limited to that rate: the step asks for quick gains, in turns that extrapolate the model; the
/// limited one for those that are accurate where it holds. With a rate or "none" `said` the first
/// alone, for the caller to limit. For an observer the last one again behind them, pushed all the
/// time, by kPush of the weaker mode's turning authority and against the motion by kPush of g1(u_d):
/// without a push an observer only lets noise in. Errors (input): as Model::plant.
Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& said = {});
inline constexpr double kPush = 0.1;
/// Behind the name of a default scenario whose heading rate is limited.
inline constexpr std::string_view kLedSuffix = "_led";
/// The scenario that gains are scored on afterwards: twice the heading, then 0, at 0.7 of the speed
/// of default_tuning_scenario(). Errors (input): as Model::plant.
Result<Scenario> held_out_scenario(const Model& model);

/// Deterministic: model, options, seed and `arithmetic` fix every bit of the result, whatever the
/// number of cores. Errors (refused): no gains within the bounds meet the constraints, the activity or
/// the goals that are not soft; the one that is broken most is named. Errors (input): the model lacks
/// a parameter; margin, weights, limits, bounds or scenarios are unfit; runs with the baseline break
/// off; all evaluations together would take more than 1e11 RK4 steps, some hours.
Result<Tuning> tune(const Model& model, const TuneOptions& options);

/// The bytes of gains.json.
std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance);

/// The JSON Schema of gains.json as gains_text() writes it.
std::string gains_schema();

}  // namespace awmr
