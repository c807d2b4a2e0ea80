// A comparison that was stopped, read back.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "awmr/compare/compare.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/core/file.h"
#include "awmr/core/json.h"
#include "awmr/core/option_text.h"

namespace awmr {
namespace {

/// What may change between a comparison and its continuation.
const std::set<std::string, std::less<>> kFreeOptions{"samples"};

/// The cells of one line as comparison_csv writes it.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) {
        cells.back() += '"';
        ++i;
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

template <class Number>
bool read_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// None where the cells are no row as comparison_csv writes it.
std::optional<ComparisonRow> row_of(const std::vector<std::string>& cells, bool with_gains) {
  constexpr std::size_t kFirst = 4;
  if (cells.size() != kFirst + kMetricColumns.size() + (with_gains ? 1 : 0)) return std::nullopt;
  ComparisonRow row;
  row.scenario = cells[0];
  const auto mode = yaw_mode_by_name(cells[1]);
  if (!mode || !read_number(cells[2], row.sample) || (cells[3] != "0" && cells[3] != "1")) {
    return std::nullopt;
  }
  row.mode = *mode;
  row.metrics.completed = cells[3] == "1";
  for (std::size_t i = 0; i < kMetricColumns.size(); ++i) {
    if (cells[kFirst + i].empty()) continue;
    double value = 0.0;
    if (!read_number(cells[kFirst + i], value)) return std::nullopt;
    kMetricColumns[i].set(row.metrics, value);
  }
  if (with_gains) row.gains = cells.back();
  return row;
}

/// Two comparisons have the same rows when their inputs and options are the same, but for the free
/// ones.
Status same_origin(const Provenance& before, const Provenance& now, const std::string& file) {
  const auto fixed = [](const Provenance& p) {
    std::vector<std::pair<std::string, std::string>> options;
    for (const auto& option : p.options) {
      if (kFreeOptions.count(option.first) == 0) options.push_back(option);
    }
    return options;
  };
  const auto same_input = [](const InputFile& a, const InputFile& b) {
    return a.name == b.name && a.sha256 == b.sha256;
  };
  if (fixed(before) != fixed(now)) {
    return input_error(file,
                       fmt::format("was made with other options ({}); resume with the same, or "
                                   "compare into another directory",
                                   option_text("seed")));
  }
  if (!std::equal(before.inputs.begin(), before.inputs.end(), now.inputs.begin(), now.inputs.end(),
                  same_input)) {
    return input_error(file,
                       "was made from other inputs (model, gains or scenarios); resume with "
                       "the same, or compare into another directory");
  }
  return {};
}

Result<Provenance> read_origin(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject json(document, path.string(), "", faults);
  Provenance origin = read_provenance(json);
  if (!faults.empty()) return input_errors(std::move(faults));
  return origin;
}

Result<std::vector<ComparisonRow>> read_rows(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(path));
  std::vector<ComparisonRow> rows;
  bool with_gains = false;
  int line = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const auto cells = cells_of(std::string_view(text).substr(start, end - start));
    start = end + 1;
    if (++line == 1) {
      with_gains = cells.back() == "gains";
      continue;
    }
    auto row = row_of(cells, with_gains);
    if (!row) {
      return input_error(fmt::format("{}:{}:1", path.string(), line),
                         "is no row of a comparison; compare into another directory");
    }
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace

Result<std::vector<ComparisonRow>> read_finished(const std::filesystem::path& directory,
                                                 const Provenance& provenance) {
  const std::filesystem::path json = directory / "comparison.json";
  AWMR_ASSIGN_OR_RETURN(const Provenance before, read_origin(json));
  AWMR_RETURN_IF_ERROR(same_origin(before, provenance, json.string()));
  return read_rows(directory / "comparison.csv");
}

}  // namespace awmr
