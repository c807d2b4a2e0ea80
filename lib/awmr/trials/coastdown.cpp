#include <fmt/format.h>

#include "trial_reader.h"

namespace awmr {
namespace {

const CsvColumn kColumns[] = {
    {"initial_speed_mps", false}, {"stop_time_s", false}, {"t_s", false}, {"speed_mps", false}};

void check_columns(TrialReader& reader) {
  if (reader.has("initial_speed_mps") && reader.has("stop_time_s")) return;
  if (reader.has("t_s") || reader.has("speed_mps")) {
    reader.header_fault(
        "a coast-down as a curve (t_s, speed_mps) is not read by this version; give "
        "initial_speed_mps and stop_time_s, a row per run");
    return;
  }
  for (const std::string_view column : {"initial_speed_mps", "stop_time_s"}) {
    if (reader.has(column)) continue;
    reader.header_fault(
        fmt::format("missing column {}; a coast-down has initial_speed_mps and "
                    "stop_time_s, a row per run",
                    column));
  }
}

}  // namespace

Result<TrialSet<StopTimeRow>> read_coastdown(const std::filesystem::path& path,
                                             const TrialOptions& options,
                                             std::vector<Finding>& findings) {
  auto table = read_csv(path, kColumns, options.columns);
  if (!table) return tl::unexpected(table.error());
  TrialReader reader(std::move(*table), options);
  check_columns(reader);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  TrialSet<StopTimeRow> set{reader.table().file(), {}, 0};
  std::vector<std::size_t> set_aside;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const double speed_mps = *reader.non_negative(i, "initial_speed_mps");
    const double stop_time_s = *reader.non_negative(i, "stop_time_s");
    if (speed_mps > 0.0 && stop_time_s == 0.0) {
      reader.fault(i, "stop_time_s",
                   fmt::format("found 0 from initial_speed_mps {}; a moving vehicle takes time to "
                               "stop",
                               speed_mps));
    } else if (speed_mps == 0.0) {
      set_aside.push_back(i);
    } else {
      set.rows.push_back({reader.table().line(i), speed_mps, stop_time_s});
    }
  }
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  set.set_aside = static_cast<int>(set_aside.size());
  note_rows_set_aside(reader, set_aside, "a coast-down that begins at rest shows nothing of m'",
                      findings);
  return set;
}

}  // namespace awmr
