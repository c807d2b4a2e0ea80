#include "awmr/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/file.h"
#include "awmr/core/json.h"
#include "awmr/core/units.h"
#include "awmr/model/model.h"
#include "awmr/model/model_file.h"

namespace awmr {

extern const std::string_view kChartJs;
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPoints = 600;  ///< of one line in a chart

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

/// The rows of a run, as many as kMaxPoints or a part of them at even spacing; angles in degrees.
Result<Json> read_run(const fs::path& path) {
  const std::vector<CsvColumn> columns{
      {"t_s", true},        {"x_m", true},         {"y_m", true},
      {"psi_rad", true},    {"u_mps", true},       {"r_radps", true},
      {"force_left", true}, {"force_right", true}, {"steering_cmd_rad", true}};
  AWMR_ASSIGN_OR_RETURN(const CsvTable table, read_csv(path, columns));
  Json rows = Json::array();
  const std::size_t stride = 1 + table.rows() / kMaxPoints;
  const auto rounded = [](double x) { return std::stod(fmt::format("{:.5g}", x)); };
  for (std::size_t i = 0; i < table.rows(); i += stride) {
    const auto at = [&](const char* name) { return table.column(name)[i]; };
    rows.push_back({{"t_s", rounded(at("t_s"))},
                    {"x_m", rounded(at("x_m"))},
                    {"y_m", rounded(at("y_m"))},
                    {"psi_deg", rounded(degrees(at("psi_rad")))},
                    {"u_mps", rounded(at("u_mps"))},
                    {"r_degps", rounded(degrees(at("r_radps")))},
                    {"force_left", rounded(at("force_left"))},
                    {"force_right", rounded(at("force_right"))},
                    {"steering_cmd_deg", rounded(degrees(at("steering_cmd_rad")))}});
  }
  return rows;
}

/// The files `run_<scenario>_<mode>_<gains>.csv`, by name.
Result<Json> read_runs(const fs::path& directory) {
  static const std::regex kPattern("run_(.+)_(differential|steering|combined)_(tuned|paper)\\.csv");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Json runs = Json::array();
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, kPattern)) continue;
    AWMR_ASSIGN_OR_RETURN(Json rows, read_run(file));
    runs.push_back({{"scenario", match[1].str()},
                    {"mode", match[2].str()},
                    {"gains", match[3].str()},
                    {"rows", std::move(rows)}});
  }
  return runs;
}

/// comparison.csv as it is, one object a row: empty cells are metrics without meaning there.
Result<Json> read_comparison(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(path));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> result;
    std::size_t start = 0;
    while (true) {
      const std::size_t end = line.find(',', start);
      result.push_back(line.substr(start, end - start));
      if (end == std::string::npos) return result;
      start = end + 1;
    }
  };
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells(line);
  Json rows = Json::array();
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> values = cells(line);
    if (values.size() != names.size()) {
      return input_error(fmt::format("{}:{}:1", path.string(), number),
                         fmt::format("expected {} cells, found {}", names.size(), values.size()));
    }
    Json row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Each `@name@` of the page's frame, once, replaced by its part.
std::string assembled(const Json& data) {
  const std::string json = script_safe(data);
  const std::array<std::pair<std::string_view, std::string_view>, 4> parts{
      {{"css", kPageCss}, {"chart", kChartJs}, {"data", json}, {"js", kPageJs}}};
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

}  // namespace

Result<std::string> report_html(const fs::path& directory) {
  Json data;
  // Strictly first: what the page shows is a model, or the fault's place is named.
  AWMR_RETURN_IF_ERROR(read_model(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(data["model"], read_json_file(directory / "model.json"));
  for (const char* name : {"gains", "validation"}) {
    const fs::path path = directory / (std::string(name) + ".json");
    if (!fs::exists(path)) continue;
    AWMR_ASSIGN_OR_RETURN(data[name], read_json_file(path));
  }
  if (const fs::path path = directory / "comparison.csv"; fs::exists(path)) {
    AWMR_ASSIGN_OR_RETURN(Json rows, read_comparison(path));
    if (!rows.empty()) data["comparison_csv"] = std::move(rows);
  }
  AWMR_ASSIGN_OR_RETURN(data["runs"], read_runs(directory));
  return assembled(data);
}

}  // namespace awmr
