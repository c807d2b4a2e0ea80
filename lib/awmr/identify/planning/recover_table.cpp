#include "awmr/identify/planning/recover_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"

namespace awmr {
namespace {

constexpr std::size_t kRunColumns = 2;  ///< columns before the estimates: run, refused
constexpr std::size_t kEstimateColumns = 4;

std::string head_of(std::string_view parameter) {
  return fmt::format(",{0},{0}.std_error,{0}.ci95_lo,{0}.ci95_hi", parameter);
}

/// Indices in `truths` of the parameters that at least one run has estimated. They have columns.
std::vector<std::size_t> places_in(const RecoverPart& part) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < part.truths.size(); ++i) {
    const auto gives = [i](const RecoverRun& run) { return run.estimates[i].has_value(); };
    if (std::ranges::any_of(part.runs, gives)) places.push_back(i);
  }
  return places;
}

std::string cells_of(const std::optional<RecoverEstimate>& estimate) {
  if (!estimate) return ",,,,";
  return fmt::format(",{},{},{},{}", format_number(estimate->value),
                     estimate->std_error ? format_number(*estimate->std_error) : "",
                     format_number(estimate->ci95.lo), format_number(estimate->ci95.hi));
}

/// Indices in `truths` of the parameters in the header, in order; empty if the header is invalid.
std::optional<std::vector<std::size_t>> places_of(const std::vector<std::string>& head,
                                                  const std::vector<RecoverTruth>& truths) {
  std::string line;
  for (const std::string& name : head) line += (line.empty() ? "" : ",") + name;
  std::string expected = "run,refused";
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const std::string_view name = info(truths[i].id).name;
    if (std::ranges::find(head, name) == head.end()) continue;
    expected += head_of(name);
    places.push_back(i);
  }
  return line == expected ? std::optional(places) : std::nullopt;
}

/// Reads the four cells of an estimate, which are not all empty. Returns empty if they are invalid.
std::optional<RecoverEstimate> estimate_in(std::span<const std::string> cells) {
  const auto value = number_from_text(cells[0]);
  const auto std_error = number_from_text(cells[1].empty() ? "0" : cells[1]);
  const auto lo = number_from_text(cells[2]);
  const auto hi = number_from_text(cells[3]);
  if (!value || !std_error || !lo || !hi || std::abs(*value) > kLargestEstimate ||
      *std_error < 0.0 || *std_error > kLargestEstimate || *lo > *hi) {
    return std::nullopt;
  }
  return RecoverEstimate{.value = *value,
                         .std_error = cells[1].empty() ? std::nullopt : std::optional(*std_error),
                         .ci95 = {*lo, *hi}};
}

std::optional<int> index_in(const std::string& cell) {
  int index = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), index);
  if (error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
  return index;
}

/// Reads a row. Returns empty if the cells are not a row as written by recover_csv().
std::optional<RecoverRun> run_in(const std::vector<std::string>& cells,
                                 const std::vector<std::size_t>& places, std::size_t truths) {
  if (cells.size() != kRunColumns + kEstimateColumns * places.size()) return std::nullopt;
  const std::optional<int> index = index_in(cells[0]);
  if (!index || (cells[1] != "0" && cells[1] != "1")) return std::nullopt;
  RecoverRun run{.index = *index,
                 .refused = cells[1] == "1",
                 .estimates = std::vector<std::optional<RecoverEstimate>>(truths)};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto four =
        std::span(cells).subspan(kRunColumns + kEstimateColumns * i, kEstimateColumns);
    if (std::ranges::all_of(four, [](const std::string& cell) { return cell.empty(); })) continue;
    run.estimates[places[i]] = estimate_in(four);
    if (!run.estimates[places[i]]) return std::nullopt;
  }
  return run;
}

}  // namespace

std::string recover_csv(const RecoverPart& part) {
  const std::vector<std::size_t> places = places_in(part);
  std::string text = "run,refused";
  for (const std::size_t place : places) text += head_of(info(part.truths[place].id).name);
  text += '\n';
  for (const RecoverRun& run : part.runs) {
    text += std::to_string(run.index) + (run.refused ? ",1" : ",0");
    for (const std::size_t place : places) text += cells_of(run.estimates[place]);
    text += '\n';
  }
  return text;
}

Result<std::vector<RecoverRun>> recover_runs(std::string_view text, const std::string& file,
                                             const std::vector<RecoverTruth>& truths) {
  std::string_view rest = text;
  const auto places = places_of(take_text_record(rest), truths);
  if (!places) {
    return input_error(
        ErrorCode::kStaleResult, file + ":1:1",
        "these are not the columns of a recovery.csv for this part; run the part again");
  }
  std::vector<RecoverRun> runs;
  while (!rest.empty()) {
    const std::string_view before = text.substr(0, text.size() - rest.size());
    auto run = run_in(take_text_record(rest), *places, truths.size());
    if (!run) {
      const auto line = 1 + std::count(before.begin(), before.end(), '\n');
      return input_error(ErrorCode::kStaleResult, fmt::format("{}:{}:1", file, line),
                         "is not a valid row for these columns; run the part again");
    }
    runs.push_back(std::move(*run));
  }
  return runs;
}

}  // namespace awmr
