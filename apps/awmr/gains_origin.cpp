#include "gains_origin.h"

#include <fmt/format.h>

#include "awmr/core/input_file.h"
#include "awmr/core/json.h"

namespace awmr::cli {

Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(gains, ignored)) return {};
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(gains));
  AWMR_ASSIGN_OR_RETURN(const InputFile own, input_file(model));
  if (is_made_from(json, own.sha256).value_or(true)) return {};
  findings.push_back(
      {gains.string(), 0, Severity::kWarning, "gains-of-another-model",
       fmt::format("these gains were tuned on another model than {}, or on it before it changed: "
                   "their constraints and margins do not hold for this one. Tune again (awmr tune)",
                   model.filename().string())});
  return {};
}

}  // namespace awmr::cli
