#include "awmr/identify/logs/log_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/uncertainty/diagnostics.h"

namespace awmr {
namespace {

/// Describes the noise of each sensor: "speed_mps 0.012 m/s, 0.004 of it correlated over 0.4 s;
/// yaw_rate_radps 0.03 rad/s".
std::string in_words(const NoiseLevels& levels) {
  std::string text;
  for (const auto& [sensor, noise] : levels) {
    text += fmt::format("{}{} {:.3g} {}", text.empty() ? "" : "; ", describe(sensor), noise.std(),
                        info(sensor.channel).unit);
    if (noise.differenced > 0.0) text += fmt::format(", differenced ({:.2g})", noise.differenced);
    if (noise.drift_std > 0.0) {
      text += fmt::format(", {:.3g} of it correlated over {:.3g} s", noise.drift_std,
                          noise.correlation_s);
    }
    if (noise.second_order()) {
      text += fmt::format(" (second order, {:.3g} rad/s, damping {:.2g})", noise.frequency_radps,
                          noise.damping);
    }
  }
  return text;
}

/// Report of quantity `i`. Its 95 % interval is that of the bootstrap if there is one, else that of
/// Student's t for the coordinate. A refused quantity gets no interval.
EstimatorParameter parameter_of(const LogReportInput& input, std::size_t i) {
  const FreeQuantity& q = input.problem.model.quantities[i];
  const double x = input.solved.point.coordinates[i];
  EstimatorParameter parameter{q.name(), q.value(x), {}, {}, {}};
  if (!input.found.refusal_reason[i].empty()) return parameter;
  const double error = std::sqrt(input.found.covariance(eigen_index(i), eigen_index(i)));
  const double half = t_quantile_95(input.found.degrees_of_freedom[i]) * error;
  parameter.std_error = q.jacobian(x) * error;
  parameter.ci95 = input.bootstrap95.empty() ? Interval{q.value(x - half), q.value(x + half)}
                                             : input.bootstrap95[i];
  // A term of a family cannot be negative.
  const bool term = q.kind == FreeQuantity::Kind::kParameter && info(q.id).term;
  if (term) parameter.ci95->lo = std::max(0.0, parameter.ci95->lo);
  return parameter;
}

/// Standardised residuals of one sensor, window after window.
std::vector<double> series_of(const LogReportInput& input, const std::vector<WindowErrors>& errors,
                              const LogSensor& sensor) {
  std::vector<double> series;
  for (std::size_t w = 0; w < errors.size(); ++w) {
    const FitWindow& window = input.problem.windows[w];
    if (sensor.log != 0 && sensor.log != window.rows.log->number) continue;
    const std::vector<Sample>& samples = window.samples();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples[i].channel != sensor.channel) continue;
      series.push_back(errors[w].standardised(eigen_index(i)));
    }
  }
  return series;
}

/// Tests the residuals of each sensor for whiteness and normality. Test names end in the sensor.
std::vector<Diagnostic> residual_tests(const LogReportInput& input) {
  constexpr int kLags = 10;
  const std::vector<WindowErrors> errors = errors_at(input.problem, input.solved.point);
  std::vector<Diagnostic> tests;
  for (const auto& [sensor, noise] : input.problem.model.noise) {
    const std::vector<double> series = series_of(input, errors, sensor);
    for (auto& test : {whiteness(series, kLags), normality(series)}) {
      if (!test) continue;
      tests.push_back(*test);
      tests.back().name += " of " + describe(sensor);
    }
  }
  return tests;
}

}  // namespace

EstimatorReport log_report(const LogReportInput& input) {
  const NoiseLevels& noise = input.problem.model.noise;
  EstimatorReport report;
  report.subject = FitSubject::kLog;
  report.estimator = Estimator::kTrajectory;
  report.noise = in_words(noise);
  for (std::size_t i = 0; i < input.problem.model.quantities.size(); ++i) {
    report.parameters.push_back(parameter_of(input, i));
  }
  report.residual_std = 1.0;  // residuals are standardised
  for (const auto& [sensor, level] : noise) report.rows_used += level.count;
  report.degrees_of_freedom = report.rows_used - static_cast<int>(input.problem.unknowns());
  report.rank = input.found.rank;
  report.condition_number = input.found.condition_number;
  report.stop_reason = input.solved.stop_reason;
  report.diagnostics = residual_tests(input);
  return report;
}

void withdraw_intervals(EstimatorReport& report, std::string_view prefix) {
  for (EstimatorParameter& parameter : report.parameters) {
    if (parameter.name.starts_with(prefix)) withdraw(parameter);
  }
}

namespace {

/// Withdraws the intervals of the model parameters in `report` that are `chosen`. Returns the names
/// of these parameters.
template <class Chosen>
std::vector<std::string> withdraw_if(EstimatorReport& report, Chosen chosen) {
  std::vector<std::string> names;
  for (EstimatorParameter& mine : report.parameters) {
    if (!parameter_by_name(mine.name) || !mine.std_error || !chosen(mine)) continue;
    names.push_back(mine.name);
    withdraw(mine);
  }
  return names;
}

}  // namespace

std::vector<std::string> withdraw_of_slip(bool is_of_yaw, EstimatorReport& report) {
  return withdraw_if(report, [is_of_yaw](const EstimatorParameter& mine) {
    const std::string& name = mine.name;
    const bool is_of_turns = name.starts_with("yaw.") || name.starts_with("sway.") ||
                             name.starts_with("steering.") ||
                             name == info(ParameterId::kInertiaNorm).name;
    return is_of_yaw || !is_of_turns;
  });
}

std::vector<std::string> withdraw_different(const EstimatorReport& other, EstimatorReport& report) {
  return withdraw_if(report, [&other](const EstimatorParameter& mine) {
    const auto found = std::ranges::find(other.parameters, mine.name, &EstimatorParameter::name);
    return found != other.parameters.end() && std::abs(found->value - mine.value) > *mine.std_error;
  });
}

}  // namespace awmr
