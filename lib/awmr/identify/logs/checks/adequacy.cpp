#include "awmr/identify/logs/checks/log_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/identify/logs/choice/family_choice.h"
#include "awmr/identify/logs/problem/windows.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Adds the fits with other families (forms) of the surge resistance to the reports in `adequacy`.
/// If one of them is better than the power law, returns the advice to use it, else empty.
std::optional<std::string> try_alternatives(BestFamily alternatives, const FamilyFit& chosen,
                                            Adequacy& adequacy) {
  append(adequacy.alternatives, reports_of(alternatives.others, chosen));
  append(adequacy.findings, alternatives.findings);
  if (alternatives.best.surge == Family::kPower) return std::nullopt;
  adequacy.alternatives.push_back(alternatives.best.fit.report);
  return fmt::format("a power law does not fit these logs; use {}, whose AIC is lower by {}",
                     option_text(fmt::format("family surge={}", name_of(alternatives.best.surge))),
                     aic_decrease_text(aic_lead(alternatives.best.fit, chosen.fit)));
}

/// True for a channel whose large drift makes all intervals invalid: speed; yaw rate; position, if
/// there is no speed; heading, if there is no yaw rate or if the yaw rate shows a model error too.
/// Other drifts of position or heading do not count: the GNSS receiver or the compass can cause
/// them.
bool is_evaluated(const NoiseLevels& noise, LogChannel channel) {
  switch (channel) {
    case LogChannel::kSpeed:
    case LogChannel::kYawRate:
      return true;
    case LogChannel::kHeading:
      return !has_channel(noise, LogChannel::kYawRate) ||
             any_sensor(noise, LogChannel::kYawRate, &ChannelNoise::of_the_model);
    case LogChannel::kX:
    case LogChannel::kY:
      return !has_channel(noise, LogChannel::kSpeed);
    default:
      return false;
  }
}

/// True if the logs measure only positions. Then every model error makes all intervals invalid: it
/// can also come from a drifting receiver, or from a search that ended in a wrong optimum.
bool has_only_positions(const NoiseLevels& noise) {
  return std::ranges::all_of(channels_of(noise), [](LogChannel channel) {
    return channel == LogChannel::kX || channel == LogChannel::kY;
  });
}

/// The sensors with a model error.
NoiseLevels inadequate_sensors(NoiseLevels noise) {
  std::erase_if(noise, [](const auto& level) { return !level.second.of_the_model(); });
  return noise;
}

std::string possible_causes(const std::set<LogChannel>& channels) {
  std::string sway;
  if (channels.contains(LogChannel::kSway)) {
    sway =
        "the tyres slide, or the sway sensor drifts, is mounted at an angle, or sits ahead of or "
        "behind the centre of gravity";
    if (channels.size() == 1) return sway;
  }
  const std::string causes =
      "an unmodelled effect (a motor driver that brakes at a command of 0, a curved throttle, "
      "play or a curved steering linkage without a steering_deg column, a castor that swivels, "
      "steered rear wheels, a slope, sliding tyres); "
      "a change of load, ground or battery during a log; "
      "a wrong value in the vehicle file (half_track_m, front_axle_m, steering.max_rate_degps); "
      "a sensor with a bias or drift";
  const std::string bias =
      channels.contains(LogChannel::kYawRate)
          ? " (" + option_text("fit bias.yaw_rate_radps") + " estimates a bias of the yaw rate)"
          : "";
  return causes + bias + (sway.empty() ? "" : "; for the sway speed, " + sway);
}

std::string describe_error(const LogSensor& sensor, const ChannelNoise& noise) {
  const std::string duration = noise.correlation_s < kWindow_s
                                   ? fmt::format("{:.2g} s", noise.correlation_s)
                                   : fmt::format("more than {:g} s", kWindow_s);
  return fmt::format("{} by {:.3g} {} for {} (sensor noise {:.2g})", describe(sensor),
                     noise.drift_std, info(sensor.channel).unit, duration, noise.sensor_std);
}

std::string describe_effect(const Adequacy& adequacy) {
  if (adequacy.withdraws_intervals) return "The intervals are withdrawn";
  std::string withdrawn;
  if (adequacy.withdraws_servo) withdrawn = "steering.time_constant_s";
  if (adequacy.withdraws_sway)
    withdrawn += (withdrawn.empty() ? "" : " and ") + std::string("sway.alpha");
  if (withdrawn.empty()) return "The confidence intervals do not allow for this deviation";
  return "No interval for " + withdrawn + "; the other intervals do not allow for this deviation";
}

}  // namespace

std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file) {
  constexpr double kSignificant = 1e-3;
  constexpr double kMuch = 1.5;
  std::vector<Finding> findings;
  for (const Diagnostic& test : fit.report.diagnostics) {
    if (test.p_value >= kSignificant || !test.name.starts_with("whiteness")) continue;
    findings.push_back(
        {file, 0, fit.widened >= kMuch ? Severity::kWarning : Severity::kNote, "coloured-residuals",
         fmt::format(
             "{}: successive residuals are more strongly correlated than their noise model "
             "allows (p = {:.2g}), so the model is incomplete. To allow for this, standard "
             "errors were multiplied by up to {:.2g}, the factor by which parts of the logs "
             "scatter more than the noise model predicts",
             test.name, test.p_value, fit.widened)});
  }
  return findings;
}

Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families) {
  Adequacy adequacy;
  const NoiseLevels& noise = chosen.fit.noise;
  const NoiseLevels inadequate = inadequate_sensors(noise);
  if (inadequate.empty()) return adequacy;
  const std::set<LogChannel> channels = channels_of(inadequate);
  std::string errors;
  for (const auto& [sensor, level] : inadequate) {
    const LogChannel channel = sensor.channel;
    adequacy.withdraws_intervals |=
        has_only_positions(noise) || (level.overwhelms_sensor() && is_evaluated(noise, channel));
    adequacy.withdraws_sway |=
        has(chosen.fit.quantities, ParameterId::kSwayAlpha) &&
        (channel == LogChannel::kSway || channel == LogChannel::kX || channel == LogChannel::kY);
    adequacy.withdraws_servo |=
        has(chosen.fit.quantities, ParameterId::kSteeringTimeConstant) &&
        (channel == LogChannel::kHeading || channel == LogChannel::kYawRate);
    errors += (errors.empty() ? "" : ", ") + describe_error(sensor, level);
  }
  std::string advice = possible_causes(channels);
  if (channels.contains(LogChannel::kSpeed) && try_families) {
    advice = try_alternatives(best_family(logs, power_law, chosen, {.only_candidates = false}),
                              chosen, adequacy)
                 .value_or(advice);
  }
  adequacy.findings.push_back(
      {logs.front().file, 0, Severity::kWarning, "model-inadequate",
       fmt::format("the difference between model and logs keeps its sign for longer than sensor "
                   "noise explains: {}. Possible causes: {}. {}",
                   errors, advice, describe_effect(adequacy))});
  return adequacy;
}

}  // namespace awmr
