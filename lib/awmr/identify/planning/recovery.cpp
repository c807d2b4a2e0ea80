// Statistics of the runs of `awmr recover`, and their texts and JSON Schema.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/json/json.h"
#include "awmr/core/option_text.h"
#include "awmr/identify/planning/recover_part.h"
#include "awmr/model/findings_json.h"

namespace awmr {
namespace {

/// Statistics of the parameter `truth`, whose index in the runs' estimates is `place`. Numbers are
/// added in the order of the runs, so that the sums do not depend on threads or parts.
RecoveredParameter recovered_parameter(const RecoverTruth& truth, std::size_t place,
                                       const std::vector<RecoverRun>& runs) {
  RecoveredParameter p{.id = truth.id, .truth = truth.value};
  int covered = 0;
  for (const RecoverRun& run : runs) {
    const std::optional<RecoverEstimate>& estimate = run.estimates[place];
    if (!estimate) continue;
    const double error = estimate->value - truth.value;
    p.bias += error;
    p.rmse += error * error;
    p.mean_std_error += estimate->std_error.value_or(0.0);
    if (truth.value != 0.0) p.worst_error = std::max(p.worst_error, std::abs(error / truth.value));
    covered += estimate->ci95.contains(truth.value) ? 1 : 0;
    ++p.runs;
  }
  if (p.runs == 0) return p;
  const double n = p.runs;
  p.bias /= n;
  p.rmse = std::sqrt(p.rmse / n);
  p.mean_std_error /= n;
  p.coverage95 = covered / n;
  return p;
}

Status check_recovered(const Recovery& recovery, const RecoverPart& whole) {
  if (whole.error) return tl::unexpected(*whole.error);
  std::vector<std::string_view> missing;
  for (const ParameterId id : whole.requested) {
    const auto is_it = [&](const RecoveredParameter& p) { return p.id == id; };
    if (std::ranges::none_of(recovery.parameters, is_it)) missing.push_back(info(id).name);
  }
  if (!recovery.parameters.empty() && missing.empty()) return {};
  return refusal(
      ErrorCode::kNotRecovered,
      fmt::format("none of {} runs has estimated {}{}", recovery.runs,
                  missing.empty() ? "a parameter" : fmt::format("{}", fmt::join(missing, ", ")),
                  whole.refusal ? ": " + whole.refusal->message
                                : ", because the trials of this plan do not determine it"));
}

/// Returns a note on the quantities that the model identified, but none of the runs. A coast-down
/// curve identifies m' and I'z, a log all other quantities.
std::vector<Finding> left_out_findings(const Recovery& recovery, const RecoverPart& whole) {
  std::vector<std::string_view> missing;
  bool is_mass = false;
  for (const ParameterId id : whole.identified) {
    const auto is_it = [id](const RecoveredParameter& p) { return p.id == id; };
    if (std::ranges::any_of(recovery.parameters, is_it)) continue;
    missing.push_back(info(id).name);
    is_mass = is_mass || id == ParameterId::kMassNorm;
  }
  if (missing.empty()) return {};
  return {
      {"", 0, Severity::kNote, "not-identifiable",
       fmt::format("the simulated trials do not determine {}, which the model identified from "
                   "other trials, so their bias and coverage are not tested; use {}",
                   fmt::join(missing, ", "), option_text(is_mass ? "plan curve" : "plan log"))}};
}

constexpr long kMaxRuns = std::numeric_limits<int>::max();

void describe_recovery(JsonObject& json) {
  json.schema("awmr.recover/1");
  read_provenance(json);
  json.integer("runs", 0, kMaxRuns);
  json.integer("refused_runs", 0, kMaxRuns);
  json.string("noise");
  for (JsonObject& parameter : json.object("parameters").values()) {
    for (const char* key :
         {"truth", "bias", "rmse", "mean_std_error", "coverage95", "worst_relative_error"}) {
      parameter.number(key);
    }
    parameter.integer("runs", 0, kMaxRuns);
    parameter.reject_unknown_keys();
  }
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

Result<Recovery> recovery_of(const RecoverPart& whole) {
  Recovery recovery{
      .parameters = {}, .noise_text = whole.noise_text, .runs = whole.all_runs, .failed = 0};
  recovery.failed = static_cast<int>(
      std::ranges::count_if(whole.runs, [](const RecoverRun& run) { return run.refused; }));
  for (std::size_t i = 0; i < whole.truths.size(); ++i) {
    const RecoveredParameter p = recovered_parameter(whole.truths[i], i, whole.runs);
    if (p.runs > 0) recovery.parameters.push_back(p);
  }
  AWMR_RETURN_IF_ERROR(check_recovered(recovery, whole));
  recovery.findings = left_out_findings(recovery, whole);
  return recovery;
}

Result<Recovery> recover(const Model& model, const RecoverOptions& options,
                         const std::function<void(int)>& progress) {
  AWMR_ASSIGN_OR_RETURN(const RecoverPart whole, recover_part(model, options, {}, progress));
  return recovery_of(whole);
}

std::string recovery_text(const Recovery& recovery, const Provenance& provenance) {
  Json json = output_document("awmr.recover/1", provenance);
  json["runs"] = recovery.runs;
  json["refused_runs"] = recovery.failed;
  json["noise"] = recovery.noise_text;
  json["parameters"] = Json::object();
  for (const RecoveredParameter& p : recovery.parameters) {
    json["parameters"][std::string(info(p.id).name)] = {{"truth", p.truth},
                                                        {"bias", p.bias},
                                                        {"rmse", p.rmse},
                                                        {"mean_std_error", p.mean_std_error},
                                                        {"coverage95", p.coverage95},
                                                        {"worst_relative_error", p.worst_error},
                                                        {"runs", p.runs}};
  }
  return to_text(json);
}

std::string recovery_table(const Recovery& recovery) {
  std::string text = fmt::format("{} runs, {} of them with a refused parameter; noise {}\n",
                                 recovery.runs, recovery.failed, recovery.noise_text);
  text += fmt::format("  {:<24} {:>10} {:>11} {:>10} {:>10} {:>9} {:>6}\n", "", "truth", "bias",
                      "rmse", "std error", "coverage", "runs");
  for (const RecoveredParameter& p : recovery.parameters) {
    text += fmt::format("  {:<24} {:>10.5g} {:>+11.2g} {:>10.2g} {:>10.2g} {:>7.1f} % {:>6}\n",
                        info(p.id).name, p.truth, p.bias, p.rmse, p.mean_std_error,
                        100.0 * p.coverage95, p.runs);
  }
  return text;
}

std::string recover_schema() {
  return json_schema_text("awmr.recover/1", "Bias and coverage of the fits, by simulation",
                          describe_recovery);
}

}  // namespace awmr
