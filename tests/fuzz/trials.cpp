/// Fuzz target: reads the bytes as each kind of trial table and as a driving log. The reader
/// returns plausible values or a readable input error.
#include <cmath>
#include <vector>

#include "awmr/trials/checks/log_consistency.h"
#include "awmr/trials/load.h"
#include "awmr/trials/read_trials.h"
#include "fuzz/file_of_bytes.h"
#include "fuzz/target.h"

using awmr::fuzz::is_refused;
using awmr::fuzz::require;

namespace {

/// A vehicle similar to the paper's.
awmr::Vehicle vehicle() {
  awmr::Vehicle v;
  v.name = "fuzzed";
  v.mass_kg = 37.0;
  v.length_m = 1.32;
  v.width_m = 0.78;
  v.front_axle_m = 0.35;
  v.half_track_m = 0.36;
  v.wheel_force = {-1.0, 1.0};
  v.steering_max_deg = 20.0;
  v.steering_max_rate_degps = 300.0;
  v.steering_time_constant_s = 0.02;
  v.sample_time_s = 0.01;
  return v;
}

void check(const std::vector<awmr::Finding>& findings) {
  for (const awmr::Finding& finding : findings) {
    require(!finding.code.empty() && !finding.message.empty(),
            "a finding has a code and a message");
  }
}

void check_tables(const std::filesystem::path& path, const awmr::TrialOptions& options) {
  std::vector<awmr::Finding> findings;
  if (const auto surge = awmr::read_surge(path, options, findings); !is_refused(surge)) {
    for (const awmr::SurgeRow& row : surge->rows) {
      require(row.tau_speed > 0.0 && std::isfinite(row.tau_speed), "tau_speed > 0");
      require(row.speed_mps > 0.0 && std::isfinite(row.speed_mps), "speed > 0");
    }
  }
  if (const auto turning = awmr::read_turning(path, vehicle(), options, findings);
      !is_refused(turning)) {
    for (const auto* rows : {&turning->rows, &turning->by_sides}) {
      for (const awmr::TurningRow& row : *rows) {
        require(row.tau_turn_m > 0.0 && std::isfinite(row.tau_turn_m), "tau_turn > 0");
        require(row.yaw_rate_radps > 0.0 && std::isfinite(row.yaw_rate_radps), "yaw rate > 0");
      }
    }
    for (const awmr::TurningRow& row : turning->by_sides) {
      require(row.sides && row.sides->left < row.sides->right, "the right force is the larger one");
    }
  }
  (void)is_refused(awmr::read_coastdown(path, options, findings));
  check(findings);
}

/// Reads the bytes as all tables of one vehicle, so that the checks compare them with each other.
void check_folder(const std::filesystem::path& path) {
  for (const bool as_is : {false, true}) {
    const awmr::TrialOptions options{.columns = {}, .as_is = as_is};
    for (const awmr::TrialFiles& files :
         {awmr::TrialFiles{.surge = path, .options = options},
          awmr::TrialFiles{.turning = path, .options = options},
          awmr::TrialFiles{.surge = path, .turning = path, .options = options},
          awmr::TrialFiles{.coastdowns = {path}, .options = options}}) {
      const auto trials = awmr::load_trials(vehicle(), files);
      if (!is_refused(trials)) check(trials->findings);
    }
  }
}

void check_log(const std::filesystem::path& path, const awmr::TrialOptions& options) {
  std::vector<awmr::Finding> findings;
  const auto log = awmr::read_log(path, options, findings);
  if (is_refused(log)) return;
  require(log->rows() >= 10, "a log has rows");
  for (std::size_t i = 1; i < log->rows(); ++i) {
    require(log->t_s[i] > log->t_s[i - 1], "time increases from row to row");
  }
  for (const auto& channel : log->measured) {
    if (!channel) continue;
    require(channel->value.size() == log->rows() && channel->fresh.size() == log->rows(),
            "a channel has a value by row");
    for (const double value : channel->value) require(std::isfinite(value), "a value is finite");
  }
  (void)awmr::check_consistency(*log, "input", vehicle(), options, findings);
  check(findings);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path& path = awmr::fuzz::file_of_bytes(data, size);
  for (const awmr::Preference preference : {awmr::Preference::kPrinted, awmr::Preference::kTimed}) {
    check_tables(path, {.columns = {}, .preference = preference});
  }
  check_folder(path);
  check_log(path, {});
  return 0;
}
