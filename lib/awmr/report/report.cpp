#include "awmr/report/report.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "awmr/core/json.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model.h"
#include "awmr/model/model_file.h"
#include "awmr/report/live_numbers.h"
#include "awmr/report/run_data.h"
#include "awmr/simulate/scenario_file.h"

namespace awmr {

extern const std::string_view kVegaJs;
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
extern const std::string_view kLiveWasm;  ///< packed, in base 64; empty: built without it

namespace {

namespace fs = std::filesystem;

/// JSON inside a script element: `<` is escaped, so that no text can close the element.
std::string script_safe(const Json& json) {
  std::string text;
  for (const char c : json.dump()) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

/// The paper's claims are about its vehicle: mass, box, axle and track, its Table 1.
bool is_vehicle_of_paper(const Vehicle& vehicle) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9 * b; };
  return near(vehicle.mass_kg, 37.0) && near(vehicle.length_m, 1.32) &&
         near(vehicle.width_m, 0.78) && near(vehicle.front_axle_m, 0.35) &&
         near(vehicle.half_track_m, 0.36);
}

/// Each `@name@` of the page's frame, once, replaced by its part.
std::string assembled(const Json& data) {
  const std::string json = script_safe(data);
  const std::array<std::pair<std::string_view, std::string_view>, 5> parts{
      {{"css", kPageCss}, {"vega", kVegaJs}, {"data", json}, {"js", kPageJs}, {"wasm", kLiveWasm}}};
  std::string page;
  std::string_view rest = kPageHtml;
  while (true) {
    const std::size_t start = rest.find('@');
    page += rest.substr(0, start);
    if (start == std::string_view::npos) return page;
    const std::size_t end = rest.find('@', start + 1);
    const std::string_view name = rest.substr(start + 1, end - start - 1);
    for (const auto& [part, text] : parts) {
      if (part == name) page += text;
    }
    rest.remove_prefix(end + 1);
  }
}

/// What the live part of the page begins with: the first heading scenario without anything else in
/// it, or the paper's; absent without gains, and where the model knows nothing of turning.
Status add_live(const fs::path& directory, const Model& model, Json& data) {
  if (kLiveWasm.empty() || !data.contains("gains")) return {};
  Scenario scenario = heading_steps({30.0, -30.0}, {.name = "headings 30 then -30 deg"});
  for (const auto& [stem, json] : data["scenarios"].items()) {
    if (!is_plain_heading(json)) continue;
    AWMR_ASSIGN_OR_RETURN(scenario, read_scenario(directory / ("scenario_" + stem + ".json")));
    break;
  }
  AWMR_ASSIGN_OR_RETURN(const std::vector<double> numbers,
                        live_numbers(model, data["gains"], scenario));
  if (numbers.empty()) return {};
  Json modes = Json::array();
  for (const YawMode mode : yaw_modes(model.vehicle)) modes.push_back(name_of(mode));
  data["live"] = {{"numbers", numbers},
                  {"modes", std::move(modes)},
                  {"scenario", scenario.name},
                  {"sample_time_s", model.vehicle.sample_time_s}};
  return {};
}

/// Errors (input): a result was made from another model.json or gains.json than the one beside it.
Status check_same_inputs(const fs::path& directory, const std::string& result, const Json& json) {
  if (!json.contains("inputs")) return {};
  for (const Json& input : json["inputs"]) {
    const fs::path name = fs::path(input.value("name", "")).filename();
    const bool is_here = name == "model.json" || name == "gains.json";
    if (!is_here || name == result || !fs::exists(directory / name)) continue;
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

Result<std::string> report_html(const fs::path& directory) {
  Json data;
  // Strictly first: what the page shows is a model, or the fault's place is named.
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(directory / "model.json"));
  data["paper_vehicle"] = is_vehicle_of_paper(model.vehicle);
  AWMR_ASSIGN_OR_RETURN(data["model"], read_json_file(directory / "model.json"));
  if (const fs::path path = directory / "gains.json"; fs::exists(path)) {
    AWMR_RETURN_IF_ERROR(read_gains(path));
  }
  for (const char* name : {"gains", "validation", "comparison", "pil", "suggest"}) {
    const fs::path path = directory / (std::string(name) + ".json");
    if (!fs::exists(path)) continue;
    AWMR_ASSIGN_OR_RETURN(data[name], read_json_file(path));
    AWMR_RETURN_IF_ERROR(check_same_inputs(directory, path.filename().string(), data[name]));
  }
  if (const fs::path path = directory / "comparison.csv"; fs::exists(path)) {
    AWMR_ASSIGN_OR_RETURN(data["samples"], read_samples(path));
  }
  data["header"] = fs::exists(directory / "awmr_params.h");
  AWMR_ASSIGN_OR_RETURN(data["runs"], read_runs(directory));
  AWMR_ASSIGN_OR_RETURN(data["scenarios"], read_scenarios(directory));
  AWMR_RETURN_IF_ERROR(add_live(directory, model, data));
  return assembled(data);
}

}  // namespace awmr
