#include "awmr/report/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <regex>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/file.h"
#include "awmr/core/statistics/drawn_rows.h"
#include "awmr/core/units.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

/// Maximum number of rows in the page, of all runs together and of one run. A row takes about 100
/// bytes; more rows would make the page larger than its limit of 3 MB.
constexpr std::size_t kMaxRows = 20000;
constexpr std::size_t kMaxRowsOfRun = 1500;
constexpr std::size_t kMinRowsOfRun = 100;
/// Largest number of samples that a chart shows per mode and metric.
constexpr std::size_t kMaxSamples = 60;
/// Speed below which there is no sideslip angle, as for Metrics::sideslip_max_deg.
constexpr double kMovingMps = 0.05;

/// One signal of a run: its name in the page, and its values.
struct RunSignal {
  std::string name;
  std::vector<double> values;
};

std::vector<double> in_degrees(std::span<const double> radians) {
  std::vector<double> values;
  for (const double x : radians) values.push_back(degrees(x));
  return values;
}

std::vector<double> sideslip_deg(std::span<const double> u_mps, std::span<const double> v_mps) {
  std::vector<double> values;
  for (std::size_t i = 0; i < u_mps.size(); ++i) {
    const bool moving = std::hypot(u_mps[i], v_mps[i]) > kMovingMps;
    values.push_back(moving ? degrees(std::atan2(v_mps[i], std::abs(u_mps[i]))) : 0.0);
  }
  return values;
}

std::vector<RunSignal> signals_of(const CsvTable& table) {
  const auto as_is = [&](const char* name) {
    const auto column = table.column(name);
    return RunSignal{name, {column.begin(), column.end()}};
  };
  return {as_is("x_m"),
          as_is("y_m"),
          {"psi_deg", in_degrees(table.column("psi_rad"))},
          {"psi_ref_deg", in_degrees(table.column("psi_ref_rad"))},
          as_is("u_mps"),
          as_is("u_ref_mps"),
          {"r_degps", in_degrees(table.column("r_radps"))},
          as_is("force_left"),
          as_is("force_right"),
          {"steering_deg", in_degrees(table.column("steering_rad"))},
          {"steering_cmd_deg", in_degrees(table.column("steering_cmd_rad"))},
          {"sideslip_deg", sideslip_deg(table.column("u_mps"), table.column("v_mps"))}};
}

Json columns_of(const CsvTable& table, std::size_t most_rows) {
  const std::vector<RunSignal> signals = signals_of(table);
  std::vector<std::vector<double>> values;
  for (const RunSignal& signal : signals) values.push_back(signal.values);
  const auto t = table.column("t_s");
  const std::vector<std::size_t> rows = drawn_rows(t, values, kDrawnTolerance, most_rows);
  const auto picked = [&](const auto& column) {
    Json list = Json::array();
    for (const std::size_t row : rows) list.push_back(drawn_number(column[row]));
    return list;
  };
  Json columns = {{"t_s", picked(t)}};
  for (const RunSignal& signal : signals) columns[signal.name] = picked(signal.values);
  return columns;
}

/// Returns the files in a directory whose names match the pattern, sorted by name. An entry is a
/// list: the name of the file, then the text that each group of the pattern matched. Errors
/// (input): the directory cannot be read; a match is not a regular file.
Result<std::vector<std::vector<std::string>>> matching_files(const fs::path& directory,
                                                             const std::regex& pattern) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> entries, list_directory(directory));
  std::vector<std::vector<std::string>> files;
  for (const fs::path& entry : entries) {
    const std::string name = entry.filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, pattern)) continue;
    AWMR_RETURN_IF_ERROR(check_regular_file(entry));
    files.emplace_back(match.begin(), match.end());
  }
  return files;
}

/// Reduces the values to at most kMaxSamples, in ascending order and evenly spaced by rank. The
/// smallest and the largest value are included.
Json at_even_ranks(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = std::min(values.size(), kMaxSamples);
  Json list = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(
        drawn_number(values[i * (values.size() - 1) / std::max<std::size_t>(1, count - 1)]));
  }
  return list;
}

using Samples =
    std::map<std::string, std::map<std::string, std::map<std::string, std::vector<double>>>>;

Json samples_json(Samples&& samples) {
  Json json = Json::object();
  for (auto& [scenario, modes] : samples) {
    for (auto& [mode, metrics] : modes) {
      for (auto& [metric, values] : metrics) {
        json[scenario][mode][metric] = at_even_ranks(std::move(values));
      }
    }
  }
  return json;
}

}  // namespace

Result<Json> read_runs(const fs::path& directory,
                       const std::function<Result<bool>(const std::string&)>& is_own) {
  static const std::regex kPattern("run_(.+)_(differential|steering|combined)_(tuned|paper)\\.csv");
  AWMR_ASSIGN_OR_RETURN(const auto found, matching_files(directory, kPattern));
  std::vector<std::vector<std::string>> files;
  for (const std::vector<std::string>& file : found) {
    AWMR_ASSIGN_OR_RETURN(const bool is_shown, is_own(file[0]));
    if (is_shown) files.push_back(file);
  }
  if (files.empty()) return Json::array();
  const std::size_t most = std::clamp(kMaxRows / files.size(), kMinRowsOfRun, kMaxRowsOfRun);
  Json runs = Json::array();
  for (const std::vector<std::string>& file : files) {
    AWMR_ASSIGN_OR_RETURN(const CsvTable table, read_run(directory / file[0]));
    runs.push_back({{"scenario", file[1]},
                    {"mode", file[2]},
                    {"gains", file[3]},
                    {"columns", columns_of(table, most)}});
  }
  return runs;
}

Result<Json> read_scenarios(const fs::path& directory) {
  static const std::regex kPattern("scenario_(.+)\\.json");
  Json scenarios = Json::object();
  AWMR_ASSIGN_OR_RETURN(const auto files, matching_files(directory, kPattern));
  for (const std::vector<std::string>& file : files) {
    AWMR_RETURN_IF_ERROR(read_scenario(directory / file[0]));
    AWMR_ASSIGN_OR_RETURN(scenarios[file[1]], read_json_file(directory / file[0]));
  }
  return scenarios;
}

Result<Json> read_samples(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(path));
  std::string_view rest = text;
  const std::vector<std::string> names = take_text_record(rest);
  Samples samples;
  for (int line = 2; !rest.empty(); ++line) {
    const std::vector<std::string> cells = take_text_record(rest);
    if (cells.size() != names.size()) {
      return input_error(ErrorCode::kBrokenFile, fmt::format("{}:{}:1", path.string(), line),
                         fmt::format("expected {} cells, found {}; compare again (awmr compare)",
                                     names.size(), cells.size()));
    }
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    if (row["sample"] == "0") continue;
    const std::string mode =
        row["gains"].empty() ? row["mode"] : row["mode"] + " with " + row["gains"];
    for (const auto& [name, cell] : row) {
      const auto value = number_from_text(cell);
      if (value && name != "sample" && name != "completed") {
        samples[row["scenario"]][mode][name].push_back(*value);
      }
    }
  }
  return samples_json(std::move(samples));
}

}  // namespace awmr
