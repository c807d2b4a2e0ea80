#include "awmr/report/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/model/finding_rank.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/report/drawn_fit.h"
#include "awmr/report/metric_words.h"
#include "awmr/report/run_data.h"
#include "awmr/simulate/run_file.h"

namespace awmr {
namespace {

/// Hashes of model.json and gains.json in the directory, with which the inputs of other results are
/// compared.
struct Origin {
  std::string model_sha256;
  std::string gains_sha256 = {};  ///< empty if there is no gains.json for this model
};

/// Returns a finding if a result was made from another model or other gains than those in the
/// directory. Returns nothing if they agree, or if the result does not name its inputs.
std::optional<Finding> foreign_result(const std::string& result, const Json& json,
                                      const Origin& origin) {
  const std::optional<bool> is_of_model = is_made_from(json, origin.model_sha256);
  if (!is_of_model) return std::nullopt;
  bool is_of_gains = true;
  for (const Json& input : json["inputs"]) {
    if (!input.is_object()) continue;
    const Json sha256 = input.value("sha256", Json());
    const std::filesystem::path name = input.value("name", std::string());
    if (name.filename() != "gains.json" || origin.gains_sha256.empty()) continue;
    is_of_gains = is_of_gains && sha256 == origin.gains_sha256;
  }
  if (*is_of_model && is_of_gains) return std::nullopt;
  return Finding{result, 0, Severity::kWarning, "result-of-another-model",
                 fmt::format("was made from another {} than the one in this directory, and is not "
                             "shown. Create it again, or remove it from the directory",
                             *is_of_model ? "gains.json" : "model.json")};
}

/// Adds the findings of a result to the list. Invalid findings are skipped.
void add_findings_of(const Json& json, std::vector<Finding>& findings) {
  if (!json.is_object() || !json.contains("findings")) return;
  std::vector<Fault> faults;
  JsonObject object(json, "", "", faults);
  const std::vector<Finding> more = read_findings(object);
  if (faults.empty()) append(findings, more);
}

/// Returns a finding if a run must be left out of the report: its side file is missing, has the
/// hash of another run, or names another model or other gains. Otherwise returns empty, and adds
/// the findings of the run to the list.
Result<std::optional<Finding>> foreign_run(const std::filesystem::path& directory,
                                           const std::string& name, const Origin& origin,
                                           std::vector<Finding>& findings) {
  const std::filesystem::path side = run_side_path(directory / name);
  AWMR_ASSIGN_OR_RETURN(const bool has_side, regular_file_exists(side));
  const auto without = [&](const char* why) {
    return Finding{name, 0, Severity::kWarning, "result-without-origin",
                   fmt::format("{}, so its model is unknown and it is not shown. Simulate it "
                               "again (awmr simulate)",
                               why)};
  };
  if (!has_side) return without("has no side file (.csv.json)");
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(side));
  AWMR_ASSIGN_OR_RETURN(const std::string csv, read_file(directory / name));
  if (!json.is_object() || json.value("csv_sha256", Json()) != sha256_hex(csv)) {
    return without("does not belong to its side file (.csv.json)");
  }
  auto foreign = foreign_result(name, json, origin);
  if (!foreign) add_findings_of(json, findings);
  return foreign;
}

/// The findings as JSON for the page. Those with the largest effect on the results come first;
/// repetitions are left out.
Json shown_findings(const std::vector<Finding>& findings) {
  std::vector<Finding> order;
  for (const Finding* finding : by_effect(findings)) {
    const bool is_known = std::ranges::any_of(order, [&](const Finding& other) {
      return other.code == finding->code && other.file == finding->file &&
             other.line == finding->line && other.message == finding->message;
    });
    if (!is_known) order.push_back(*finding);
  }
  return findings_to_json(order);
}

/// Reads gains.json and the other results; omits results of another model or other gains.
Status read_results(const std::filesystem::path& directory, Origin& origin, ReportData& data,
                    std::vector<Finding>& of_results) {
  for (const char* name : {"gains", "validation", "comparison", "pil", "suggest"}) {
    const auto path = directory / (std::string(name) + ".json");
    AWMR_ASSIGN_OR_RETURN(const bool is_there, regular_file_exists(path));
    if (!is_there) continue;
    if (std::string_view(name) == "gains") AWMR_RETURN_IF_ERROR(read_gains(path));
    AWMR_ASSIGN_OR_RETURN(Json json, read_json_file(path));
    if (auto foreign = foreign_result(path.filename().string(), json, origin)) {
      data.left_out.push_back(*std::move(foreign));
      continue;
    }
    if (std::string_view(name) == "gains") {
      AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(path));
      origin.gains_sha256 = sha256_hex(bytes);
    }
    add_findings_of(json, of_results);
    data.json[name] = std::move(json);
  }
  return {};
}

/// Reads the samples of comparison.csv. If comparison.json names another hash for this file, the
/// file is omitted with a warning.
Status read_own_samples(const std::filesystem::path& directory, ReportData& data) {
  const std::filesystem::path path = directory / "comparison.csv";
  AWMR_ASSIGN_OR_RETURN(const bool is_there, regular_file_exists(path));
  if (!is_there || !data.json.contains("comparison")) return {};
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(path));
  const Json& comparison = data.json["comparison"];
  if (comparison.contains("csv_sha256") && comparison["csv_sha256"] != sha256_hex(bytes)) {
    data.left_out.push_back({"comparison.csv", 0, Severity::kWarning, "result-without-origin",
                             "does not belong to comparison.json, and is not shown. Compare again "
                             "(awmr compare)"});
    return {};
  }
  AWMR_ASSIGN_OR_RETURN(data.json["samples"], read_samples(path));
  return {};
}

/// Adds the findings of awmr_emit.json, next to the results or in `firmware`.
Status add_emitted(const std::filesystem::path& directory, const Origin& origin,
                   std::vector<Finding>& findings) {
  for (const auto& folder : {directory, directory / "firmware"}) {
    const std::filesystem::path path = folder / "awmr_emit.json";
    AWMR_ASSIGN_OR_RETURN(const bool is_there, regular_file_exists(path));
    if (!is_there) continue;
    AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(path));
    if (!foreign_result(path.filename().string(), json, origin)) add_findings_of(json, findings);
  }
  return {};
}

}  // namespace

Result<ReportData> read_report_data(const std::filesystem::path& directory) {
  ReportData data;
  AWMR_ASSIGN_OR_RETURN(const bool has_model, regular_file_exists(directory / "model.json"));
  if (!has_model) {
    return input_error(ErrorCode::kCannotRead, (directory / "model.json").string(),
                       "there is no such file; a report needs a directory with the results of awmr "
                       "run, or at least with the model.json of awmr identify");
  }
  // Calls read_model() before read_json_file(), because the errors of read_model() name the
  // position of the fault in the file.
  AWMR_ASSIGN_OR_RETURN(data.model, read_model(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(data.json["model"], read_json_file(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(directory / "model.json"));
  Origin origin{.model_sha256 = sha256_hex(bytes)};
  std::vector<Finding> findings = data.model.record.findings;
  AWMR_RETURN_IF_ERROR(read_results(directory, origin, data, findings));
  AWMR_RETURN_IF_ERROR(read_own_samples(directory, data));
  AWMR_RETURN_IF_ERROR(add_emitted(directory, origin, findings));
  AWMR_ASSIGN_OR_RETURN(data.json["header"], path_exists(directory / "awmr_params.h"));
  const auto is_own = [&](const std::string& name) -> Result<bool> {
    AWMR_ASSIGN_OR_RETURN(auto foreign, foreign_run(directory, name, origin, findings));
    if (foreign) data.left_out.push_back(*foreign);
    return !foreign;
  };
  AWMR_ASSIGN_OR_RETURN(data.json["runs"], read_runs(directory, is_own));
  AWMR_ASSIGN_OR_RETURN(data.json["scenarios"], read_scenarios(directory));
  data.json["fits"] = fits_json(data.model);
  if (const auto fastest_degps = measured_yaw_rate_degps(data.model)) {
    data.json["yaw_rate_measured_degps"] = *fastest_degps;
  }
  data.json["metric_words"] = metric_words_json();
  append(findings, data.left_out);
  data.json["findings"] = shown_findings(findings);
  return data;
}

}  // namespace awmr
