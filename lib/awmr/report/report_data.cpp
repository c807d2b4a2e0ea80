#include "awmr/report/report_data.h"

#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/report/drawn_fit.h"
#include "awmr/report/metric_words.h"
#include "awmr/report/run_data.h"

namespace awmr {
namespace {

/// Errors (input): a result was made from another model.json or gains.json than the one beside it.
Status check_same_inputs(const std::filesystem::path& directory, const std::string& result,
                         const Json& json) {
  if (!json.contains("inputs")) return {};
  for (const Json& input : json["inputs"]) {
    const std::filesystem::path name = std::filesystem::path(input.value("name", "")).filename();
    if ((name != "model.json" && name != "gains.json") || name == result) continue;
    AWMR_ASSIGN_OR_RETURN(const bool is_here, regular_file_exists(directory / name));
    if (!is_here) continue;
    AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(directory / name));
    if (sha256_hex(bytes) == input.value("sha256", "")) continue;
    return input_error((directory / result).string() + ":/inputs",
                       "was made from another " + name.string() +
                           " than the one beside it: make it again, or take it out of the "
                           "directory");
  }
  return {};
}

}  // namespace

Result<ReportData> read_report_data(const std::filesystem::path& directory) {
  ReportData data;
  // Strictly first: what is shown is a model, or the fault's place is named.
  AWMR_RETURN_IF_ERROR(check_regular_file(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(data.model, read_model(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(data.json["model"], read_json_file(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(const bool has_gains, regular_file_exists(directory / "gains.json"));
  if (has_gains) AWMR_RETURN_IF_ERROR(read_gains(directory / "gains.json"));
  for (const char* name : {"gains", "validation", "comparison", "pil", "suggest"}) {
    const auto path = directory / (std::string(name) + ".json");
    AWMR_ASSIGN_OR_RETURN(const bool is_there, regular_file_exists(path));
    if (!is_there) continue;
    AWMR_ASSIGN_OR_RETURN(data.json[name], read_json_file(path));
    AWMR_RETURN_IF_ERROR(check_same_inputs(directory, path.filename().string(), data.json[name]));
  }
  AWMR_ASSIGN_OR_RETURN(const bool has_samples, regular_file_exists(directory / "comparison.csv"));
  if (has_samples) {
    AWMR_ASSIGN_OR_RETURN(data.json["samples"], read_samples(directory / "comparison.csv"));
  }
  AWMR_ASSIGN_OR_RETURN(data.json["header"], path_exists(directory / "awmr_params.h"));
  AWMR_ASSIGN_OR_RETURN(data.json["runs"], read_runs(directory));
  AWMR_ASSIGN_OR_RETURN(data.json["scenarios"], read_scenarios(directory));
  data.json["fits"] = fits_json(data.model);
  data.json["metric_words"] = metric_words_json();
  return data;
}

}  // namespace awmr
