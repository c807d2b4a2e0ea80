// Statistics of the runs of `awmr recover`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "awmr/identify/planning/recover_part.h"

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

/// Checks that the runs have a result. Errors: the error of the first run, if every run failed.
/// Errors (refused): no run has estimated any parameter, or a requested one.
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
  return recovery;
}

Result<Recovery> recover(const Model& model, const RecoverOptions& options,
                         const std::function<void(int)>& progress) {
  AWMR_ASSIGN_OR_RETURN(const RecoverPart whole, recover_part(model, options, {}, progress));
  return recovery_of(whole);
}

}  // namespace awmr
