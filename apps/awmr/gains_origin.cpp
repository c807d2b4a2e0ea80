#include "gains_origin.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "awmr/core/input_file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"
#include "awmr/model/gains_json.h"
#include "awmr/simulate/scenario.h"

namespace awmr::cli {

namespace {

/// Returns the mode that the gains were tuned for; empty if they were tuned for all modes.
std::optional<YawMode> tuned_mode(JsonObject& gains) {
  if (!gains.has("mode")) return std::nullopt;
  return gains.choice("mode", kYawModeNames);
}

Finding of_another_mode(const std::filesystem::path& gains, YawMode tuned,
                        std::optional<YawMode> mode) {
  return {gains.string(), 0, Severity::kWarning, "gains-of-another-mode",
          fmt::format("these gains were tuned for mode {} only and are used in {}: their "
                      "constraints and margins are not valid there. Tune for {} (awmr tune)",
                      name_of(tuned), mode ? name_of(*mode) : "other modes as well",
                      mode ? "this mode, or for all of them" : "all modes")};
}

Finding changed_gains(const std::filesystem::path& gains) {
  return {gains.string(), 0, Severity::kWarning, "gains-changed",
          "the gains in this file were changed after tuning, so its constraints, margins and "
          "metrics are not valid for them. awmr tune --baseline tests them"};
}

}  // namespace

Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(gains, ignored)) return {};
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(gains));
  AWMR_ASSIGN_OR_RETURN(const std::optional<YawMode> tuned,
                        read_json_object(json, gains.string(), tuned_mode));
  if (tuned && mode != tuned) findings.push_back(of_another_mode(gains, *tuned, mode));
  if (has_changed_gains(json)) findings.push_back(changed_gains(gains));
  AWMR_ASSIGN_OR_RETURN(const InputFile own, input_file(model));
  if (is_made_from(json, own.sha256).value_or(true)) return {};
  findings.push_back(
      {gains.string(), 0, Severity::kWarning, "gains-of-another-model",
       fmt::format(
           "these gains were tuned for another model than {}, or for an earlier version of that "
           "file: their constraints and margins are not valid for it. Tune again (awmr tune)",
           model.filename().string())});
  return {};
}

}  // namespace awmr::cli
