#include "gains_origin.h"

#include <fmt/format.h>

#include "awmr/core/input_file.h"
#include "awmr/core/json.h"
#include "awmr/simulate/scenario.h"

namespace awmr::cli {

namespace {

void note_other_mode(const Json& json, const std::filesystem::path& gains,
                     std::optional<YawMode> mode, std::vector<Finding>& findings) {
  if (!json.is_object() || !json.contains("mode") || !json["mode"].is_string()) return;
  const std::string tuned = json["mode"].get<std::string>();
  if (mode && name_of(*mode) == tuned) return;
  findings.push_back(
      {gains.string(), 0, Severity::kWarning, "gains-of-another-mode",
       fmt::format("these gains were tuned for mode {} only and are used in {}: their "
                   "constraints and margins are not valid there. Tune for {} (awmr tune)",
                   tuned, mode ? std::string(name_of(*mode)) : "other modes as well",
                   mode ? "this mode, or for all of them" : "all modes")});
}

}  // namespace

Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(gains, ignored)) return {};
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(gains));
  note_other_mode(json, gains, mode, findings);
  AWMR_ASSIGN_OR_RETURN(const InputFile own, input_file(model));
  if (is_made_from(json, own.sha256).value_or(true)) return {};
  findings.push_back(
      {gains.string(), 0, Severity::kWarning, "gains-of-another-model",
       fmt::format(
           "these gains were tuned on another model than {}, or on it before it changed: "
           "their constraints and margins are not valid for this one. Tune again (awmr tune)",
           model.filename().string())});
  return {};
}

}  // namespace awmr::cli
