#include "awmr/identify/logs/checks/log_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "awmr/identify/admissible.h"
#include "awmr/identify/logs/log_report.h"
#include "awmr/model/plausibility.h"

namespace awmr {
namespace {

/// I'z/m' of real vehicles, divided by that of a uniform box.
constexpr Interval kUsual{0.3, 2.0};

/// Names a unit of the speed column that would explain a too large ratio I'z/m' of yaw inertia to
/// mass. Reason: if the logged speed is k times the true speed, the fitted m' is 1/k of the true
/// m', and I'z/m' is k times the true ratio. Empty if I'z/m' is not too large, or if the logs have
/// positions, because another check has compared these with the speed.
std::string speed_unit_hint(const std::vector<DrivingLog>& logs, double inertia_over_box) {
  const bool is_compared = std::ranges::all_of(
      logs, [](const DrivingLog& log) { return log[LogChannel::kX] || !log[LogChannel::kSpeed]; });
  if (is_compared || inertia_over_box < kInertiaOverBox.hi) return "";
  struct Unit {
    double factor;
    std::string_view name;
  };
  for (const Unit& unit : {Unit{3.6, "km/h"}, Unit{100.0, "cm/s"}, Unit{1000.0, "mm/s"}}) {
    if (!kUsual.contains(inertia_over_box / unit.factor)) continue;
    return fmt::format(" (if speed_mps is in {}, the factor is {:.2g})", unit.name,
                       inertia_over_box / unit.factor);
  }
  return " (speed_mps may be a rate of rotation of the wheels: multiply it by their radius)";
}

/// Estimate of a parameter from the log fit, else from other trials. Null if neither has a value.
const Estimate* estimate_of(const Model& model, const LogStage& stage, ParameterId id) {
  const auto found = std::ranges::find(stage.main, id, &LogStage::Main::id);
  if (found != stage.main.end()) return &found->estimate;
  return model[id].value ? &model[id] : nullptr;
}

/// Warns of a ratio I'z/m' (yaw inertia to mass) that is possible, but unusual: a unit or a size
/// may be wrong.
void note_unusual_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                          const Model& model, LogStage& stage) {
  const Estimate* inertia = estimate_of(model, stage, ParameterId::kInertiaNorm);
  const Estimate* mass = estimate_of(model, stage, ParameterId::kMassNorm);
  if (inertia == nullptr || mass == nullptr) return;
  const Interval range = inertia_over_vehicle(vehicle, *inertia, *mass);
  if (range.lo < kUsual.hi && range.hi > kUsual.lo) return;
  stage.findings.push_back(
      {logs.front().file, 0, Severity::kWarning, "inertia-mismatch",
       fmt::format("the fitted ratio of yaw inertia to mass, I'z/m', is {:.3g} times Iz/m of the "
                   "vehicle file; {:g} to {:g} times is usual. Check the units of the speed and "
                   "the yaw rate, and the size of the vehicle",
                   inertia_over_vehicle(vehicle, *inertia->value, *mass->value), kUsual.lo,
                   kUsual.hi)});
}

/// Reason why the fitted I'z is impossible or not determined; empty if it is plausible.
std::string why_no_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                           const Model& model, const LogStage& stage) {
  const Estimate* inertia = estimate_of(model, stage, ParameterId::kInertiaNorm);
  if (inertia == nullptr) return {};
  const Estimate* mass = estimate_of(model, stage, ParameterId::kMassNorm);
  if (mass == nullptr) {
    return stage.reasons.contains(ParameterId::kMassNorm) &&
                   std::ranges::none_of(logs, has_force_difference)
               ? "m' is not determined and only the steering turned the vehicle, so I'z is not "
                 "determined either"
               : "";
  }
  const Interval range = inertia_over_vehicle(vehicle, *inertia, *mass);
  if (range.hi > kInertiaOverBox.lo && range.lo < kInertiaOverBox.hi) return {};
  const double times = inertia_over_vehicle(vehicle, *inertia->value, *mass->value);
  return fmt::format(
      "the fitted ratio of yaw inertia to mass, I'z/m', is {:.3g} times Iz/m of the vehicle "
      "file. No distribution of mass within its size can give this: a unit or a sign is wrong{}, "
      "or a moment outside the model turns the vehicle",
      times, speed_unit_hint(logs, times));
}

/// True if a wheel force acts while the wheels are steered, so that it turns the vehicle.
bool has_steered_force(const DrivingLog& log) {
  constexpr double kMuch = 0.01;  // smallest lateral force that counts, over F_max
  const std::vector<double>& angle = log.driving_steering_rad();
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const double force = log.force_left[row] + log.force_right[row];
    if (std::abs(force * std::sin(angle[row])) > kMuch) return true;
  }
  return false;
}

bool is_turned(const std::vector<DrivingLog>& logs) {
  return std::ranges::any_of(logs, [](const DrivingLog& log) {
    return has_force_difference(log) || has_steered_force(log);
  });
}

}  // namespace

void check_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const Model& model,
                   LogStage& stage) {
  std::string why = why_no_inertia(vehicle, logs, model, stage);
  if (why.empty()) return note_unusual_inertia(vehicle, logs, model, stage);
  // If no command makes a yaw moment, the yaw motion contains no information about m'.
  const bool turned = is_turned(logs);
  if (!turned) why = "no command turns the vehicle";
  stage.reasons[ParameterId::kInertiaNorm] = why;
  if (turned && !stage.reasons.contains(ParameterId::kMassNorm)) {
    stage.findings.push_back({logs.front().file, 0, Severity::kWarning, "inertia-mismatch",
                              why + ". The intervals are withdrawn; check the units of the speed, "
                                    "the yaw rate and the forces, and the size of the vehicle"});
    withdraw_intervals(stage.reports[stage.chosen_report]);
    for (LogStage::Main& value : stage.main) withdraw_uncertainty(value.estimate);
  }
  std::erase_if(stage.main,
                [](const LogStage::Main& value) { return value.id == ParameterId::kInertiaNorm; });
}

}  // namespace awmr
