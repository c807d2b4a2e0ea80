#include "awmr/identify/logs/log_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/logs/checks/between_logs.h"
#include "awmr/identify/logs/checks/change_in_log.h"
#include "awmr/identify/logs/checks/log_checks.h"
#include "awmr/identify/logs/choice/back_emf.h"
#include "awmr/identify/logs/choice/changes_between_rows.h"
#include "awmr/identify/logs/choice/interpolated_commands.h"
#include "awmr/identify/logs/choice/model_choice.h"
#include "awmr/identify/logs/choice/set_points.h"
#include "awmr/identify/logs/findings/term_findings.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/identify/logs/log_setup.h"
#include "awmr/identify/logs/simulation/steering_linkage.h"
#include "awmr/model/plausibility.h"
#include "awmr/trials/checks/log_consistency.h"

namespace awmr {
namespace {

/// Withdraws the interval of the servo's time constant if it is shorter than three quarters of the
/// row spacing, within which commands change at unknown times. The fit is linear in these times,
/// but the response of such a fast servo is not.
std::optional<Finding> withdraw_fast_servo(LogFit& fit, const std::string& file) {
  constexpr double kShortShare = 0.75;
  const double spacing_s = 2.0 * fit.change_reach_s;
  const auto servo = place_of(fit.quantities, ParameterId::kSteeringTimeConstant);
  if (!servo || !fit.report.parameters[*servo].std_error) return std::nullopt;
  const double servo_s = fit.report.parameters[*servo].value;
  if (!(servo_s < kShortShare * spacing_s)) return std::nullopt;
  withdraw_intervals(fit.report, info(ParameterId::kSteeringTimeConstant).name);
  return Finding{
      file, 0, Severity::kWarning, "changes-between-rows",
      fmt::format("the servo's time constant of {:.2g} s gets no interval, because it "
                  "is short compared with the {:.2g} s between rows, within which the "
                  "commands change at unknown times. Log every command when it is sent, or log "
                  "at a higher rate",
                  servo_s, spacing_s)};
}

/// Refuses the yaw resistance and the inertia of a vehicle that turns like a car, and withdraws all
/// intervals.
void refuse_yaw_of_car(LogStage& stage) {
  stage.withdraws_intervals = true;
  for (const ParameterInfo& parameter : parameter_table()) {
    const bool is_of_yaw =
        parameter.id == ParameterId::kInertiaNorm || parameter.name.starts_with("yaw.");
    if (!is_of_yaw) continue;
    stage.reasons[parameter.id] =
        "the vehicle turns like a car, by the side force of its tyres, which the model of awmr "
        "does not contain";
  }
}

/// Selects the model of the logs: resistance families of surge and yaw, and back-EMF if it is
/// significant. Decides between wheel slip and late commands (decide_slip()), and whether the
/// steering stop limits the command or the angle (decide_stop()). Then checks whether the logs
/// decide between a lag and the inertia, and whether the fit describes the logs, which can withdraw
/// intervals. Adds the reports of all fits and the findings to `stage`. `power_law`, `first`: as in
/// choose_model().
FamilyFit fit_families(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                       const IdentifyOptions& options, FamilyFit first, LogStage& stage) {
  const FamilyChoice& surge = options.surge_family;
  BestFamily found = choose_model(logs, power_law, options, std::move(first));
  append(stage.reports, reports_of(found.others, found.best));
  append(stage.findings, found.findings);
  FamilyFit chosen = std::move(found.best);
  const std::optional<Finding> undecided_slip = decide_slip(logs, chosen);
  if (undecided_slip) stage.findings.push_back(*undecided_slip);
  const std::optional<Finding> undecided_stop = decide_stop(logs, chosen);
  if (undecided_stop) stage.findings.push_back(*undecided_stop);
  refuse_exchangeable(logs, chosen);
  stage.surge_family = chosen.surge;
  stage.yaw_family = chosen.yaw;
  stage.chosen_report = stage.reports.size();
  stage.reports.push_back(chosen.fit.report);
  append(stage.findings, autocorrelation_findings(chosen.fit, logs.front().file));
  show_step(options, "checking the fit");
  const bool try_families = surge.requested && surge.family == Family::kPower;
  const Adequacy adequacy = check_adequacy(logs, power_law, chosen, try_families);
  append(stage.reports, adequacy.alternatives);
  stage.withdraws_intervals = adequacy.withdraws_intervals || found.is_out_of_time;
  if (!adequacy.findings.empty()) {
    if (const auto car = car_steering_finding(power_law.vehicle, logs, chosen.fit)) {
      stage.findings.push_back(*car);
      refuse_yaw_of_car(stage);
    }
  }
  append(stage.findings, adequacy.findings);
  if (adequacy.withdraws_sway) {
    withdraw_intervals(chosen.fit.report, info(ParameterId::kSwayAlpha).name);
  }
  if (adequacy.withdraws_servo) {
    withdraw_intervals(chosen.fit.report, info(ParameterId::kSteeringTimeConstant).name);
  }
  if (const auto unresolved = withdraw_fast_servo(chosen.fit, logs.front().file)) {
    stage.findings.push_back(*unresolved);
  }
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

/// Reports `logs-disagree` for every quantity that differs between logs. `withdrawn`: true if the
/// intervals of the fit are withdrawn.
std::vector<Finding> in_words(const std::vector<LogDisagreement>& disagreements, bool withdrawn) {
  std::vector<Finding> findings;
  for (const LogDisagreement& one : disagreements) {
    std::string each;
    for (std::size_t l = 0; l < one.files.size(); ++l) {
      each += fmt::format("{}{:.4g} by {}", l == 0 ? "" : ", ", one.values[l], one.files[l]);
    }
    const std::string partner =
        one.partner && !withdrawn && !one.withdraws
            ? fmt::format(
                  ". The interval of {} is widened as well, because load and battery change "
                  "both",
                  *one.partner)
            : "";
    findings.push_back(
        {one.files.front(), 0, Severity::kWarning, "logs-disagree",
         fmt::format("the logs disagree on {}: {} (p = {:.2g} if vehicle, surface and battery were "
                     "the same). {}{}",
                     one.name, each, one.p_value,
                     one.withdraws ? "The fit uses one value for all logs, so all intervals are "
                                     "withdrawn; identify each log separately"
                     : one.refuses
                         ? "An interval for all logs would be too wide, so this quantity gets no "
                           "value; identify each log separately"
                     : withdrawn || !one.is_widened
                         ? "Its interval is withdrawn"
                         : "Its interval is widened: it covers the mean over such logs, "
                           "not an individual log",
                     partner)});
  }
  return findings;
}

/// Reports `held-out-misses`: a fit of the first half of a log does not predict its last fifth.
Finding in_words(const HeldOut& missed, const std::string& file) {
  return {file, 0, Severity::kWarning, "held-out-misses",
          fmt::format("a fit of the first half predicts {} worse than noise and confidence "
                      "intervals explain (p = {:.2g}); {} changes most, from {:.4g} to {:.4g}. "
                      "Battery, temperature, ground or load changed, or the model is incomplete, "
                      "so the intervals are withdrawn. Identify a part under constant conditions "
                      "({}, {})",
                      missed.rows, missed.p_value, missed.quantity, missed.by_fit, missed.by_rows,
                      option_text("from S"), option_text("until S"))};
}

/// True if the search ended with the servo's time constant at its upper limit. No servo is that
/// slow, so the optimum is probably wrong.
bool has_impossible_servo(const LogFit& fit) {
  constexpr double kAtLimit = 1.0 - 1e-6;
  const auto servo_s = fit.value_of(ParameterId::kSteeringTimeConstant);
  return servo_s && *servo_s >= kAtLimit * kSlowestServo_s;
}

Finding impossible_servo_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "model-inadequate",
          fmt::format("the search ended with a servo time constant at its limit of {:g} s, so that "
                      "it has probably found a wrong optimum; the intervals are withdrawn. Log the "
                      "yaw rate or the heading as well, or search from more initial guesses ({})",
                      kSlowestServo_s, option_text("starts"))};
}

/// Reports `not-identifiable` for each delay, lag or error that the fit contains or the user
/// requested, but that gets no value: as an error if `requested` contains its name, else as a note.
/// Leaves out parameters that only describe the form of another term (FreeQuantity::is_form()).
std::vector<Finding> refused_terms(const LogFit& fit, const std::vector<std::string>& requested,
                                   const std::string& file) {
  std::vector<Finding> findings;
  std::vector<std::string> found;
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    found.push_back(q.name());
    if (fit.refusal_reason[i].empty() || q.kind == FreeQuantity::Kind::kParameter || q.is_form())
      continue;
    const bool is_requested = contains(requested, q.name());
    findings.push_back(
        {file, 0, is_requested ? Severity::kError : Severity::kNote, "not-identifiable",
         fmt::format("{} {}: {}", q.name(),
                     is_requested ? "cannot be identified" : "is in the fit, but has no value",
                     fit.refusal_reason[i])});
  }
  for (const std::string& name : requested) {
    if (contains(found, name)) continue;
    findings.push_back({file, 0, Severity::kError, "not-identifiable",
                        fmt::format("{} cannot be identified: the fit describes these logs better "
                                    "by other terms, which replace it (/estimates of model.json "
                                    "lists them)",
                                    name)});
  }
  return findings;
}

/// Returns the warning `estimates-disagree` if parameter `i` of the log fit differs significantly
/// from `known`, its estimate from other trials: by a two-sided normal test (p < 0.01) of the
/// fitted coordinates, which are logarithms for most parameters. Empty if the estimates agree, or
/// if `known` has no standard error.
std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file) {
  constexpr double kApart = 0.01;
  if (!known.value || !known.std_error || !(*known.std_error > 0.0)) return std::nullopt;
  const FreeQuantity& q = fit.quantities[i];
  const double variance = fit.covariance(eigen_index(i), eigen_index(i));
  const double other = to_coordinate(q.scale, *known.value);
  const double other_std = *known.std_error / jacobian(q.scale, *known.value);
  const double z =
      std::abs(fit.coordinates[i] - other) / std::sqrt(variance + other_std * other_std);
  const double p = 2.0 * normal_tail(z);
  if (p >= kApart) return std::nullopt;
  return Finding{
      file, 0, Severity::kWarning, "estimates-disagree",
      fmt::format("{} is {:.4g} by the logs and {:.4g} by other trials ({}). The two values are "
                  "{:.1f} standard deviations apart (p = {:.2g}); check the units and that all "
                  "trials are of one "
                  "vehicle",
                  info(q.id).name, q.value(fit.coordinates[i]), *known.value, known.method, z, p)};
}

/// Searches a change of the vehicle within the log (find_change()), if the fit `chosen` has a model
/// error or a saturation of the forces, which such a change resembles. Reports it and withdraws the
/// intervals. Returns true if there is a change.
bool report_change(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& chosen, LogStage& stage) {
  const bool is_inadequate =
      std::ranges::find(stage.findings, "model-inadequate", &Finding::code) != stage.findings.end();
  if (!is_inadequate && !saturates_much(chosen.fit)) return false;
  const auto change = find_change(logs, power_law, chosen);
  if (!change) return false;
  stage.withdraws_intervals = true;
  stage.findings.push_back(change_finding(*change, logs.front().file));
  return true;
}

/// Adds to the findings about forces that the model lacks that a change within the log explains
/// them as well.
void doubt_force_terms(std::vector<Finding>& findings) {
  constexpr std::string_view kOfForces[] = {"force-saturation", "force-curve",  "side-pull",
                                            "axle-offset",      "turn-drag",    "backward-drag",
                                            "brake-force",      "reverse-force"};
  for (Finding& finding : findings) {
    if (!contains(kOfForces, finding.code)) continue;
    finding.message +=
        ". But the change within the log (changed-in-log) explains the log without this effect";
  }
}

/// Copies the parameters that the fit identifies to `stage`. If a parameter already has a value
/// from other trials, copies it only if `overrule` is true.
void take(const LogFit& fit, const Model& model, bool overrule, const std::vector<DrivingLog>& logs,
          LogStage& stage) {
  stage.block = fit.covariance;
  append(stage.findings, command_and_sensor_findings(fit, stage.withdraws_intervals, logs));
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    const bool parameter = q.kind == FreeQuantity::Kind::kParameter;
    if (!fit.refusal_reason[i].empty()) {
      if (parameter) stage.reasons[q.id] = fit.refusal_reason[i];
      if (q.is(ParameterId::kBackEmf)) stage.is_back_emf_open = true;
      continue;
    }
    if (!parameter || stage.reasons.contains(q.id)) continue;
    const Estimate& known = model[q.id];
    if (const auto finding = disagreement(fit, i, known, logs.front().file))
      stage.findings.push_back(*finding);
    const bool other_trial = known.value && known.source != Source::kGiven;
    if (other_trial && !overrule) continue;
    const EstimatorParameter& found = fit.report.parameters[i];
    stage.main.push_back(
        {q.id, Estimate{found.value, found.std_error, found.ci95, Source::kFitted, "trajectory"},
         eigen_index(i), q.jacobian(fit.coordinates[i])});
  }
}

/// Adds findings that name the cause of a model error, before the finding `model-inadequate`.
void add_cause(const std::vector<Finding>& causes, LogStage& stage) {
  stage.findings.insert(std::ranges::find(stage.findings, "model-inadequate", &Finding::code),
                        causes.begin(), causes.end());
}

/// Compares the logs with each other, or the halves of a single log. Adds a finding for each
/// disagreement, and withdraws the intervals if necessary.
void compare_parts(const std::vector<DrivingLog>& logs, FamilyFit& chosen, LogStage& stage) {
  // The true form of a large saturation is unknown. If this form is wrong, the estimates differ
  // between parts of the logs for that reason alone, so a comparison of the parts would mean
  // nothing.
  const bool saturates = saturates_much(chosen.fit);
  const LogComparison compared = saturates ? LogComparison{} : compare_logs(logs, chosen);
  stage.withdraws_intervals =
      stage.withdraws_intervals || compared.missed || saturates ||
      std::ranges::any_of(compared.disagreements, &LogDisagreement::withdraws);
  // A difference between the logs is a cause of a model error, so it is reported first.
  add_cause(in_words(compared.disagreements, stage.withdraws_intervals), stage);
  if (compared.missed) stage.findings.push_back(in_words(*compared.missed, logs.front().file));
}

/// Withdraws all intervals if a term of the fit has a value that no real vehicle has, if the place
/// of the dead zone is unknown, or if the logs contain set-points of a speed controller.
void withdraw_if_implausible(const FamilyFit& chosen,
                             const std::optional<SpeedControl>& speed_control,
                             const std::string& file, LogStage& stage) {
  if (speed_control && speed_control->withdraws) stage.withdraws_intervals = true;
  if (chosen.fit.usable &&
      (has_implausible_term(chosen.fit) || has_dead_zone_of_unknown_place(chosen.fit))) {
    stage.withdraws_intervals = true;
  }
  if (chosen.fit.usable && has_impossible_servo(chosen.fit)) {
    stage.withdraws_intervals = true;
    stage.findings.push_back(impossible_servo_finding(file));
  }
}

/// Withdraws or widens intervals of the report of `chosen`.
void withdraw_or_widen(const std::vector<DrivingLog>& logs, FamilyFit& chosen, LogStage& stage) {
  withdraw_by_stribeck(chosen.fit);
  widen_by_steering_scale(logs, chosen);
  if (const auto open = widen_by_gyro_scale(logs, chosen)) stage.findings.push_back(*open);
  if (is_much_curved(chosen.fit)) withdraw_intervals(chosen.fit.report, "yaw.");
  if (stage.withdraws_intervals) withdraw_intervals(chosen.fit.report);
}

struct ReadAgain {
  std::vector<DrivingLog> logs;
  Finding finding;
};

/// Tries other ways to read the logged commands: as set-points that the vehicle holds, as straight
/// lines between the rows, and as measured steering angles. Returns the first one whose fit is
/// better than `first`, else empty.
std::optional<ReadAgain> read_again(const std::vector<DrivingLog>& logs,
                                    const LogFitOptions& power_law, const FamilyFit& first) {
  const std::string& file = logs.front().file;
  auto held = with_held_set_points(logs);
  if (held && are_set_points_held(*held, power_law, first)) {
    return ReadAgain{*std::move(held), interpolated_set_points_finding(file)};
  }
  if (are_commands_smooth(logs, power_law, first)) {
    return ReadAgain{interpolated(logs), interpolated_commands_finding(file)};
  }
  if (is_steering_measured(logs, power_law, first)) {
    return ReadAgain{with_measured_steering(logs), measured_steering_finding(file)};
  }
  return std::nullopt;
}

}  // namespace

Result<LogStage> run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& rows,
                               const IdentifyOptions& options,
                               const std::vector<ParameterId>& requested, const Model& model,
                               bool overrule) {
  LogStage stage;
  LogFitOptions power_law = log_setup(vehicle, rows, options, requested, model, stage.reasons);
  AWMR_RETURN_IF_ERROR(check_replay(plant_of(vehicle, power_law.initial_guess), rows.front().file));
  auto [logs, first, findings] = first_fit(rows, power_law, options);
  append(stage.findings, findings);
  if (const auto other = read_again(logs, with_back_emf_as_in(first, power_law), first)) {
    Result<LogStage> again =
        run_log_stage(vehicle, other->logs, options, requested, model, overrule);
    if (again) again->findings.push_back(other->finding);
    return again;
  }
  FamilyFit chosen = fit_families(logs, power_law, options, std::move(first), stage);
  const auto speed_control = find_speed_control(vehicle, logs, chosen);
  withdraw_if_implausible(chosen, speed_control, logs.front().file, stage);
  show_step(options, "comparing the logs with each other");
  const bool has_changed = report_change(logs, power_law, chosen, stage);
  if (!has_changed) compare_parts(logs, chosen, stage);
  withdraw_or_widen(logs, chosen, stage);
  stage.reports[stage.chosen_report] = chosen.fit.report;
  const std::string& file = logs.front().file;
  if (!chosen.fit.usable) {
    refuse_all(chosen, file, stage);
    for (const std::string& name : options.terms) {
      stage.findings.push_back(
          {file, 0, Severity::kError, "not-identifiable",
           name + " cannot be identified: the fit of the logs did not converge"});
    }
    return stage;
  }
  take(chosen.fit, model, overrule, logs, stage);
  if (has_changed) doubt_force_terms(stage.findings);
  append(stage.findings, refused_terms(chosen.fit, options.terms, file));
  if (speed_control) add_cause({speed_control_finding(*speed_control, file)}, stage);
  check_inertia(vehicle, logs, model, stage);
  return stage;
}

}  // namespace awmr
