#include "awmr/identify/tables/scrub.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "awmr/core/units.h"
#include "awmr/identify/tables/subject.h"
#include "awmr/identify/uncertainty/quantiles.h"
#include "awmr/model/fitted_law.h"

namespace awmr {
namespace {

/// Degrees of freedom of the yaw fit; those of a long record where logs fitted it.
double degrees_of_law(const Model& model) {
  constexpr double kOfALog = 1e4;
  for (const EstimatorReport& report : model.record.reports) {
    if (report.subject == FitSubject::kYaw && report.degrees_of_freedom > 0) {
      return report.degrees_of_freedom;
    }
  }
  return kOfALog;
}

/// The rates that g3 was fitted to, rad/s; none where logs alone show it.
std::optional<Interval> fitted_rates(const TrialSet<TurningRow>& turning) {
  if (turning.rows.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(
      turning.rows.begin(), turning.rows.end(),
      [](const TurningRow& a, const TurningRow& b) { return a.yaw_rate_radps < b.yaw_rate_radps; });
  return Interval{least->yaw_rate_radps, most->yaw_rate_radps};
}

/// A straight line through points, by least squares: its slope over the slope's standard error.
/// Precondition: three points or more.
double slope_t(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!(xx > 0.0)) return 0.0;
  const double slope = xy / xx;
  const double variance = std::max(yy - slope * xy, 0.0) / (n - 2.0) / xx;
  return variance > 0.0 ? slope / std::sqrt(variance) : 0.0;
}

void note(Model& model, const TrialSet<TurningRow>& turning, const char* code,
          std::string message) {
  model.record.findings.push_back(
      {turning.file, turning.by_sides.front().line, Severity::kWarning, code, std::move(message)});
}

}  // namespace

void measure_scrub(const TrialSet<TurningRow>& turning, Model& model) {
  const auto law = fitted_law(model, TrialKind::kTurning);
  if (turning.by_sides.empty() || !law) return;
  const std::vector<SteadyPoint> turns =
      turning_points(turning.by_sides, *model[ParameterId::kWheelDeadZone].value);
  if (turns.size() < kFewestScrubRows) {
    note(
        model, turning, "few-scrub-rows",
        fmt::format("{} turns by the sides' forces show no scatter, and so no interval of what the "
                    "tyres' scrub takes: drive at least {}",
                    turns.size(), kFewestScrubRows));
    return;
  }
  std::vector<double> rates, moments;
  for (const SteadyPoint& turn : turns) {
    rates.push_back(turn.rate);
    moments.push_back(turn.force - law->at(turn.rate));
  }
  const auto n = static_cast<double>(turns.size());
  const double mean = std::accumulate(moments.begin(), moments.end(), 0.0) / n;
  double squares = 0.0;
  for (const double moment : moments) squares += (moment - mean) * (moment - mean);
  const double of_scatter = squares / (n - 1.0) / n;
  const double of_law = variance_of_law(model, TrialKind::kTurning, rates);
  const double variance = of_scatter + of_law;
  if (!(variance > 0.0) || !std::isfinite(variance)) return;
  const double degrees_of_freedom =
      variance * variance /
      (of_scatter * of_scatter / (n - 1.0) + of_law * of_law / degrees_of_law(model));
  const double std_error = std::sqrt(variance);
  const double half = t_quantile_95(degrees_of_freedom) * std_error;
  const auto [slowest, fastest] = std::minmax_element(rates.begin(), rates.end());
  if (mean + half < 0.0) {
    note(model, turning, "negative-scrub",
         fmt::format(
             "the turns by the sides' forces met {:.3g} m ({:.3g} to {:.3g}) beside yaw "
             "resistance, less than nothing: tyres that are dragged sideways do not help; "
             "check the yaw rates' unit, the forces and half_track_m of these rows, and that "
             "the steered turns are not held back",
             mean, mean - half, mean + half));
    return;
  }
  model.yaw_scrub = YawScrub{.moment_m = mean,
                             .std_error_m = std_error,
                             .ci95_m = {mean - half, mean + half},
                             .rows = static_cast<int>(turns.size()),
                             .yaw_rate_radps = {*slowest, *fastest}};

  const auto range = fitted_rates(turning);
  if (range && (*fastest > kLittleFurther * range->hi || kLittleFurther * *slowest < range->lo)) {
    note(
        model, turning, "scrub-beyond-trials",
        fmt::format("the turns by the sides' forces go at {:.3g} to {:.3g} deg/s, the steered ones "
                    "at {:.3g} to {:.3g}: what the scrub takes is told against a yaw resistance "
                    "that is extrapolated there; turn both ways at the same rates",
                    degrees(*slowest), degrees(*fastest), degrees(range->lo), degrees(range->hi)));
  }
  if (std::abs(slope_t(rates, moments)) > t_quantile_95(n - 2.0)) {
    const auto [least, most] = std::minmax_element(moments.begin(), moments.end());
    note(
        model, turning, "scrub-grows",
        fmt::format("what the turns by the sides' forces meet beside yaw resistance changes with "
                    "the yaw rate, from {:.3g} to {:.3g} m: its mean {:.3g} m holds for the middle "
                    "of {:.3g} to {:.3g} deg/s",
                    *least, *most, mean, degrees(*slowest), degrees(*fastest)));
  }
}

}  // namespace awmr
