/// Tuning of the gains of heading and speed law: options, constraints, goals and result of tune().
#pragma once

#include <cstdint>
#include <functional>
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
#include "awmr/core/units.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Definition of the reaching time constant, which must be below T1 = 1/lambda. S = e_dot + lambda
/// e is the sliding variable of the heading law, e the heading error (model/gains.h).
enum class ReachingForm {
  kPaper,   ///< decay time of V = S^2/2: T2 = eps/(2 mu)                               [paper (95)]
  kStrict,  ///< decay time of S itself: eps/mu = 2 T2
};
inline constexpr NameTable<ReachingForm, 2> kReachingFormNames{
    {{"paper", ReachingForm::kPaper}, {"strict", ReachingForm::kStrict}}};

/// Weights of the objective's terms, 0 to 1e6 and not all 0. Each term is the ratio of a metric to
/// its value with the baseline gains in the same mode and scenario (see objective.h).
struct ObjectiveWeights {
  double settling = 1.0;           ///< heading: settling time; for a run that does not settle, its
                                   ///< substitute unsettled_s() (objective.h)
  double itae = 0.5;               ///< heading: integral of t |psi_d - psi|, t from each step
  double overshoot = 1.0;          ///< heading: largest travel beyond a commanded heading
  double control_variation = 0.5;  ///< total variation of the commands (Metrics)
  double effort = 0.25;            ///< mean sum of squared commands (Metrics::control_effort)
  double speed_itae = 0.25;  ///< speed: integral of t |u_d - u|; with weight 0, mu_s and eps_s are
                             ///< not determined
};

/// Bounds of each gain in the search. Symbols and units as in model/gains.h. Pole placement gives
/// two sets of gains: with the smallest mu, and with wide boundary layers (pole_placement.h). An
/// absent interval means: from the smaller of these two values, divided by kBoundFactor, to the
/// larger one times kBoundFactor.
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
  /// held at the largest u_d of the scenarios (steering_rate_rms_degps() in steering_rate.h).
  /// Absent in a nominal search: no limit. Absent in a robust search: the larger of
  ///   - 0.9 of the servo's rate limit, which counts as at most 2 d_max/T, T its time constant;
  ///   - 1.25 times the rate that the feed-forward g3(r) of a noisy yaw rate causes by itself.
  std::optional<double> steering_rate_rms_degps = {};
  double damping = 0.7;  ///< smallest damping ratio of the heading loop without latency
                         ///< and motor lag, [1e-6, 1]
  double late_damping =
      0.25;  ///< smallest dominant_damping_ratio() with latency and motor lag, [1e-6, 1]
  double delayed_damping = 0.05;  ///< smallest damping ratio with motor lag and twice the latency
                                  ///< plus one sample, [1e-6, 1]
  /// Largest share of the largest yaw moment of the weaker mode (turning_authority_m()) that
  /// heading noise of one standard deviation may request, [1e-6, 1]. A nominal search assumes a
  /// noise of 1 deg.
  double noise_share = 0.25;
};

/// Largest speed, heading step and yaw rate for which the constraints are evaluated. They are
/// computed from the scenarios and the vehicle.
struct ExaminedRange {
  double speed_mps = 1.0;                 ///< largest u_d of the scenarios, >= 0
  double step_rad = radians(60.0);        ///< largest change of the commanded heading, >= 0
  double yaw_rate_radps = radians(60.0);  ///< highest yaw rate expected in the runs, > 0
};

/// Reference gains of the objective: each metric is divided by its value with these gains.
struct Baseline {
  Gains<double> gains{};
  std::string source;  ///< kPolePlacement, kPaperSource or the file that they were read from
};
inline constexpr const char* kPolePlacement = "pole-placement";
inline constexpr const char* kPaperSource = "paper";

/// Options to search the bandwidth of a disturbance observer together with the gains.
struct ObserverSearch {
  Interval bandwidth_radps{0.2, 20.0};  ///< rad/s
  /// Largest moment (m) and force (dimensionless) that the observer compensates, > 0. Absent:
  /// kObserverShare of the largest yaw moment of the weaker mode (turning_authority_m()), and
  /// kObserverShare of the wheel force that remains at the largest u_d after overcoming g1.
  std::optional<double> yaw_max_m, surge_max;
};
inline constexpr double kObserverShare = 0.5;

/// Number of drawn plants in the search, except in its last part, which uses all draws. It applies
/// to three tuned modes; with one mode it is 12, so that the number of runs is the same. It is
/// raised to UnmodelledVariation::combinations() if that is larger.
inline constexpr int kSearchedDraws = 4;
/// Relative difference of the objective below which gains are equally good. settle()
/// (sensitivity.h) selects among equally good gains.
inline constexpr double kIndifferent = 1e-3;
/// Relative relaxation of the limit of an active constraint, to measure how much of the objective
/// the limit costs (ActiveConstraint::wider_gains).
inline constexpr double kWider = 0.1;

/// Unmodelled variation of the vehicle, which neither trials nor data sheets determine, such as
/// payload and battery voltage. Each draw gets the next combination of a mass factor and a
/// wheel-force range; the nominal plant is not varied.
struct UnmodelledVariation {
  std::vector<double> mass_factors = {};    ///< factors on both m' and I'z; empty: 1
  std::vector<Interval> wheel_forces = {};  ///< ranges of F'; empty: the vehicle's own range

  std::size_t combinations() const;  ///< >= 1
  bool any() const { return !mass_factors.empty() || !wheel_forces.empty(); }
};
inline constexpr double kMinMassFactor = 0.1, kMaxMassFactor = 10.0;
inline constexpr std::size_t kMaxOpenValues = 20;  ///< largest number of entries in each list

/// Upper limit, 1e-9 to 1e9, of a run's metric (tune/goals.h), in the metric's unit.
struct GoalLimit {
  std::string figure;  ///< name of the metric, such as "settling_time_s"
  double most = 0.0;   ///< the limit
};

/// Goal: at least this share of the draws meets every limit in all scenarios.
struct TuningGoal {
  std::vector<GoalLimit> at_most;  ///< one or more limits, each of another metric
  double share = 0.95;          ///< required share of the draws, in [kMinGoalShare, kMaxGoalShare]
  std::optional<YawMode> mode;  ///< the mode in which it must be met; absent: in each mode
  /// true: the objective has a penalty for missing the goal. false: a constraint; gains that miss
  /// it on the draws of the search are rejected.
  bool is_soft = false;
};
inline constexpr double kMinGoalShare = 0.5, kMaxGoalShare = 0.999;
inline constexpr std::size_t kMaxGoals = 20;
/// Default of evaluation_draws in a tune.json with goals.
inline constexpr int kGoalDraws = 500;

struct TuneOptions {
  std::string file = "tune.json";  ///< name of the options' file in error messages: the path that
                                   ///< it was read from
  /// true: tune on the identified plant only, with noise-free sensors without latency and motors
  /// without lag. false (robust): tune also on `draws` plants from the model's covariance, with the
  /// noise, latency and lag of LoopConditions. The gains meet every constraint on all of these
  /// plants.
  bool nominal = false;
  int draws = 32;                 ///< drawn plants of the search, 0 ... 1000
  int evaluation_draws = 50;      ///< new draws for the evaluation of the gains, 0 ... 100000
  UnmodelledVariation open = {};  ///< robust search only
  /// Share of the draws that counts as the tail, (0, 1]: the worst ones. The objective averages the
  /// mean over all draws and the mean over the tail (CVaR).
  double tail_share = 0.2;
  TuningLimits limits = {};
  /// The only mode to tune for; absent: all modes of the vehicle. It does not change the default
  /// scenarios.
  std::optional<YawMode> mode = {};
  /// Absent: the baseline is the gains with the fastest poles that the constraints allow
  /// (pole_placement.h).
  std::optional<Baseline> baseline = {};
  /// Largest ratio of the control variation to that of the baseline gains, in each mode, > 0.
  /// Absent: no limit.
  std::optional<double> activity_max = {};
  /// Form of the condition T2 < T1 that is required. kPaper allows twice as large an eps/mu as
  /// kStrict.
  ReachingForm form = ReachingForm::kStrict;
  /// Required: reaching time constant (ReachingForm) <= margin T1, T1 = 1/lambda. In (0, 1). A
  /// smaller margin makes the approach to the sliding surface faster, compared with the motion on
  /// it.
  double margin = 0.8;
  ObjectiveWeights weights;
  int global_evaluations = 80;  ///< >= 1
  /// >= 0: budget of all local searches together; 0: no local search.
  int local_evaluations = 80;
  /// Seed of the draws, their noise and the global search. Tune with other seeds to see how much
  /// the gains depend on chance.
  std::uint64_t seed = 1;
  /// Each needs heading guidance and a unique name. Empty: default_tuning_scenarios().
  std::vector<Scenario> scenarios;
  GainBounds bounds;
  std::optional<ObserverSearch> observer = {};  ///< absent: see adds_observer
  /// Used if `observer` is absent. true: repeats the search with an observer (with the defaults of
  /// ObserverSearch) if fewer than 95 % of the runs settle with the tuned gains (if no gains meet
  /// the limits: with the nearest ones), and an observer lets a scenario and mode settle
  /// (observer_settles_more() in settling.h). The result with the observer is kept if the share of
  /// settled runs is larger by 0.05 or more. Dry friction in yaw is the usual cause. false: no
  /// observer is tuned.
  bool adds_observer = true;
  std::vector<TuningGoal> goals = {};  ///< robust search only
  /// Called with the number of evaluated sets of gains, and with the budget global_evaluations +
  /// local_evaluations. The last stage of the search, on all draws, is not counted. The number
  /// begins at 0 again if the search is repeated with an observer (adds_observer).
  Progress progress = {};
  /// Called before a search of more than about 10 s, with its expected duration. Also called before
  /// the search is repeated with an observer (adds_observer), with the reason.
  std::function<void(std::string_view)> notice = {};
};

/// Applies a choice of the user: true searches an observer (with the configured or default
/// ObserverSearch), false searches none. Absent: the options are unchanged.
void choose_observer(std::optional<bool> observer, TuneOptions& options);

/// A constraint that is active at the tuned gains.
struct ActiveConstraint {
  std::string name;  ///< name of a constraint or a goal, or "activity, MODE"
  /// Relative improvement of the objective if the limit is relaxed by kWider, >= 0.
  double wider_gains = 0.0;
};

/// Whether a limit is an upper (at most) or a lower (at least) one.
enum class Sense { kAtMost, kAtLeast };
inline constexpr NameTable<Sense, 2> kSenseNames{
    {{"at-most", Sense::kAtMost}, {"at-least", Sense::kAtLeast}}};

/// A constraint with its value for one set of gains.
struct ConstraintReport {
  std::string name;     ///< "T2 < T1 (strict)", ...
  double value = 0.0;   ///< with these gains
  double limit = 0.0;   ///< limit of the value
  double margin = 0.0;  ///< distance of the value from its limit, >= 0 if the constraint is met
  Sense sense = Sense::kAtMost;
  std::string meaning{};  ///< formula or description with the unit, for the user
  bool required = true;   ///< false: reported only (the form of T2 < T1 that was not requested)
};

/// Score of one set of gains in one scenario and mode.
struct ModeScore {
  std::string scenario;
  YawMode mode{};
  Metrics metrics{};
  double unsettled_s = 0.0;  ///< substitute for an absent settling time (objective.h)
  double objective = 0.0;    ///< J of this run (objective.h); 1 with the baseline gains
  bool has_failed = false;   ///< the run broke off; the metrics are those up to that time
};

/// An evaluation of the search that improved on all earlier ones.
struct SearchStep {
  int evaluation = 0;      ///< number of the evaluation, from 1
  double objective = 0.0;  ///< objective of the evaluated gains, which meet every constraint
};

/// Progress of a search.
struct SearchHistory {
  /// In the order of the evaluations, at most kMaxHistorySteps. Only evaluations on the draws of
  /// the search (kSearchedDraws) are included, so the result can differ from the last step: the
  /// last stage uses all draws, and settle() selects among equally good gains.
  std::vector<SearchStep> best;
  int global_evaluations = 0;  ///< evaluations of the global search, which comes first
  int evaluations = 0;         ///< evaluations of the global and the local searches on these draws
};
/// A longer history is thinned to evenly spaced steps, including the first and the last.
inline constexpr std::size_t kMaxHistorySteps = 200;

/// A metric of the runs of one set of gains in one mode, over the evaluation draws.
struct EvaluatedFigure {
  std::string name;  ///< such as "heading_iae_degs"
  double median = 0.0;
  double q95 = 0.0;        ///< 95 % quantile
  double tail_mean = 0.0;  ///< mean over the worst tail_share of the draws (CVaR)
};

/// Name of the tuned gains in EvaluatedGains::gains.
inline constexpr const char* kRobustGains = "robust";

/// One set of gains in one mode, over the evaluation draws.
struct EvaluatedGains {
  /// kRobustGains, "baseline", "paper" (if the baseline is another) or "unobserved" (the tuned
  /// gains without their observer).
  std::string gains;
  YawMode mode{};
  double completed_share = 0.0;  ///< share of the runs that settle after every step, [0, 1]
  std::vector<EvaluatedFigure> figures;
  std::string scenario = {};  ///< empty: all scenarios together
};

/// Verdict on a goal from the share of the new draws that meet it (EvaluatedGoal::ci95).
enum class GoalVerdict {
  kMet,     ///< the whole 95 % interval of the share is at or above the required share
  kMissed,  ///< the whole 95 % interval of the share is below the required share
  kOpen,    ///< the interval contains the required share: more draws are needed
};
inline constexpr NameTable<GoalVerdict, 3> kGoalVerdictNames{
    {{"met", GoalVerdict::kMet}, {"missed", GoalVerdict::kMissed}, {"open", GoalVerdict::kOpen}}};

/// A goal in one mode with one set of gains, over the evaluation draws.
struct EvaluatedGoal {
  TuningGoal goal;
  YawMode mode{};
  std::string gains;  ///< name of the gains, as in EvaluatedGains::gains
  int held = 0;       ///< number of draws that meet every limit
  int runs = 0;       ///< number of all draws
  Interval ci95;      ///< 95 % interval of the share held/runs, by Clopper and Pearson
  GoalVerdict verdict = GoalVerdict::kOpen;
};

/// Conditions of a robust search, and the evaluation of its gains on new draws.
struct RobustTuning {
  LoopConditions conditions;
  /// false: the model has no covariance, so the draws differ by noise and unmodelled variation
  /// only.
  bool from_covariance = false;
  /// Statistics over the new draws, sorted by gains, then mode. Empty without new draws.
  std::vector<EvaluatedGains> evaluated;
  /// The same statistics for each scenario alone, sorted by scenario, then gains, then mode; empty
  /// with a single scenario.
  std::vector<EvaluatedGains> evaluated_by_scenario;
  std::vector<EvaluatedGoal> goals;  ///< by gains, then goal, then mode
};

/// Settling time and control variation of one set of gains, each as the mean over the modes,
/// scenarios and plants of the search. The settling time of a run that does not settle is the
/// scenario's duration.
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
  /// Points of named gains on the same runs. Gains with a run that breaks off are left out.
  /// "lqi": the LQI law (control/heading_lqi.h) with weights by Bryson's rule. With s the largest
  /// heading step, the acceptable values are: heading error s/6, yaw rate s/(1.5 s), integral of
  /// the error (s/6)(4 s), and moment a quarter of the weaker mode's largest.
  std::vector<NamedTradeOff> named;
};

/// Smallest value of a damping ratio or delay margin over the model's confidence set.
struct WorstCase {
  double value = 0.0;
  double yaw_rate_radps = 0.0;  ///< yaw rate of the worst case
  /// Values of the loop's parameters in the worst case.
  std::vector<std::pair<ParameterId, double>> parameters = {};
};
struct ModeCertificate {
  YawMode mode{};
  WorstCase damping = {};         ///< smallest damping ratio; <= 0: unstable
  WorstCase delay_margin_s = {};  ///< smallest additional delay, s, that makes the loop unstable;
                                  ///< infinity: none does
};
/// Smallest damping ratio and delay margin found over the model's 95 % confidence set
/// (tune/certificate.h), for the sampled heading loop with hold, servo, latency and motor lag.
struct Certificate {
  int parameters = 0;          ///< number of parameters in the model's covariance; 0: only the
                               ///< model's own values were examined
  int degrees_of_freedom = 0;  ///< degrees of freedom of the confidence ellipsoid
  Interval yaw_rate_radps;     ///< examined yaw rates
  double latency_s = 0.0;      ///< latency of the sensor readings
  double motor_time_constant_s = 0.0;
  std::vector<ModeCertificate> modes;

  double damping_min() const;
  double delay_margin_s() const;
};
inline constexpr double kCertifiedShare = 0.95;  ///< probability of the confidence set

/// A change with which runs settle.
struct SettlingChange {
  std::string pointer;  ///< place in tune.json: "/observer"
  std::string text;     ///< the change, with its number
};
/// Runs of which fewer than 95 % settle with the tuned gains.
struct UnsettledRuns {
  std::string scenario;  ///< name of the scenario; empty if there is only one
  YawMode mode{};
  std::string why;  ///< reason why the mode cannot turn the vehicle (turning.h); empty if it can
  std::vector<SettlingChange> changes;  ///< changes_that_settle() (settling.h)
};

/// Result of tune().
struct Tuning {
  Gains<double> gains{};
  std::vector<ConstraintReport> constraints;
  double objective = 0.0;         ///< J over all modes, scenarios and plants (objective.h)
  std::vector<ModeScore> scores;  ///< scores on the nominal plant, by mode, then scenario
  Baseline baseline;
  TuningLimits limits;  ///< limits of the search, with the defaults filled in
  ExaminedRange examined;
  double baseline_objective = 0.0;  ///< 1, plus the terms of soft goals
  std::vector<ModeScore> baseline_scores;
  /// Required constraints, requested bounds, activity limit and goals that the baseline gains do
  /// not meet. The objective of the tuned gains, which meet them, can then be above that of the
  /// baseline.
  std::vector<ConstraintReport> baseline_violates;
  std::string algorithm;
  int evaluations = 0;  ///< sets of gains that the search evaluated, on some or all draws
  std::string stop_reason;
  std::uint64_t seed = 0;
  int simulated = 0;  ///< evaluations with simulated runs; the others violate a constraint
  /// Range of mu, with mu/epsilon kept constant, in which the constraints are met and the objective
  /// on the draws of the search is at most kIndifferent/2 worse than the best. The smallest mu is
  /// selected. With this mu, speed_mu_as_good is the same range of mu_s, with mu_s/epsilon_s kept
  /// constant and an objective at most kIndifferent worse than the best.
  Interval mu_as_good, speed_mu_as_good;
  std::vector<ActiveConstraint> active;
  std::string arithmetic;  ///< how the runs were rounded: as BatchArithmetic::rounding
  SearchHistory history;
  /// Scores and objective of the tuned gains in a scenario that the search did not use
  /// (held_out_scenario()), for information only. The baseline has the objective 1 there.
  std::vector<ModeScore> held_out_scores;
  double held_out_objective = 0.0;
  std::optional<Certificate> certificate;  ///< always present in the result of tune()
  TradeOff trade_off;
  bool observer_added = false;  ///< an observer was tuned because of TuneOptions::adds_observer
  std::vector<UnsettledRuns> unsettled;
  std::optional<RobustTuning> robust;  ///< absent for nominal gains
};

/// Default tuning scenario: from rest, a heading and then its opposite. Speed, angle and time are
/// scaled to the vehicle:
///   u_d   0.3 of the speed at full thrust, or the speed at a third of the thrust if it is higher;
///         at most 0.6 of the highest measured speed, or 10 m/s without measured speeds
///   psi   30 deg; if the hold would exceed 20 s, less in steps of 5 deg, down to 5 deg
///   hold  time that each heading is commanded: 1.6 times the time that the weaker mode takes to
///         turn by 2 psi without exceeding the measured yaw rates; rounded to 5, 10, 15 or 20 s
/// The paper's vehicle has 30 then -30 deg at 1 m/s, 10 s each. [paper 4.3] Errors (input): those
/// of Model::plant().
Result<Scenario> default_tuning_scenario(const Model& model);
/// Default tuning scenarios:
///   1. default_tuning_scenario(): heading steps. They favour fast gains, at yaw rates above the
///      measured ones.
///   2. The same with the heading rate limited to the highest measured yaw rate. It favours gains
///      that are accurate where the model is valid. Left out if the model has no measured yaw rate,
///      or if `choice` (--heading-rate-limit) is not empty: then the caller applies `choice`.
///   3. Only if TuneOptions::observer is present: the last scenario of this list with a constant
///      disturbance added, because without a disturbance an observer only adds noise. The moment is
///      kPush times the largest moment of the weaker mode (turning_authority_m()). The force is
///      kPush times g1(u_d), against the motion.
/// Errors (input): those of Model::plant().
Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& choice = {});
inline constexpr double kPush = 0.1;  ///< size of the disturbance, see default_tuning_scenarios()
/// Suffix of the name of a default scenario with a heading-rate limit.
inline constexpr std::string_view kLedSuffix = "_led";
/// Scenario for the evaluation after the search: twice the first heading of
/// default_tuning_scenario(), then the heading 0, at 0.7 of its speed. Errors (input): those of
/// Model::plant().
Result<Scenario> held_out_scenario(const Model& model);

/// Tunes the gains by a global and then local searches (search.h). Deterministic: model, options
/// and the instruction set (Tuning::arithmetic) determine every bit of the result, for any number
/// of cores.
/// Errors (refused): no gains within the bounds meet the constraints, the activity limit and the
/// goals that are not soft (the message names the most violated one); in every mode, the largest
/// yaw moment is below the yaw resistance at 1 deg/s (turning.h); runs diverge with all gains; no
/// run of the nominal vehicle settles with the tuned gains.
/// Errors (input): the model lacks a parameter; an option is invalid (check_options.h); the latency
/// exceeds 20 samples; no wheel force is left for an observer; runs with the baseline break off;
/// the evaluations would take more than 1e11 RK4 steps (some hours).
Result<Tuning> tune(const Model& model, const TuneOptions& options);

/// Content of gains.json.
std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance);

/// The JSON Schema of gains.json as gains_text() writes it.
std::string gains_schema();

}  // namespace awmr
