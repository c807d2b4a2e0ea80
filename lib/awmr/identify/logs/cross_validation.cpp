#include "awmr/identify/logs/cross_validation.h"

#include <fmt/format.h>

#include "awmr/core/index.h"
#include "awmr/trials/prediction.h"

namespace awmr {
namespace {

std::vector<DrivingLog> without(std::vector<DrivingLog> logs, std::size_t out) {
  logs.erase(logs.begin() + eigen_index(out));
  return logs;
}

/// Prediction errors of a log by channel: "speed_mps 4.2 %, yaw_rate_radps 11.0 %".
std::string prediction_errors(const DrivingLog& log, const LogFitOptions& options,
                              const LogFit& fit) {
  double delay_s = 0.0;
  double motor_lag_s = options.vehicle.motor_time_constant_s.value_or(0.0);
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const FreeQuantity& q = fit.quantities[i];
    const double value = q.value(fit.coordinates[i]);
    if (q.kind == FreeQuantity::Kind::kDelay) delay_s = value;
    if (q.kind == FreeQuantity::Kind::kMotorLag) motor_lag_s = value;
  }
  const ParameterValues<double> values = fitted_values(options, fit);
  std::string text;
  const PredictionOptions how{
      .horizon_s = kWindow_s, .delay_s = delay_s, .motor_lag_s = motor_lag_s};
  for (const ChannelPrediction& prediction :
       predict_log(log, plant_of(options.vehicle, values), how)) {
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", info(prediction.channel).name,
                        100.0 * prediction.long_horizon.nrmse);
  }
  return text;
}

}  // namespace

CrossValidation leave_one_log_out(const std::vector<DrivingLog>& logs, LogFitOptions options) {
  options.bootstrap = 0;
  CrossValidation result;
  for (std::size_t out = 0; out < logs.size(); ++out) {
    const LogFit fit = fit_logs(without(logs, out), options);
    LeaveOneOut entry{logs[out].file, 0, {}};
    for (const EstimatorParameter& p : fit.report.parameters) entry.values.push_back(p.value);
    result.leave_one_out.push_back(entry);
    if (!fit.usable) continue;
    result.findings.push_back({logs[out].file, 0, Severity::kNote, "held-out-log",
                               fmt::format("a fit of the other logs predicts this log over windows "
                                           "of 10 s; errors relative to each signal's standard "
                                           "deviation: {}",
                                           prediction_errors(logs[out], options, fit))});
  }
  return result;
}

}  // namespace awmr
