#include "awmr/report/report.h"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/core/statistics/drawn_rows.h"
#include "awmr/model/model.h"
#include "awmr/report/figures/figure.h"
#include "awmr/report/figures/figures_of.h"
#include "awmr/report/live_numbers.h"
#include "awmr/report/report_data.h"
#include "awmr/simulate/scenario_file.h"

namespace awmr {

extern const std::string_view kVegaJs;
extern const std::string_view kPageHtml;
extern const std::string_view kPlotPy;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
/// The WebAssembly program of the sliders (gzip, base64). Empty if awmr was built without it.
extern const std::string_view kLiveWasm;

namespace {

namespace fs = std::filesystem;

/// JSON text for a script element of the page. `<` is escaped, so that no text in the data can end
/// the element.
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

/// Rounds all numbers to eight significant digits, which is more than the page shows.
void round_numbers(Json& json) {
  if (json.is_number_float()) json = rounded_number(json.get<double>(), 8);
  if (!json.is_structured()) return;
  for (Json& value : json) round_numbers(value);
}

/// Rounds the numbers that the page only displays. The gains are not rounded: the page simulates
/// with them, and its button copies them.
void round_shown(Json& data) {
  for (const char* name : {"model", "validation", "comparison", "pil", "suggest"}) {
    if (data.contains(name)) round_numbers(data[name]);
  }
  if (!data.contains("gains")) return;
  for (const auto& [key, value] : data["gains"].items()) {
    if (key != "heading" && key != "speed" && key != "observer") round_numbers(value);
  }
}

/// Makes the page: replaces each `@name@` in page.html by the part of that name (style, scripts,
/// data). Parts are not searched again, because their text can contain `@`.
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

/// Adds the initial data of the interactive part (the sliders). The sliders simulate the first
/// scenario for which is_plain_heading() is true. If there is none, they simulate headings of 30,
/// then -30 deg. Adds nothing without gains, or if the model cannot simulate turns.
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

}  // namespace

Result<ReportPage> report_page(const fs::path& directory) {
  AWMR_ASSIGN_OR_RETURN(ReportData data, read_report_data(directory));
  data.json["paper_vehicle"] = is_vehicle_of_paper(data.model.vehicle);
  AWMR_RETURN_IF_ERROR(add_live(directory, data.model, data.json));
  round_shown(data.json);
  return ReportPage{assembled(data.json), std::move(data.left_out)};
}

Status check_report_page(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const bool exists, regular_file_exists(path));
  if (!exists) return {};
  AWMR_ASSIGN_OR_RETURN(const std::string page, read_file(path));
  if (page.find("<title>awmr report</title>") != std::string::npos) return {};
  return input_error(
      ErrorCode::kWouldOverwrite, path.string(),
      "is not a page that awmr wrote, and the report would replace this file. Move it away");
}

Result<FigureSet> report_figures(const fs::path& directory) {
  AWMR_ASSIGN_OR_RETURN(const ReportData data, read_report_data(directory));
  AWMR_ASSIGN_OR_RETURN(const FiguresOfResults figures, figures_of(data));
  FigureSet set{.lacking = figures.lacking};
  for (const Figure& figure : figures.figures) {
    AWMR_ASSIGN_OR_RETURN(std::string csv, figure_csv(figure));
    set.files.push_back({figure.name + ".csv", std::move(csv)});
    set.names.push_back(figure.name);
  }
  set.files.push_back({"figures.json", figures_text(figures.figures)});
  set.files.push_back({kPlotName, std::string(kPlotPy)});
  return set;
}

}  // namespace awmr
