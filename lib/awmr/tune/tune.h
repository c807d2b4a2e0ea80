/// Tuning of the gains of heading and speed law: options, constraints, goals and result of tune().
#pragma once

#include <cstddef>
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
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"

namespace awmr {

/// Definition of the reaching time constant, with which the heading law decreases its sliding
/// variable S = e_dot + lambda e (model/gains.h; e: heading error). It must be below T1 = 1/lambda,
/// with which e decays once S = 0.
enum class ReachingForm {
  kPaper,   ///< decay time of V = S^2/2: T2 = eps/(2 mu)                               [paper (95)]
  kStrict,  ///< decay time of S itself: eps/mu = 2 T2
};
inline constexpr NameTable<ReachingForm, 2> kReachingFormNames{
    {{"paper", ReachingForm::kPaper}, {"strict", ReachingForm::kStrict}}};

/// Weights of the terms of the objective, 0 to 1e6 and not all 0. Each term is the ratio of a
/// metric to its value with the baseline gains in the same mode and scenario (see objective.h).
struct ObjectiveWeights {
  /// Heading: settling time. A run that does not settle counts with unsettled_s() (objective.h).
  double settling = 1.0;
  /// Heading: integral of t |psi_d - psi| over time, t counted from each heading step.
  double itae = 0.5;
  /// Heading: largest travel beyond a commanded heading.
  double overshoot = 1.0;
  /// Total variation of the commands (Metrics::control_variation).
  double control_variation = 0.5;
  /// Mean sum of the squared commands (Metrics::control_effort).
  double effort = 0.25;
  /// Speed: integral of t |u_d - u| over time. If this weight is 0, the gains mu_s and eps_s of the
  /// speed law are not determined.
  double speed_itae = 0.25;
};

/// Bounds of each gain in the search. Symbols and units as in model/gains.h. The default bounds of
/// a gain follow from its values in two sets of gains, both by pole placement: one with the
/// smallest mu, one with wide boundary layers (pole_placement.h). The lower bound is the smaller
/// value divided by kBoundFactor, the upper bound the larger value times kBoundFactor.
struct GainBounds {
  std::optional<Interval> lambda = {};         ///< 1/s
  std::optional<Interval> mu = {};             ///< rad/s^2
  std::optional<Interval> epsilon = {};        ///< rad/s
  std::optional<Interval> speed_mu = {};       ///< m/s^2
  std::optional<Interval> speed_epsilon = {};  ///< m/s
};
inline constexpr double kBoundFactor = 10.0;

/// Limits that the tuned gains must meet.
struct TuningLimits {
  /// Largest RMS rate of the steering command that sensor noise causes, deg/s, > 0, while a heading
  /// is held at the largest u_d of the scenarios (steering_rate.h). If absent, a nominal search has
  /// no limit, and a robust search uses the larger of
  ///   - 0.9 of the servo's rate limit, which counts as at most 2 d_max/T, T its time constant;
  ///   - 1.25 times the rate that noise causes through the feed-forward of the yaw resistance g3
  ///     alone, without Coulomb friction.
  std::optional<double> steering_rate_rms_degps = {};
  /// Smallest damping ratio of the heading loop without latency and motor lag, [1e-6, 1].
  double damping = 0.7;
  /// Smallest damping ratio with latency and motor lag, [1e-6, 1]. Poles that decay much faster
  /// than the slowest pole count less (dominant_damping_ratio() in sampled_loop.h).
  double late_damping = 0.25;
  /// Smallest damping ratio with motor lag and with twice the latency plus one sample, [1e-6, 1].
  double delayed_damping = 0.05;
  /// Heading noise of one standard deviation may request at most this share of the largest yaw
  /// moment of the weaker mode (turning_authority_m()), [1e-6, 1]. A nominal search assumes a noise
  /// of 1 deg.
  double noise_share = 0.25;
};

/// Speed, heading step and yaw rate for which the constraints are evaluated. tune() computes them
/// from the scenarios and the vehicle.
struct ExaminedRange {
  double speed_mps = 1.0;                 ///< largest u_d of the scenarios, >= 0
  double step_rad = radians(60.0);        ///< largest change of the commanded heading, >= 0
  double yaw_rate_radps = radians(60.0);  ///< highest yaw rate expected in the runs, > 0
};

/// Reference gains of the objective: each metric of a run is divided by its value with these gains.
/// A search for one mode uses the gains of this mode. A search for all modes uses the gains of
/// combined mode.
struct Baseline {
  ModeGains gains{};
  /// kPolePlacement, kPaperSource or the file from which the gains were read.
  std::string source;

  /// The baseline of a search for one mode; for all modes if `mode` is absent.
  Baseline in(std::optional<YawMode> mode) const {
    return {gains.in(mode.value_or(YawMode::kCombined)), source};
  }
};
inline constexpr const char* kPolePlacement = "pole-placement";
inline constexpr const char* kPaperSource = "paper";

/// Options to search the bandwidth of a disturbance observer together with the gains.
struct ObserverSearch {
  Interval bandwidth_radps{0.2, 20.0};  ///< rad/s
  /// Largest yaw moment (m) and surge force (divided by F_max) that the observer compensates, > 0.
  /// Default of the moment: the dry friction in yaw (Coulomb friction c3 plus tyre scrub) plus
  /// kObserverShare of what this friction leaves of the largest moment of the weaker mode
  /// (turning_authority_m()). With a limit below the friction, the vehicle would rest beside the
  /// commanded heading. Default of the force: kObserverShare of the wheel force that is left at the
  /// largest u_d after overcoming the surge resistance g1.
  std::optional<double> yaw_max_m, surge_max;
};
inline constexpr double kObserverShare = 0.5;

/// Number of drawn vehicles on which the search evaluates gains if it tunes three modes. A search
/// for one mode uses 12, so the number of runs is the same. If the options contain unmodelled
/// variation, the search uses at least UnmodelledVariation::combinations() vehicles. Only the last
/// part of the search uses all drawn vehicles.
inline constexpr int kSearchedDraws = 4;
/// Relative difference of objectives below which gains count as equally good (settle()).
inline constexpr double kIndifferent = 1e-3;
/// Fraction by which the limit of an active constraint is relaxed, to measure by how much the limit
/// worsens the objective (ActiveConstraint::wider_gains).
inline constexpr double kWider = 0.1;

/// Variation of the vehicle that neither trials nor data sheets determine, such as payload and
/// battery voltage. The drawn vehicles take the combinations of mass factor and wheel-force range
/// in turn. The nominal plant is not varied.
struct UnmodelledVariation {
  std::vector<double> mass_factors = {};  ///< factors on both m' and I'z, [0.1, 10]; empty: 1
  /// ranges of the wheel force F'; empty: the vehicle's own
  std::vector<Interval> wheel_forces = {};

  std::size_t combinations() const;  ///< >= 1
  bool any() const { return !mass_factors.empty() || !wheel_forces.empty(); }
};
inline constexpr std::size_t kMaxOpenValues = 20;  ///< largest length of each list

/// Upper limit of a metric of a run, 1e-9 to 1e9, in the unit of the metric (goals.h).
struct GoalLimit {
  std::string figure;  ///< name of the metric, such as "settling_time_s"
  double most = 0.0;   ///< the limit
};

/// Goal: at least the required share of the drawn vehicles meets every limit in all scenarios.
struct TuningGoal {
  std::vector<GoalLimit> at_most;  ///< one or more limits, each of another metric
  /// Required share of the drawn vehicles, [0.5, 0.999].
  double share = 0.95;
  std::optional<YawMode> mode;  ///< the only mode in which it must be met; absent: all
  /// true: missing the goal only increases the objective. false: the goal is a constraint; gains
  /// that miss it on the draws of the search are rejected.
  bool is_soft = false;
};
inline constexpr std::size_t kMaxGoals = 20;
/// Default of evaluation_draws if tune.json has goals.
inline constexpr int kGoalDraws = 500;

struct TuneOptions {
  /// Path of the options' file, for the places of errors. Empty: the options are not from a file.
  std::string file = {};
  /// true: tune on the identified plant only, with ideal sensors (no noise, no latency) and motors
  /// (no lag). false (robust): tune on the identified plant and on `draws` plants from the model's
  /// covariance, with the noise, latency and lag of LoopConditions. The gains then meet every
  /// constraint on all plants.
  bool nominal = false;
  int draws = 32;  ///< vehicles drawn for the search, 0 ... 1000
  /// Number of further vehicles that are drawn to evaluate the tuned gains, 0 ... 100000.
  int evaluation_draws = 50;
  UnmodelledVariation open = {};  ///< robust search only
  /// Share of the drawn vehicles that form the tail, the worst of them, (0, 1]. The objective
  /// averages the means over all drawn vehicles and over the tail (CVaR, conditional value at
  /// risk).
  double tail_share = 0.2;
  TuningLimits limits = {};
  /// The only mode to tune for; absent: all modes.
  std::optional<YawMode> mode = {};
  /// Gains that the objective compares with. Absent: the gains with the fastest poles that the
  /// constraints allow (pole_placement.h).
  std::optional<Baseline> baseline = {};
  /// Largest control variation (Metrics::control_variation) in each mode, as a multiple of its
  /// value with the baseline gains, > 0. Absent: no limit.
  std::optional<double> activity_max = {};
  /// Required form of T2 < T1. kPaper permits twice the eps/mu of kStrict.
  ReachingForm form = ReachingForm::kStrict;
  /// The reaching time constant (ReachingForm) must be at most margin T1, T1 = 1/lambda. In (0, 1).
  /// The smaller the margin, the faster the sliding variable S decays in comparison with the
  /// heading error.
  double margin = 0.8;
  ObjectiveWeights weights;
  int global_evaluations = 80;  ///< >= 1
  /// Budget of all local searches together, >= 0. 0: no local search.
  int local_evaluations = 80;
  /// Seed of the drawn vehicles, their noise and the global search. Tune with other seeds to see
  /// how much the gains depend on chance.
  std::uint64_t seed = 1;
  /// Scenarios in which the gains are tuned. Each needs heading guidance and a unique name. Empty:
  /// the default scenarios (default_tuning_scenarios()).
  std::vector<Scenario> scenarios;
  /// true: `scenarios` are the default ones. If dry friction in yaw makes them long, the searches
  /// for one mode alone shorten them to the time of default_tuning_scenario() for this mode.
  bool has_default_scenarios = false;
  GainBounds bounds;
  /// search of an observer; absent: see adds_observer
  std::optional<ObserverSearch> observer = {};
  /// true: if runs need an observer to settle, usually because of dry friction in yaw, the search
  /// is repeated with an observer that has the defaults of ObserverSearch (with_needed_observer()
  /// in search_gains.cpp has the conditions). false: no observer is tuned. Not used if `observer`
  /// is present.
  bool adds_observer = true;
  std::vector<TuningGoal> goals = {};  ///< robust search only
  /// true: tune() returns one set of gains for all modes. false: if one mode alone may be much
  /// faster (Tuning::alone, Tuning::is_mode_better_alone), tune() also searches gains for each mode
  /// (tune_by_mode() in tuning_steps.h). Must be false if `mode` is present.
  bool one_set = false;
  /// true: tune() returns gains even if in some mode the vehicle never settles with them.
  bool allows_unsettled = false;
  /// Called with the number of evaluated sets of gains and with the budget, which is
  /// global_evaluations + local_evaluations. The last stage of the search, on all draws, is not
  /// counted. A search that is repeated (adds_observer, one_set) counts from 0 again.
  Progress progress = {};
  /// Called with a text for the user: the expected duration before a search of more than about 10
  /// s, and the reason before the search is repeated (adds_observer, one_set).
  std::function<void(std::string_view)> notice = {};
};

/// Applies the user's choice on observers. true: searches an observer, with the configured or
/// default ObserverSearch. false: searches none. Absent: leaves the options unchanged.
void choose_observer(std::optional<bool> observer, TuneOptions& options);

struct ActiveConstraint {
  std::string name;  ///< name of a constraint or a goal, or "activity, MODE"
  /// Relative improvement of the objective if the limit is relaxed by kWider, >= 0.
  double wider_gains = 0.0;
};

/// Whether a limit is an upper (at most) or a lower (at least) limit.
enum class Sense { kAtMost, kAtLeast };
inline constexpr NameTable<Sense, 2> kSenseNames{
    {{"at-most", Sense::kAtMost}, {"at-least", Sense::kAtLeast}}};

/// A constraint with its value for one set of gains.
struct ConstraintReport {
  std::string name;    ///< "T2 < T1 (strict)", ...
  double value = 0.0;  ///< with these gains
  double limit = 0.0;  ///< limit of the value
  /// Distance of the value from its limit, >= 0 if the constraint is met.
  double margin = 0.0;
  Sense sense = Sense::kAtMost;
  std::string meaning{};  ///< formula or description with the unit, for the user
  /// false: the constraint is only reported, as for the form of T2 < T1 that TuneOptions::form does
  /// not select.
  bool required = true;
};

/// Metrics and objective of one set of gains in one scenario and mode.
struct ModeScore {
  std::string scenario;
  YawMode mode{};
  Metrics metrics{};
  /// Value that the objective uses if the run does not settle (objective.h).
  double unsettled_s = 0.0;
  double objective = 0.0;  ///< objective J of the run (objective.h); 1 with the baseline
  /// true: the run broke off, so the metrics include only the time before that.
  bool has_failed = false;
};

/// An evaluation whose objective is better than that of all evaluations before it.
struct SearchStep {
  int evaluation = 0;  ///< number of the evaluation, from 1
  /// Objective of the evaluated gains, which meet every constraint.
  double objective = 0.0;
};

struct SearchHistory {
  /// Improvements of the objective, in the order of the evaluations, at most kMaxHistorySteps. They
  /// include only evaluations on the few vehicles of the search (kSearchedDraws). The final gains
  /// can differ from the last step: the last stage of the search uses all drawn vehicles, and
  /// settle() selects among equally good gains.
  std::vector<SearchStep> best;
  int global_evaluations = 0;  ///< number of evaluations by the global search
  /// Number of evaluations by the global and the local searches on the draws of the search.
  int evaluations = 0;
};
/// Largest number of steps in a history; a longer history is thinned to evenly spaced steps.
inline constexpr std::size_t kMaxHistorySteps = 200;

/// Statistics of one metric over the evaluation draws, for one set of gains in one mode.
struct EvaluatedFigure {
  std::string name;  ///< such as "heading_iae_degs"
  double median = 0.0;
  double q95 = 0.0;        ///< 95 % quantile
  double tail_mean = 0.0;  ///< mean over the worst draws, a share tail_share of all (CVaR)
};

/// Name of the tuned gains in EvaluatedGains::gains.
inline constexpr const char* kRobustGains = "robust";

/// Evaluation of one set of gains in one mode on newly drawn vehicles.
struct EvaluatedGains {
  /// Name of the gains: kRobustGains, "baseline", "paper" (if the baseline is another) or
  /// "unobserved" (the tuned gains without their observer).
  std::string gains;
  YawMode mode{};
  /// Share of the runs that settle after every heading step, [0, 1].
  double completed_share = 0.0;
  std::vector<EvaluatedFigure> figures;
  std::string scenario = {};  ///< empty: all scenarios together
};

/// Verdict on a goal, from the 95 % interval of the share of vehicles that meet it
/// (EvaluatedGoal::ci95).
enum class GoalVerdict {
  kMet,     ///< the whole interval is at or above the required share
  kMissed,  ///< the whole interval is below the required share
  kOpen,    ///< the required share is in the interval: more draws are needed
};
inline constexpr NameTable<GoalVerdict, 3> kGoalVerdictNames{
    {{"met", GoalVerdict::kMet}, {"missed", GoalVerdict::kMissed}, {"open", GoalVerdict::kOpen}}};

/// Evaluation of a goal on newly drawn vehicles, in one mode with one set of gains.
struct EvaluatedGoal {
  TuningGoal goal;
  YawMode mode{};
  std::string gains;  ///< name of the gains, as in EvaluatedGains::gains
  int held = 0;       ///< number of drawn vehicles that meet every limit
  int runs = 0;       ///< number of all drawn vehicles
  Interval ci95;      ///< 95 % interval of the share held/runs, by Clopper and Pearson
  GoalVerdict verdict = GoalVerdict::kOpen;
};

/// Conditions of a robust search, and the evaluation of its gains on newly drawn vehicles.
struct RobustTuning {
  LoopConditions conditions;
  /// true: the draws have parameters from the model's covariance. false: the model has none, so the
  /// draws differ only by noise and unmodelled variation.
  bool from_covariance = false;
  /// Statistics over the newly drawn vehicles, sorted by gains, then mode. Empty without new draws.
  std::vector<EvaluatedGains> evaluated;
  /// The same for each scenario alone, by scenario, then gains, then mode; empty for one scenario.
  std::vector<EvaluatedGains> evaluated_by_scenario;
  std::vector<EvaluatedGoal> goals;  ///< evaluated goals, by gains, then goal, then mode
};

/// Settling time and control variation of one set of gains, each as the mean over the modes,
/// scenarios and plants of the search. A run that does not settle counts with the scenario's
/// duration.
struct TradeOffPoint {
  double settling_time_s = 0.0;
  double control_variation = 0.0;  ///< 1/s, as Metrics::control_variation
};
/// A point of the Pareto front, with the gains that reach it.
struct FrontPoint {
  TradeOffPoint point{};
  Gains<double> gains{};
};
struct NamedTradeOff {
  std::string gains;  ///< name: "tuned", "baseline", "paper" or "lqi"
  TradeOffPoint point;
};
struct TradeOff {
  /// Pareto front of the feasible gains that the search evaluated, sorted by settling time.
  std::vector<FrontPoint> front;
  /// Points of named gains in the same runs. Gains with which a run breaks off are left out. "lqi"
  /// is the LQI law (linear-quadratic with integral, control/heading_lqi.h). Its weights follow
  /// from Bryson's rule: 1 over the square of an acceptable value. With p the largest heading step,
  /// the acceptable values are: heading error p/6, its integral p/6 times 4 s, yaw rate p/1.5 per
  /// second. Yaw moment: a quarter of the largest moment of the weaker mode.
  std::vector<NamedTradeOff> named;
};

/// Smallest damping ratio or delay margin over the model's confidence set, and where it occurs.
struct WorstCase {
  double value = 0.0;
  double yaw_rate_radps = 0.0;  ///< yaw rate of the worst case
  /// Parameters of the heading loop with their values in the worst case.
  std::vector<std::pair<ParameterId, double>> parameters = {};
};
struct ModeCertificate {
  YawMode mode{};
  WorstCase damping = {};  ///< smallest damping ratio; <= 0: unstable
  /// Smallest additional delay, s, that makes the loop unstable; infinity if no delay does.
  WorstCase delay_margin_s = {};
  Interval yaw_rate_radps{};  ///< examined yaw rates
};
/// Smallest damping ratio and delay margin of the heading loop that a search found in the model's
/// 95 % confidence set (tune/certificate.h). The sampled loop includes hold, servo, latency and
/// motor lag.
struct Certificate {
  /// Number of parameters in the model's covariance. 0: only the model's own values were examined.
  int parameters = 0;
  int degrees_of_freedom = 0;  ///< degrees of freedom of the confidence ellipsoid
  double latency_s = 0.0;      ///< latency of the sensor readings
  double motor_time_constant_s = 0.0;
  std::vector<ModeCertificate> modes;

  double damping_min() const;
  double delay_margin_s() const;
  Interval yaw_rate_radps() const;  ///< the smallest interval with the yaw rates of all modes
};
inline constexpr double kCertifiedShare = 0.95;  ///< probability of the confidence set

/// Share of the runs that should settle. Below it, the finding `unsettled` is reported.
inline constexpr double kSettledShare = 0.95;

/// A change with which runs settle.
struct SettlingChange {
  std::string pointer;  ///< JSON pointer in tune.json, such as "/observer"
  std::string text;     ///< the change, with its number
};
/// Sensor noise that keeps runs from settling.
struct NoiseEffect {
  double share_without = 0.0;  ///< share of the runs that settle without noise, [0, 1]
  /// duration of these runs, as a multiple of the duration of the scenarios
  double time_factor = 1.0;
  /// True: these runs are of the identified vehicle only, because drawn vehicles do not settle
  /// without noise either.
  bool is_of_identified = false;
};
/// Coulomb friction in yaw that keeps runs from settling.
struct FrictionEffect {
  double share_without = 0.0;  ///< share of the runs that settle without this friction, [0, 1]
  /// largest heading error, deg, at which the friction can hold the vehicle without an observer
  double error_deg = 0.0;
  double observer_radps = 0.0;  ///< bandwidth of the observer, rad/s; 0 without one
};
/// Unmodelled variation (TuneOptions::open) that keeps runs from settling.
struct VariationEffect {
  std::string key;             ///< in tune.json: "open", "open/mass_factors" or "open/wheel_forces"
  double share_without = 0.0;  ///< share of the runs that settle without it, [0, 1]
};
/// Error of an identified quantity that keeps runs from settling.
struct UnsettlingError {
  std::string quantity;        ///< for messages, such as "the yaw resistance g3"
  std::string trial;           ///< trial that identifies the quantity, for messages
  double settled_share = 0.0;  ///< share of the runs that settle without this error, [0, 1]
  /// share that settles without any error, i.e. of the identified vehicle, [0, 1]
  double share_of_identified = 0.0;
};
/// Scenario and mode in which fewer than 95 % of the runs settle with the tuned gains.
struct UnsettledRuns {
  std::string scenario;  ///< name of the scenario; empty if there is only one
  YawMode mode{};
  double settled_share = 0.0;  ///< share of the runs that settle, [0, kSettledShare)
  /// Why the mode cannot turn the vehicle (turning.h); empty if it can.
  std::string why = {};
  /// Unmodelled variation that keeps the runs from settling. Other causes are then not tried.
  std::optional<VariationEffect> variation = {};
  /// Effect of Coulomb friction in yaw; absent if it is not a cause.
  std::optional<FrictionEffect> friction = {};
  /// Effect of sensors without noise; absent if the noise is not the cause.
  std::optional<NoiseEffect> noise = {};
  /// The error of the model that keeps the most runs from settling. Absent if most of these runs do
  /// not settle with the identified vehicle either.
  std::optional<UnsettlingError> error = {};
  /// Changes with which the runs settle, found by SettlingSearch (settling.h). Empty if noise is
  /// the cause. If enough runs of the identified vehicle settle, these are only changes of the
  /// scenario.
  std::vector<SettlingChange> changes = {};
  /// True: no run of a drawn vehicle settles, not even without sensor noise and in kMostTime times
  /// the duration of the scenario (settling.h).
  bool is_never = false;
  /// Number of vehicles on which the changes of the gains were tried.
  std::size_t vehicles = 0;
};

/// A mode that gains for this mode alone let settle much faster, with a lower objective, than the
/// tuned gains do. Both are evaluated on the nominal vehicle and the first drawn vehicles.
struct ModeAlone {
  YawMode mode{};
  double settling_time_s = 0.0;        ///< mean settling time, s, with gains for this mode alone
  double tuned_settling_time_s = 0.0;  ///< mean settling time in this mode with the tuned gains
};

/// Result of tune().
struct Tuning {
  Gains<double> gains{};
  /// The only mode that the gains are for; absent: all modes of the vehicle.
  std::optional<YawMode> mode = {};
  /// If each mode has its own gains: the tunings of differential and steering mode. `gains` and the
  /// other members then belong to combined mode, but `certificate` to all modes. Empty: `gains` are
  /// for all modes.
  std::vector<Tuning> own = {};
  std::vector<ConstraintReport> constraints;
  double objective = 0.0;         ///< objective over all modes, scenarios and plants
  std::vector<ModeScore> scores;  ///< scores on the nominal plant, by mode, then scenario
  Baseline baseline;
  TuningLimits limits;  ///< limits of the search, including default values
  ExaminedRange examined;
  double baseline_objective = 0.0;  ///< objective of the baseline: 1 plus the terms of soft goals
  std::vector<ModeScore> baseline_scores;
  /// Required constraints, requested bounds, activity limit and goals that the baseline gains do
  /// not meet. The tuned gains meet all of them, and can therefore have a larger objective than the
  /// baseline.
  std::vector<ConstraintReport> baseline_violates;
  std::string algorithm;
  /// Number of sets of gains that the search evaluated, on some or all drawn vehicles.
  int evaluations = 0;
  std::string stop_reason;
  std::uint64_t seed = 0;
  /// Number of evaluated sets of gains whose runs were simulated. The other sets violate a
  /// constraint.
  int simulated = 0;
  /// Ranges of mu and of mu_s in which the gains are about equally good (settle() in
  /// tuning_steps.h). The tuned gains have the lower ends of these ranges.
  Interval mu_as_good, speed_mu_as_good;
  std::vector<ActiveConstraint> active;
  std::string arithmetic;  ///< rounding of the runs: BatchArithmetic::rounding
  SearchHistory history;
  /// Scores and objective of the tuned gains in a scenario that the search did not use
  /// (held_out_scenario()). For information only. The baseline gains have the objective 1 in it.
  std::vector<ModeScore> held_out_scores;
  double held_out_objective = 0.0;
  std::optional<Certificate> certificate;  ///< always present after tune()
  TradeOff trade_off;
  /// true: an observer was tuned because runs needed it to settle (TuneOptions::adds_observer).
  bool observer_added = false;
  std::vector<UnsettledRuns> unsettled;
  std::vector<ModeAlone> alone;  ///< see ModeAlone; empty if only one mode is tuned
  /// true: in one of several modes, faster gains lower the objective of this mode by 3 % or more,
  /// compared with the tuned gains; or the tuned gains have an observer and, in all modes, the
  /// friction width that steering mode needs.
  bool is_mode_better_alone = false;
  std::optional<RobustTuning> robust;  ///< absent for nominal gains

  ModeGains mode_gains() const;
};

/// Returns the default tuning scenario: starting from rest, the vehicle is commanded a heading and
/// then its opposite. Speed, heading and time are scaled to the vehicle:
///   u_d   0.3 of the speed at full thrust, or the speed at a third of the thrust if it is higher;
///         at most 0.6 of the highest measured speed, or 10 m/s without measured speeds
///   psi   30 deg. If the time for each heading would exceed 20 s, psi is reduced in steps of
///         5 deg, down to 5 deg
///   hold  time for which each heading is commanded: 1.6 times the time that the weaker mode takes
///       to turn by 2 psi without exceeding the measured yaw rates, rounded to 5, 10, 15 or 20 s.
///       At least the time of the turn plus 4/lambda + epsilon/mu, in which the error decays to 2
///       %, with the gains of pole placement under the default limits. If Coulomb friction in yaw
///       leaves these gains a larger error than the settling band, the time in which an observer
///       of bandwidth lambda/2 removes this error is added. It depends on `mode` (absent: steering
///       mode, which needs the longest time) and is 0 in differential mode. This minimum is rounded
///       up to 1 s. At most 60 s
/// The paper's vehicle has 30 then -30 deg at 1 m/s, 10 s each. [paper 4.3] Errors (input): those
/// of Model::plant().
Result<Scenario> default_tuning_scenario(const Model& model, std::optional<YawMode> mode = {});
/// Returns the default tuning scenarios for TuneOptions::mode:
///   1. default_tuning_scenario(), with heading steps. It favours fast gains, and exceeds the
///      measured yaw rates.
///   2. The same with the heading rate limited to the highest measured yaw rate. It favours gains
///      that are accurate where the model is valid. Left out if the model has no measured yaw rate.
///      Also left out if `choice` (--heading-rate-limit) is not empty; the caller then applies
///      `choice`. If `choice` is a number, scenario 1 is that of a model with this highest yaw rate,
///      unless its own is lower.
///   3. Only if TuneOptions::observer is present: scenario 2 (or 1, if 2 is left out) with a
///      constant disturbance, because without a disturbance an observer only adds noise. The yaw
///      moment is kPush times the largest moment of the weaker mode (turning_authority_m()). The
///      force is kPush times the surge resistance g1(u_d), against the motion.
/// Errors (input): those of Model::plant().
Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& choice = {});
/// Disturbance of default scenario 3, as a fraction of the largest yaw moment and of g1(u_d).
inline constexpr double kPush = 0.1;
/// Suffix of the name of a default scenario with a heading-rate limit.
inline constexpr std::string_view kLedSuffix = "_led";
/// Returns the scenario in which the tuned gains are evaluated after the search: twice the first
/// heading of default_tuning_scenario(), then the heading 0, at 0.7 of the speed of that scenario.
/// The durations are those of default_tuning_scenario() for `mode`; empty: for all modes.
/// Errors (input): those of Model::plant().
Result<Scenario> held_out_scenario(const Model& model, std::optional<YawMode> mode = {});

/// Tunes the gains by a global search, then local searches (search.h). Deterministic: model,
/// options and the instruction set of the processor (Tuning::arithmetic) determine every bit of the
/// result; the number of cores does not matter.
///
/// Errors (refused):
///   - no gains within the bounds meet the constraints, the activity limit and the goals that are
///     not soft;
///   - in every mode, the largest yaw moment is below the yaw resistance at 1 deg/s (turning.h);
///   - runs diverge with all gains;
///   - no run settles with the tuned gains, even without sensor noise; or a mode that can turn the
///     vehicle never settles (UnsettledRuns::is_never). TuneOptions::allows_unsettled permits such
///     gains.
///
/// Errors (input): the model lacks a parameter; an option is invalid; the latency exceeds 20
/// samples; no wheel force is left for an observer; runs with the baseline break off; the
/// evaluations would take more than 1e11 RK4 steps (some hours).
Result<Tuning> tune(const Model& model, const TuneOptions& options);

/// Content of gains.json.
std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance);

/// The JSON Schema of gains.json as gains_text() writes it.
std::string gains_schema();

}  // namespace awmr
