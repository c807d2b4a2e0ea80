#include "awmr/identify/logs/adequacy.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/identify/logs/family_score.h"
#include "awmr/identify/logs/windows.h"

namespace awmr {
namespace {

/// Adds the fits with other formulas of the surge resistance ("families") to the reports in
/// `adequacy`. If one of them is better than the power law, returns the advice to use it. Returns
/// empty if the power law is the best.
std::optional<std::string> try_alternatives(BestFamily alternatives, const FamilyFit& chosen,
                                            Adequacy& adequacy) {
  for (EstimatorReport& report : reports_of(alternatives.others, chosen)) {
    adequacy.alternatives.push_back(std::move(report));
  }
  for (Finding& finding : alternatives.findings) adequacy.findings.push_back(std::move(finding));
  if (alternatives.best.surge == Family::kPower) return std::nullopt;
  adequacy.alternatives.push_back(alternatives.best.fit.report);
  return fmt::format("a power law does not fit these logs; use {}, whose AIC is lower by {:.0f}",
                     option_text(fmt::format("family surge={}", name_of(alternatives.best.surge))),
                     aic_lead(alternatives.best.fit, chosen.fit));
}

/// True for channels whose large drift invalidates the intervals: speed and yaw rate, the position
/// if there is no speed, the heading if there is no yaw rate or if the yaw rate shows a model error
/// too. (A drift of position or heading alone can come from the GNSS receiver or the compass.)
bool is_evaluated(const NoiseLevels& noise, LogChannel channel) {
  switch (channel) {
    case LogChannel::kSpeed:
    case LogChannel::kYawRate:
      return true;
    case LogChannel::kHeading:
      return !noise.contains(LogChannel::kYawRate) || noise.at(LogChannel::kYawRate).of_the_model();
    case LogChannel::kX:
    case LogChannel::kY:
      return !noise.contains(LogChannel::kSpeed);
    default:
      return false;
  }
}

/// True if only positions are measured. A lasting error can then also come from a drifting receiver
/// or from a search that ended in a wrong optimum.
bool has_only_positions(const NoiseLevels& noise) {
  return std::ranges::all_of(noise, [](const auto& channel) {
    return channel.first == LogChannel::kX || channel.first == LogChannel::kY;
  });
}

/// Possible causes of a model error in a channel.
std::string possible_causes(LogChannel channel) {
  if (channel == LogChannel::kSway) {
    return "the tyres slide, or the sensor drifts, is mounted at an angle, or sits ahead of or "
           "behind the centre of gravity";
  }
  const std::string causes =
      "an unmodelled effect acts on the vehicle (a motor driver that brakes at a command of 0, a "
      "curved throttle, play or a curved linkage of the steering, a slope, sliding tyres), a value "
      "in the vehicle file is wrong (half_track_m, front_axle_m, "
      "steering.max_rate_degps), or the sensor has a bias or drifts";
  if (channel != LogChannel::kYawRate) return causes;
  return causes + " (" + option_text("fit bias.yaw_rate_radps") + " estimates a bias)";
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
         fmt::format("{}: successive residuals are more strongly correlated than their noise model "
                     "allows (p = {:.2g}), so the model is incomplete. Standard errors are "
                     "multiplied by up to {:.2g}, according to the scatter between parts of the "
                     "logs",
                     test.name, test.p_value, fit.widened)});
  }
  return findings;
}

Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families) {
  Adequacy adequacy;
  for (const auto& [channel, noise] : chosen.fit.noise) {
    if (!noise.of_the_model()) continue;
    std::string advice = possible_causes(channel);
    if (channel == LogChannel::kSpeed && try_families) {
      advice = try_alternatives(best_family(logs, power_law, chosen, {.only_candidates = false}),
                                chosen, adequacy)
                   .value_or(advice);
    }
    const bool is_models = noise.overwhelms_sensor() && is_evaluated(chosen.fit.noise, channel);
    const bool withdraws = is_models || has_only_positions(chosen.fit.noise);
    adequacy.withdraws_intervals |= withdraws;
    adequacy.withdraws_sway |= channel == LogChannel::kSway;
    const bool is_of_turns = channel == LogChannel::kHeading || channel == LogChannel::kYawRate;
    adequacy.withdraws_servo |= is_of_turns;
    adequacy.findings.push_back(
        {logs.front().file, 0, Severity::kWarning, "model-inadequate",
         fmt::format("the model has an error of {1:.3g} {2} in {0} that persists for {3}, compared "
                     "with a sensor noise of {4:.2g}: {5}. {6}",
                     info(channel).name, noise.drift_std, info(channel).unit,
                     noise.correlation_s < kWindow_s ? fmt::format("{:.2g} s", noise.correlation_s)
                                                     : fmt::format("more than {:g} s", kWindow_s),
                     noise.sensor_std, advice,
                     withdraws                      ? "The intervals are withdrawn"
                     : channel == LogChannel::kSway ? "The interval of sway.alpha is withdrawn"
                     : is_of_turns
                         ? "The interval of steering.time_constant_s is withdrawn; the others do "
                           "not include this model error"
                         : "The intervals do not include this model error")});
  }
  return adequacy;
}

}  // namespace awmr
