#include <fmt/format.h>

#include <cmath>

#include "awmr/core/csv.h"
#include "awmr/trials/checks/repeated_rows.h"
#include "awmr/trials/formats/read_table.h"
#include "awmr/trials/trial_columns.h"
#include "rest_limits.h"
#include "trial_reader.h"

namespace awmr {
namespace {

const Rate kSpeed{.printed_column = "speed_mps",
                  .amount_column = "distance_m",
                  .per_amount = 1.0,
                  .code = "speed-mismatch"};

void check_surge_columns(TrialReader& reader) {
  if (!reader.has("tau_speed") && !reader.has("wheel_force")) {
    reader.header_fault(ErrorCode::kMissing,
                        "no thrust: add a column tau_speed (sum of the wheel forces) or "
                        "wheel_force (of one wheel), divided by F_max");
  }
  if (!reader.has("speed_mps") && !(reader.has("distance_m") && reader.has("elapsed_s"))) {
    reader.header_fault(ErrorCode::kMissing,
                        "no speed: add a column speed_mps, or distance_m and elapsed_s");
  }
}

/// Returns tau_speed of a row: the value in the file, else the sum computed from the force of one
/// wheel. Adds a finding if the row has both values and they differ by more than rounding.
double tau_speed_of(TrialReader& reader, std::size_t row, int driven_wheels,
                    std::vector<Finding>& findings) {
  const auto printed = reader.non_negative(row, "tau_speed");
  const auto wheel_force = reader.non_negative(row, "wheel_force");
  if (!wheel_force) return *printed;
  // tau_speed = (F'L + F'R)(cos d_r + 1) = 4 F' at d_r = 0                             [paper (41)]
  // for four driven wheels, each with the force F', and the steering angle d_r. Two driven wheels
  // give 2 F'.
  const double from_wheels = driven_wheels * *wheel_force;
  if (!printed) return from_wheels;
  const double tolerance = reader.rounding_error(*printed, "tau_speed") +
                           driven_wheels * reader.rounding_error(*wheel_force, "wheel_force");
  if (std::abs(*printed - from_wheels) > tolerance) {
    findings.push_back(reader.finding(
        row, Severity::kWarning, "tau-speed-mismatch",
        fmt::format("tau_speed is {}, but {} x wheel_force {} is {:.4g}; the printed value {} is "
                    "used. Correct the row, or remove the column tau_speed",
                    *printed, driven_wheels, *wheel_force, from_wheels, *printed)));
  }
  return *printed;
}

}  // namespace

Result<TrialSet<SurgeRow>> read_surge(const std::filesystem::path& path,
                                      const TrialOptions& options, std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_table(path, columns_of(TrialKind::kSurge), options));
  TrialReader reader(std::move(table), options);
  check_surge_columns(reader);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  TrialSet<SurgeRow> set{finding_file(reader.table()), {}, 0, reader.table().mapped};
  set.force_column = reader.has("tau_speed") ? "tau_speed" : "wheel_force";
  note_format(reader, findings);
  std::vector<std::size_t> set_aside;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const double tau_speed = tau_speed_of(reader, i, options.driven_wheels, findings);
    const auto printed = reader.non_negative(i, "speed_mps");
    const auto speed = rate_of(reader, i, kSpeed, printed, options.preference, findings);
    if (!speed) continue;
    if (is_rest(tau_speed, kRestForce) || is_rest(speed->used, kRestSpeed_mps)) {
      set_aside.push_back(i);
      continue;
    }
    kept.push_back(i);
    set.rows.push_back(
        {reader.table().line(i), tau_speed, speed->used, speed->amount, speed->elapsed_s});
  }
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  set.set_aside = static_cast<int>(set_aside.size());
  note_rows_set_aside(reader, set_aside,
                      "a run at rest or without thrust does not determine the surge resistance "
                      "tau_speed = a1 u^b1",
                      findings);
  find_repeated_rows(
      reader, kept,
      {.settings = {"tau_speed", "wheel_force", "distance_m"}, .printed = "speed_mps"}, findings);
  return set;
}

}  // namespace awmr
