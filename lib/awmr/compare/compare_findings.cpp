#include "awmr/compare/compare_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "awmr/compare/decision.h"
#include "awmr/core/option_text.h"

namespace awmr {
namespace {

void note_samples(const CompareOptions& options, const Comparison& comparison,
                  std::vector<Finding>& findings) {
  const int samples = options.shard.count > 1 ? options.samples : comparison.whole_samples - 1;
  if (samples < 2 || samples >= kFewSamples) return;
  findings.push_back(
      {"", 0, Severity::kWarning, "few-samples",
       fmt::format("95 % intervals from {} samples contain the true value in at most {:.0f} % of "
                   "cases; give {} samples or more",
                   samples, 100.0 * (1.0 - std::pow(0.5, samples - 1)), kFewSamples)});
}

/// Adds the warning `turned-by-sides` if yaw resistance was identified from differential turns,
/// because it then includes the scrub of the tyres. Adds the note `scrub-simulated` if measured
/// scrub is simulated.
void note_scrub(const Model& model, std::vector<Finding>& findings) {
  if (model.yaw_by_sides_alone) {
    findings.push_back(
        {model.file, 0, Severity::kWarning, "turned-by-sides",
         "yaw resistance was identified from differential turns and includes their tyre scrub, so "
         "steering and combined appear worse than they are. Add steered turns to the turning table "
         "(awmr suggest lists them)"});
  }
  if (!model.yaw_scrub || !(model.yaw_scrub->moment_m > 0.0)) return;
  findings.push_back(
      {model.file, 0, Severity::kNote, "scrub-simulated",
       fmt::format(
           "the simulated 3-DOF model includes the measured tyre scrub, a yaw moment of {:.3g} m "
           "(divided by F_max; 95 %: {:.3g} to {:.3g}): all of it in differential turns, in "
           "combined turns in proportion to the moment by wheel-force differences. The "
           "controller does not compensate it. Add {} to compute the scrub at which another mode "
           "becomes as good",
           model.yaw_scrub->moment_m, model.yaw_scrub->ci95_m.lo, model.yaw_scrub->ci95_m.hi,
           option_text("break_even"))});
}

}  // namespace

std::vector<Finding> compare_findings(const Model& model, const std::vector<Scenario>& scenarios,
                                      const CompareOptions& options, const Comparison& comparison,
                                      const HeadingRateChoice& rate) {
  std::vector<Finding> findings;
  for (const Scenario& scenario : scenarios) {
    std::ranges::move(unattainable_requests(scenario, model), std::back_inserter(findings));
    if (auto finding = tyres_differ(scenario, model)) findings.push_back(*std::move(finding));
  }
  if (auto finding = missing_intervals(model)) findings.push_back(*std::move(finding));
  if (options.samples > 0) {
    std::ranges::move(imprecise_parameters(model), std::back_inserter(findings));
  }
  note_samples(options, comparison, findings);
  if (auto finding = heading_rate_not_limited(rate, model)) findings.push_back(*std::move(finding));
  note_scrub(model, findings);
  return findings;
}

std::vector<Finding> completion_findings(const Comparison& comparison) {
  std::vector<Finding> findings;
  const auto is_drawn = [](const ComparisonRow& row) { return row.sample > 0; };
  const bool has_drawn = std::ranges::any_of(comparison.rows, is_drawn);
  for (const Change& change : comparison.changes) {
    std::vector<std::string> labels;
    std::size_t runs = 0;
    for (const Completion& one : change.completed) {
      const auto completes = [&](const ComparisonRow& row) {
        return row.scenario == change.scenario && is_drawn(row) == has_drawn &&
               Contender{row.mode, row.gains} == one.contender && row.metrics.completed;
      };
      if (one.count > 0 || std::ranges::none_of(comparison.rows, completes)) continue;
      labels.push_back(one.contender.label());
      runs = one.of;
    }
    if (labels.empty()) continue;
    findings.push_back(
        {"", 0, Severity::kWarning, "incomplete-if-changed",
         fmt::format(
             "{}: {}, 0 of {} runs are completed by {}, so the ranking may not hold for the "
             "vehicle. {}",
             change.scenario, text_of(change), runs, fmt::join(labels, " and "),
             change.kind == ChangeKind::kPlant
                 ? "Find out which plant describes the vehicle: validate both with logs (awmr "
                   "validate --tyres)"
                 : "Tune again, or give a longer scenario")});
  }
  return findings;
}

std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance) {
  if (comparison.rows.empty()) return {};
  const auto fastest = std::ranges::max_element(
      comparison.rows, {}, [](const ComparisonRow& row) { return row.metrics.yaw_rate_max_degps; });
  const auto commands = comparison.turn_commands.find(fastest->scenario);
  const std::string model = provenance.inputs.empty() ? "" : provenance.inputs.front().name;
  auto finding = extrapolation_finding(
      model, comparison.measured_yaw_rate_degps, fastest->metrics.yaw_rate_max_degps,
      fmt::format("{}, {}, sample {}", fastest->scenario, name_of(fastest->mode), fastest->sample),
      commands == comparison.turn_commands.end() ? TurnCommands{} : commands->second);
  if (!finding) return {};
  return {*std::move(finding)};
}

}  // namespace awmr
