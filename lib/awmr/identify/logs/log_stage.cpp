#include "awmr/identify/logs/log_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string_view>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/identify/logs/adequacy.h"
#include "awmr/identify/logs/agreement.h"
#include "awmr/identify/logs/back_emf.h"
#include "awmr/identify/logs/between_logs.h"
#include "awmr/identify/logs/command_findings.h"
#include "awmr/identify/logs/cross_validation.h"
#include "awmr/identify/logs/family_score.h"
#include "awmr/identify/logs/inertia_check.h"
#include "awmr/identify/logs/initial_guess.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/uncertainty/akaike.h"
#include "awmr/model/plausibility.h"
#include "awmr/trials/calibration_checks.h"
#include "awmr/trials/log_consistency.h"

namespace awmr {
namespace {

bool contains(const std::vector<ParameterId>& ids, ParameterId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

bool any_has(const std::vector<DrivingLog>& logs, std::initializer_list<LogChannel> channels) {
  return std::ranges::any_of(logs, [&](const DrivingLog& log) {
    return std::ranges::any_of(channels, [&](LogChannel c) { return log[c].has_value(); });
  });
}

/// Reason why the channels and commands of the logs cannot identify a parameter; empty if they can.
/// Checked before any search. Indirect effects, for example of yaw on the speed, do not count.
std::string cannot_show(const std::vector<DrivingLog>& logs, ParameterId id) {
  switch (id) {
    case ParameterId::kSteeringTimeConstant: {
      const bool any_servo = std::ranges::any_of(
          logs, [](const DrivingLog& log) { return log.steering_command_rad.has_value(); });
      if (!any_servo) return "the logs contain the measured steering angle, not its command";
      if (!std::ranges::any_of(logs, has_steering_changes)) {
        return "the steering command never changes";
      }
      return any_has(logs, {LogChannel::kSteering, LogChannel::kYawRate, LogChannel::kHeading,
                            LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows the vehicle turn or its steering angle (yaw_rate_radps, "
                   "heading_deg, a position or steering_deg)";
    }
    case ParameterId::kSurgeAlpha:
    case ParameterId::kSurgeBeta:
    case ParameterId::kMassNorm:
      return any_has(logs, {LogChannel::kSpeed, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows how fast the vehicle drives (speed_mps or a position)";
    case ParameterId::kYawAlpha:
    case ParameterId::kYawBeta:
    case ParameterId::kInertiaNorm:
      return any_has(logs,
                     {LogChannel::kYawRate, LogChannel::kHeading, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows the vehicle turn (yaw_rate_radps, heading_deg or a position)";
    case ParameterId::kSwayAlpha:
      return any_has(logs, {LogChannel::kSway, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows the vehicle slide sideways (sway_mps or a position)";
    case ParameterId::kBackEmf:
      return why_no_back_emf(logs);
    default:
      return {};
  }
}

/// True if commands of the logs turn the vehicle: left and right forces differ, or a steering angle
/// is above kMuch_rad.
bool turns(const std::vector<DrivingLog>& logs) {
  constexpr double kMuch_rad = 0.01;
  return std::ranges::any_of(logs, [](const DrivingLog& log) {
    return has_force_difference(log) ||
           std::ranges::any_of(log.driving_steering_rad(),
                               [](double angle) { return std::abs(angle) > kMuch_rad; });
  });
}

/// Channels with a free offset: those that the user requested, the yaw rate if the heading
/// determines its bias, and the heading if the course over ground determines its offset.
std::vector<LogChannel> biased_channels(const std::vector<DrivingLog>& logs,
                                        std::vector<LogChannel> requested) {
  const auto add = [&](LogChannel channel, bool is_biased) {
    const bool known = std::ranges::find(requested, channel) != requested.end();
    if (is_biased && !known) requested.push_back(channel);
  };
  add(LogChannel::kYawRate, std::ranges::any_of(logs, has_gyro_bias));
  add(LogChannel::kHeading, std::ranges::any_of(logs, [](const DrivingLog& log) {
        return heading_offset_rad(log).has_value();
      }));
  return requested;
}

/// Limit of the work (Effort) of all searches: about half a minute on a processor of 2023, more for
/// long logs. A log that the model describes well needs a tenth of this.
std::int64_t effort_limit(const std::vector<DrivingLog>& logs) {
  constexpr double kMin = 6e8;
  constexpr double kPerSecond = 1e6;  // per second of log
  double duration_s = 0.0;
  for (const DrivingLog& log : logs) duration_s += log.t_s.back() - log.t_s.front();
  return std::llround(kMin + kPerSecond * duration_s);
}

LogFitOptions fit_options(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                          const IdentifyOptions& options) {
  LogFitOptions fit;
  fit.vehicle = vehicle;
  if (options.fit_input_delay) fit.terms = {{input_delay(), 0.0}};
  fit.candidate_terms = {ParameterId::kSurgeCoulomb, ParameterId::kSurgeQuadratic,
                         ParameterId::kWheelDeadZone, ParameterId::kYawCoulomb,
                         ParameterId::kYawQuadratic};
  fit.biases = biased_channels(logs, options.biases);
  fit.loss = options.loss;
  fit.seed = options.seed;
  fit.multistart = options.starts;
  fit.bootstrap = options.bootstrap;
  fit.threads = options.threads;
  fit.effort = std::make_shared<Effort>(effort_limit(logs));
  if (options.time_limit_s > 0.0) {
    fit.deadline = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(options.time_limit_s));
  }
  return fit;
}

/// Frees the parameters that are requested or have no value. Guesses parameters without a value.
/// Stores the reason for each parameter that the logs cannot identify.
void free_parameters(LogFitOptions& fit, const std::vector<DrivingLog>& logs,
                     const std::vector<ParameterId>& requested, const Model& model,
                     std::map<ParameterId, std::string>& reasons) {
  const bool turning = turns(logs);
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& known = model[parameter.id];
    if (known.value) fit.initial_guess[at(parameter.id)] = *known.value;
    const bool wanted = contains(requested, parameter.id) || !known.value;
    // A servo whose command never changes has no effect. But with its time constant free, the
    // fitted steering angle at the beginning of each window would act like a trim.
    const bool never_acts =
        parameter.id == ParameterId::kBackEmf || parameter.id == ParameterId::kSteeringTimeConstant;
    if (!can_be_requested(parameter) || !wanted) continue;
    const std::string why = cannot_show(logs, parameter.id);
    if (!why.empty()) reasons[parameter.id] = why;
    // In logs with turns, an unidentifiable parameter affects the others. It therefore stays free,
    // so that its uncertainty is included, and is refused later.
    if (!why.empty() && (!turning || never_acts)) continue;
    fit.free.push_back(parameter.id);
    if (!known.value) fit.guessed.push_back(parameter.id);
  }
  if (frees_back_emf(fit)) fit = with_back_emf(std::move(fit));
}

/// True if back-EMF is to be tested: it is not given, no parameters were requested, no resistance
/// comes from a table fit, which would have absorbed it, and the logs contain enough coasting.
bool looks_for_back_emf(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                        const IdentifyOptions& options, const Model& model) {
  return options.requested.empty() && !vehicle.back_emf_s_per_m &&
         !model[ParameterId::kSurgeAlpha].value && !model[ParameterId::kYawAlpha].value &&
         why_no_back_emf(logs).empty();
}

bool is_open(const FamilyChoice& choice) {
  return !choice.family || (!choice.requested && choice.family == Family::kPower);
}

void report(const IdentifyOptions& options, std::string_view what) {
  if (options.doing) options.doing(what);
}

/// Result of choose_families().
struct Chosen {
  BestFamily found;
  bool may_have_back_emf = false;  ///< the fit of the first families indicates back-EMF
};

/// Calls options.notice if the step `what` may take more than 10 s on one processor. `numbers`:
/// approximate work of the step (Effort).
void announce(const IdentifyOptions& options, double numbers, const std::string& what) {
  constexpr double kNumbersPerSecond = 2e7;  // Effort per second on a processor of 2023
  constexpr double kLong_s = 10.0;
  const double about_s = numbers / kNumbersPerSecond;
  if (!options.notice || about_s <= kLong_s) return;
  options.notice(fmt::format(
      "{} may take up to about {:.0f} s of one processor; use a part of the logs ({}) to save time",
      what, about_s, option_text("from S")));
}

/// Estimated work of the first fit (Effort). Each evaluation integrates the state and its
/// derivatives by every free quantity and every component of the initial state.
double numbers_of_first_fit(const std::vector<DrivingLog>& logs, const LogFitOptions& options) {
  constexpr double kEvaluations = 40.0;
  constexpr double kStepsOfRow = 2.0;
  constexpr double kInitialComponents = 7.0;
  double rows = 0.0;
  for (const DrivingLog& log : logs) rows += static_cast<double>(log.rows());
  const double derivatives = static_cast<double>(options.free.size()) + kInitialComponents;
  return kEvaluations * kStepsOfRow * rows * (1.0 + derivatives);
}

/// Fits the families that the options name, by default power laws.
FamilyFit fit_first_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const IdentifyOptions& options) {
  report(options, "fitting the logs");
  announce(options, numbers_of_first_fit(logs, power_law), "fitting logs of this length");
  return fit_family(logs, power_law, options.surge_family.family.value_or(Family::kPower),
                    options.yaw_family.family.value_or(Family::kPower));
}

/// Selects the families: those that the user requested, or the best ones. `first`: result of
/// fit_first_family().
Chosen choose_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       const IdentifyOptions& options, FamilyFit first) {
  const FamilyChoice& surge = options.surge_family;
  const FamilyChoice& yaw = options.yaw_family;
  const bool surge_open = is_open(surge);
  const bool yaw_open = is_open(yaw) && contains(power_law.free, ParameterId::kYawAlpha);
  Chosen chosen{{.best = std::move(first), .others = {}, .findings = {}}};
  chosen.may_have_back_emf = suspects_back_emf(chosen.found.best.fit, power_law.candidate_terms);
  if (!surge_open && !yaw_open) return chosen;
  // Unless the user requests the best family (`--family auto`), another family has to be
  // significantly better than the power law.
  report(options, "trying families of resistance");
  const bool is_family_requested = !surge.family || !yaw.family;
  const FamilyContest contest{.surge = surge_open,
                              .yaw = yaw_open,
                              .lead = is_family_requested ? 0.0 : kFamilyAicThreshold,
                              .only_candidates = !is_family_requested};
  const auto contenders =
      static_cast<double>(contender_count(power_law, chosen.found.best, contest));
  announce(options,
           std::min(contenders * static_cast<double>(power_law.effort->spent()),
                    static_cast<double>(power_law.effort->left())),
           "comparing other families of resistance, as the first one fits poorly,");
  chosen.found = best_family(logs, power_law, std::move(chosen.found.best), contest);
  return chosen;
}

/// Returns the logs with the steering command as the measured steering angle.
std::vector<DrivingLog> with_measured_steering(std::vector<DrivingLog> logs) {
  for (DrivingLog& log : logs) {
    log[LogChannel::kSteering] = Measured{.value = *std::move(log.steering_command_rad),
                                          .fresh = std::vector<bool>(log.rows(), true)};
    log.steering_command_rad.reset();
  }
  return logs;
}

/// True if the column of steering commands contains measured angles: the servo's time constant in
/// the fit `first`, less late time stamps of the steering, is below half a row, and a fit that uses
/// the column as the angle is significantly better.
bool is_steering_measured(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                          const FamilyFit& first, const IdentifyOptions& options) {
  constexpr double kOfRow = 0.5;
  const auto is_command = [](const DrivingLog& log) {
    return log.steering_command_rad && !log[LogChannel::kSteering];
  };
  if (!std::ranges::all_of(logs, is_command)) return false;
  std::optional<double> lag_s;
  double late_stamps_s = 0.0;
  for (std::size_t i = 0; i < first.fit.quantities.size(); ++i) {
    const FreeQuantity& q = first.fit.quantities[i];
    const double value = q.value(first.fit.coordinates[i]);
    if (q.is(ParameterId::kSteeringTimeConstant)) lag_s = value;
    if (q.kind == FreeQuantity::Kind::kSteeringDelay) late_stamps_s = std::max(0.0, -value);
  }
  if (!lag_s || *lag_s - late_stamps_s > kOfRow * logs.front().median_step_s()) return false;
  LogFitOptions from = from_optimum(std::move(power_law), first);
  std::erase(from.free, ParameterId::kSteeringTimeConstant);
  std::erase_if(from.terms, [](const FreeTerm& term) {
    return term.quantity.kind == FreeQuantity::Kind::kSteeringDelay;
  });
  const FamilyFit follows = fit_first_family(with_measured_steering(logs), from, options);
  // A lag with equally late time stamps describes measured angles as well, with two terms more.
  const double threshold = late_stamps_s > 0.0 ? 0.0 : kFamilyAicThreshold;
  return follows.fit.usable && aic_lead(follows.fit, first.fit) > threshold;
}

Finding measured_steering_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "steering-measured",
          fmt::format("the vehicle follows steering_cmd_deg without a servo lag, so the column is "
                      "used as the measured angle. Map it by {}, or log the steering command, so "
                      "that the servo's lag can be identified",
                      option_text(R"(column 'steering_deg="steering_cmd_deg"')"))};
}

/// Refits the best families of `ideal`, a result without back-EMF, with back-EMF. Returns the model
/// with back-EMF if it is significantly better, else `ideal`; the other fit is among its
/// alternatives. If back-EMF is selected, it becomes free in `power_law`.
BestFamily or_with_back_emf(const std::vector<DrivingLog>& logs, LogFitOptions& power_law,
                            const IdentifyOptions& options, BestFamily ideal) {
  report(options, "trying back-EMF of the motors");
  LogFitOptions freed = with_back_emf(power_law);
  std::erase(freed.candidate_terms, ParameterId::kBackEmf);
  const FamilyFit same = fit_from(logs, freed, ideal.best, ideal.best.surge, ideal.best.yaw);
  if (shows_back_emf(same, ideal.best)) {
    ideal.best = searched_again(logs, power_law, std::move(ideal.best), same);
  }
  if (!shows_back_emf(same, ideal.best)) {
    if (!same.fit.usable) {
      ideal.is_out_of_time = is_over(power_law);
      ideal.findings.push_back(
          {logs.front().file, 0, Severity::kWarning, "families-not-compared",
           fmt::format("the model with back-EMF could not be fitted to these logs: {}{}",
                       same.fit.report.stop_reason,
                       ideal.is_out_of_time ? "; the intervals are withdrawn" : "")});
    }
    ideal.others.push_back(same);
    return ideal;
  }
  BestFamily braked =
      choose_families(logs, freed, options, fit_first_family(logs, freed, options)).found;
  if (!shows_back_emf(braked.best, ideal.best)) braked.best = same;
  braked.findings.push_back(back_emf_finding(logs.front().file, braked.best, ideal.best));
  braked.others.push_back(std::move(ideal.best));
  power_law = std::move(freed);
  return braked;
}

/// Selects the families, and back-EMF if it is significant. Adds the reports of all fits and the
/// findings to `stage`.
FamilyFit fit_families(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                       const IdentifyOptions& options, FamilyFit first, LogStage& stage) {
  const FamilyChoice& surge = options.surge_family;
  auto [found, may_have_back_emf] = choose_families(logs, power_law, options, std::move(first));
  if (may_have_back_emf && !found.is_out_of_time)
    found = or_with_back_emf(logs, power_law, options, std::move(found));
  append(stage.reports, reports_of(found.others, found.best));
  append(stage.findings, found.findings);
  FamilyFit chosen = std::move(found.best);
  stage.surge_family = chosen.surge;
  stage.yaw_family = chosen.yaw;
  stage.chosen_report = stage.reports.size();
  stage.reports.push_back(chosen.fit.report);
  append(stage.findings, autocorrelation_findings(chosen.fit, logs.front().file));
  report(options, "checking the fit");
  const bool try_families = surge.requested && surge.family == Family::kPower;
  const Adequacy adequacy = check_adequacy(logs, power_law, chosen, try_families);
  append(stage.reports, adequacy.alternatives);
  append(stage.findings, adequacy.findings);
  stage.withdraws_intervals = adequacy.withdraws_intervals || found.is_out_of_time;
  return chosen;
}

void refuse_all(const FamilyFit& chosen, const std::string& file, LogStage& stage) {
  stage.findings.push_back(
      {file, 0, Severity::kError, "not-converged",
       "the fit of the logs did not converge: " + chosen.fit.report.stop_reason});
  for (const ParameterId id : chosen.options.free) {
    stage.reasons[id] = "the fit of the logs did not converge";
  }
}

/// The finding `logs-disagree` for every quantity that differs between logs. `withdrawn`: true if
/// the intervals of the fit are withdrawn.
std::vector<Finding> in_words(const std::vector<LogDisagreement>& disagreements, bool withdrawn) {
  std::vector<Finding> findings;
  for (const LogDisagreement& one : disagreements) {
    std::string each;
    for (std::size_t l = 0; l < one.files.size(); ++l) {
      each += fmt::format("{}{:.4g} by {}", l == 0 ? "" : ", ", one.values[l], one.files[l]);
    }
    findings.push_back(
        {one.files.front(), 0, Severity::kWarning, "logs-disagree",
         fmt::format("the logs disagree on {}: {} (p = {:.2g} if vehicle, surface and battery were "
                     "the same). {}",
                     one.name, each, one.p_value,
                     one.withdraws ? "The fit uses one value for all logs, so all intervals are "
                                     "withdrawn; identify each log separately"
                     : one.refuses
                         ? "An interval for all logs would be too wide, so this quantity is refused"
                     : withdrawn ? "Its interval is withdrawn"
                                 : "Its interval is widened: it covers the mean over such logs, "
                                   "not an individual log")});
  }
  return findings;
}

/// The finding `held-out-misses`: a fit of the log's first half does not predict the last fifth.
Finding in_words(const HeldOut& missed, const std::string& file) {
  return {file, 0, Severity::kWarning, "held-out-misses",
          fmt::format("a fit of the first half predicts {} worse than noise and intervals allow "
                      "(p = {:.2g}); {} changes most, from {:.4g} to {:.4g}. Battery, temperature, "
                      "ground or load changed, or the model is incomplete, so the intervals are "
                      "withdrawn. Identify a part under constant conditions ({}, {})",
                      missed.rows, missed.p_value, missed.quantity, missed.by_fit, missed.by_rows,
                      option_text("from S"), option_text("until S"))};
}

/// Takes the parameters that the fit identifies into `stage`. Parameters with a value from other
/// trials are replaced only if `overrule`.
void take(const LogFit& fit, const Model& model, bool overrule, const std::string& file,
          LogStage& stage) {
  stage.block = fit.covariance;
  append(stage.findings, command_and_sensor_findings(fit, stage.withdraws_intervals, file));
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    const bool parameter = q.kind == FreeQuantity::Kind::kParameter;
    if (!fit.refusal_reason[i].empty()) {
      if (parameter) stage.reasons[q.id] = fit.refusal_reason[i];
      if (q.is(ParameterId::kBackEmf)) stage.is_back_emf_open = true;
      if (!parameter && q.kind != FreeQuantity::Kind::kSaturationSharpness) {
        stage.findings.push_back({file, 0, Severity::kWarning, "not-identifiable",
                                  fmt::format("{}: {}", q.name(), fit.refusal_reason[i])});
      }
      continue;
    }
    if (!parameter || stage.reasons.contains(q.id)) continue;
    const Estimate& known = model[q.id];
    if (const auto finding = disagreement(fit, i, known, file)) stage.findings.push_back(*finding);
    const bool other_trial = known.value && known.source != Source::kGiven;
    if (other_trial && !overrule) continue;
    const EstimatorParameter& found = fit.report.parameters[i];
    stage.main.push_back(
        {q.id, Estimate{found.value, found.std_error, found.ci95, Source::kFitted, "trajectory"},
         eigen_index(i), q.jacobian(fit.coordinates[i])});
  }
}

/// The warning `speed-controlled`, if both resistances are linear and the yaw coefficient is d^2
/// times the surge coefficient. Each wheel then rolls at a speed proportional to its command. The
/// cause is motor drag, or a speed controller whose set-point was logged in place of the force.
///
///     tau_speed = a1 u,   tau_turn = a3 r = d^2 a1 r
std::vector<Finding> speed_findings(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                                    const LogStage& stage) {
  constexpr double kOfExponent = 0.05;
  constexpr double kOfRatio = 0.1;
  const auto value = [&](ParameterId id) {
    const auto found = std::ranges::find(stage.main, id, &LogStage::Main::id);
    return found == stage.main.end() ? 0.0 : found->estimate.value.value_or(0.0);
  };
  const auto is_linear = [&](Family family, ParameterId beta) {
    return family == Family::kPower && std::abs(value(beta) - 1.0) < kOfExponent;
  };
  const double surge = value(ParameterId::kSurgeAlpha);
  const double ratio =
      value(ParameterId::kYawAlpha) / (surge * vehicle.half_track_m * vehicle.half_track_m);
  if (!(surge > 0.0) || std::ranges::none_of(logs, has_force_difference) ||
      !is_linear(stage.surge_family, ParameterId::kSurgeBeta) ||
      !is_linear(stage.yaw_family, ParameterId::kYawBeta) || !(std::abs(ratio - 1.0) < kOfRatio)) {
    return {};
  }
  return {
      {logs.front().file, 0, Severity::kWarning, "speed-controlled",
       fmt::format(
           "each wheel rolls at {:.3g} m/s per unit of its command, also in turns. Either motor "
           "drag is the only resistance, or force_left and force_right are set-points of a speed "
           "controller, and a1, a3, m' and I'z describe that controller. In that case log the "
           "commands that reach the motors",
           vehicle.driven_wheels() / surge)}};
}

}  // namespace

Result<LogStage> run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                               const IdentifyOptions& options,
                               const std::vector<ParameterId>& requested, const Model& model,
                               bool overrule) {
  LogStage stage;
  LogFitOptions power_law = fit_options(vehicle, logs, options);
  power_law.initial_guess = guess_from_logs(logs, vehicle);
  free_parameters(power_law, logs, requested, model, stage.reasons);
  AWMR_RETURN_IF_ERROR(check_replay(plant_of(vehicle, power_law.initial_guess), logs.front().file));
  if (looks_for_back_emf(vehicle, logs, options, model)) {
    power_law.candidate_terms.push_back(ParameterId::kBackEmf);
  }
  FamilyFit first = fit_first_family(logs, power_law, options);
  if (is_steering_measured(logs, power_law, first, options)) {
    Result<LogStage> measured =
        run_log_stage(vehicle, with_measured_steering(logs), options, requested, model, overrule);
    if (measured) measured->findings.push_back(measured_steering_finding(logs.front().file));
    return measured;
  }
  FamilyFit chosen = fit_families(logs, power_law, options, std::move(first), stage);
  report(options, "comparing the logs with each other");
  const LogComparison compared = compare_logs(logs, chosen);
  stage.withdraws_intervals =
      stage.withdraws_intervals || compared.missed || saturates_much(chosen.fit) ||
      std::ranges::any_of(compared.disagreements, &LogDisagreement::withdraws);
  append(stage.findings, in_words(compared.disagreements, stage.withdraws_intervals));
  if (compared.missed) stage.findings.push_back(in_words(*compared.missed, logs.front().file));
  if (stage.withdraws_intervals) withdraw_intervals(chosen.fit.report);
  stage.reports[stage.chosen_report] = chosen.fit.report;
  const std::string& file = logs.front().file;
  if (!chosen.fit.usable) {
    refuse_all(chosen, file, stage);
    return stage;
  }
  take(chosen.fit, model, overrule, file, stage);
  append(stage.findings, speed_findings(vehicle, logs, stage));
  check_inertia(vehicle, logs, model, stage);
  if (options.cross_validate && logs.size() > 1) {
    report(options, "predicting each log from the others");
    const CrossValidation held_out = leave_one_log_out(logs, from_optimum(chosen.options, chosen));
    append(stage.reports[stage.chosen_report].leave_one_out, held_out.leave_one_out);
    append(stage.findings, held_out.findings);
  }
  return stage;
}

}  // namespace awmr
