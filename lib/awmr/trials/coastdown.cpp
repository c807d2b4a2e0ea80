#include <fmt/format.h>

#include "awmr/core/csv.h"
#include "awmr/core/option_text.h"
#include "awmr/trials/checks/agreement.h"
#include "awmr/trials/checks/repeated_rows.h"
#include "awmr/trials/formats/read_table.h"
#include "awmr/trials/resampling/rounded_times.h"
#include "awmr/trials/trial_columns.h"
#include "rest_limits.h"
#include "trial_reader.h"

namespace awmr {
namespace {

/// Minimum number of rows of a curve: two rows determine the initial speed and the deceleration,
/// and a third row checks them.
constexpr std::size_t kShortestCurve = 3;

bool is_curve(const TrialReader& reader) { return reader.has("t_s") && reader.has("speed_mps"); }
bool is_stop_time(const TrialReader& reader) {
  return reader.has("initial_speed_mps") && reader.has("stop_time_s");
}

/// True if the file has one row per speed bin (from_mps, to_mps, elapsed_s), as road-load
/// measurements do.
bool is_binned(const TrialReader& reader) {
  return reader.has("from_mps") && reader.has("to_mps") && reader.has("elapsed_s");
}

void check_coastdown_columns(TrialReader& reader) {
  if (is_binned(reader) && (is_curve(reader) || is_stop_time(reader))) {
    reader.header_fault(
        ErrorCode::kConflict,
        fmt::format("the file has both speed bins (from_mps, to_mps, elapsed_s) and a curve or "
                    "stop times: put them into two files and give {} twice",
                    option_text("coastdown")));
    return;
  }
  if (is_curve(reader) && is_stop_time(reader)) {
    reader.header_fault(
        ErrorCode::kConflict,
        fmt::format("the file has both a curve (t_s, speed_mps) and stop times "
                    "(initial_speed_mps, stop_time_s): put them into two files and give {} twice",
                    option_text("coastdown")));
    return;
  }
  if (is_curve(reader) || is_stop_time(reader) || is_binned(reader)) return;
  if (reader.has("from_mps") || reader.has("to_mps")) {
    reader.header_fault(ErrorCode::kMissing,
                        "speed bins need from_mps, to_mps and elapsed_s; add the missing "
                        "columns");
    return;
  }
  const bool meant_curve = reader.has("t_s") || reader.has("speed_mps");
  const std::string_view stop[] = {"initial_speed_mps", "stop_time_s"};
  const std::string_view curve[] = {"t_s", "speed_mps"};
  for (const std::string_view column : meant_curve ? curve : stop) {
    if (reader.has(column)) continue;
    reader.header_fault(
        ErrorCode::kMissing,
        fmt::format("missing column {}; a coast-down has t_s and speed_mps (its curve), "
                    "initial_speed_mps and stop_time_s (a row per run), or from_mps, to_mps and "
                    "elapsed_s (a row per speed bin)",
                    column));
  }
}

TrialSet<StopTimeRow> read_stop_times(TrialReader& reader, std::vector<Finding>& findings) {
  TrialSet<StopTimeRow> set{
      .file = finding_file(reader.table()), .rows = {}, .mapped = reader.table().mapped};
  std::vector<std::size_t> set_aside;
  std::vector<std::size_t> kept;
  const double timing_s = timing_std_s(reader.last_place("stop_time_s"));
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const double speed_mps = *reader.non_negative(i, "initial_speed_mps");
    const double stop_time_s = *reader.non_negative(i, "stop_time_s");
    if (!is_rest(speed_mps, kRestSpeed_mps) && stop_time_s == 0.0) {
      reader.fault(ErrorCode::kOutOfRange, i, "stop_time_s",
                   fmt::format("found 0 with initial_speed_mps {}; give the time in which the "
                               "vehicle stopped",
                               speed_mps));
    } else if (is_rest(speed_mps, kRestSpeed_mps)) {
      set_aside.push_back(i);
    } else {
      kept.push_back(i);
      set.rows.push_back({reader.table().line(i), speed_mps, stop_time_s, timing_s});
    }
  }
  set.set_aside = static_cast<int>(set_aside.size());
  note_rows_set_aside(reader, set_aside, "a coast-down from rest does not determine mass_norm",
                      findings);
  find_repeated_rows(reader, kept,
                     {.settings = {"initial_speed_mps"}, .timed = "stop_time_s", .scatter = 0.01},
                     findings);
  return set;
}

CoastCurve new_curve(const TrialReader& reader, std::size_t row) {
  return {.file = finding_file(reader.table()),
          .line = reader.table().line(row),
          .t_s = {},
          .speed_mps = {},
          .mapped = reader.table().mapped};
}

void check_length(TrialReader& reader, const std::vector<CoastCurve>& curves) {
  for (const CoastCurve& curve : curves) {
    if (curve.t_s.size() >= kShortestCurve) continue;
    reader.faults().push_back({ErrorCode::kTooFewData,
                               fmt::format("{}:{}:1", reader.table().file, curve.line),
                               fmt::format("this coast-down has {} speeds; record at least {}",
                                           curve.t_s.size(), kShortestCurve)});
  }
}

/// Converts speed bins to curves. The speeds of a curve are the limits of its bins, the times the
/// sums of the durations. A new curve begins if `run` changes, or if a bin does not begin at the
/// speed at which the previous bin ends.
std::vector<CoastCurve> read_bins(TrialReader& reader) {
  std::vector<CoastCurve> curves;
  std::optional<double> run;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const double from_mps = *reader.non_negative(i, "from_mps");
    const double to_mps = *reader.non_negative(i, "to_mps");
    const double elapsed_s = *reader.non_negative(i, "elapsed_s");
    if (!(to_mps < from_mps) || elapsed_s == 0.0) {
      reader.fault(ErrorCode::kContradiction, i, to_mps < from_mps ? "elapsed_s" : "to_mps",
                   fmt::format("found from_mps {}, to_mps {} in {} s: to_mps must be below "
                               "from_mps, and elapsed_s above 0",
                               from_mps, to_mps, elapsed_s));
    }
    const double this_run = reader.cell(i, "run").value_or(0.0);
    if (run != this_run || curves.back().speed_mps.back() != from_mps) {
      curves.push_back(new_curve(reader, i));
      curves.back().of_bins = true;
      curves.back().t_s.push_back(0.0);
      curves.back().speed_mps.push_back(from_mps);
      run = this_run;
    }
    curves.back().t_s.push_back(curves.back().t_s.back() + elapsed_s);
    curves.back().speed_mps.push_back(to_mps);
  }
  check_length(reader, curves);
  return curves;
}

/// Reads curves. Consecutive rows with the same value of `run` are a curve; without that column the
/// file is one curve.
std::vector<CoastCurve> read_curves(TrialReader& reader, std::vector<Finding>& findings) {
  std::vector<CoastCurve> curves;
  std::optional<double> run;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const double t_s = *reader.cell(i, "t_s");
    const double this_run = reader.cell(i, "run").value_or(0.0);
    if (run != this_run) {
      curves.push_back(new_curve(reader, i));
      run = this_run;
    } else if (!(t_s > curves.back().t_s.back())) {
      reader.fault(
          ErrorCode::kWrongOrder, i, "t_s",
          fmt::format("found {} after {}: time must increase within a run; number the runs "
                      "in a column run",
                      t_s, curves.back().t_s.back()));
    }
    curves.back().t_s.push_back(t_s);
    curves.back().speed_mps.push_back(*reader.cell(i, "speed_mps"));
  }
  check_length(reader, curves);
  if (!reader.faults().empty()) return curves;
  for (CoastCurve& curve : curves) {
    replace_rounded_times(curve.t_s, curve.file, curve.line, findings);
  }
  return curves;
}

}  // namespace

Result<CoastdownSet> read_coastdown(const std::filesystem::path& path, const TrialOptions& options,
                                    std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table,
                        read_table(path, columns_of(TrialKind::kCoastdown), options));
  TrialReader reader(std::move(table), options);
  check_coastdown_columns(reader);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  note_format(reader, findings);
  CoastdownSet set;
  if (is_curve(reader)) {
    set = read_curves(reader, findings);
  } else if (is_binned(reader)) {
    set = read_bins(reader);
  } else {
    set = read_stop_times(reader, findings);
  }
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  return set;
}

}  // namespace awmr
