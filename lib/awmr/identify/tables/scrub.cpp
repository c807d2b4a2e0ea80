#include "awmr/identify/tables/scrub.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "awmr/core/statistics/distributions.h"
#include "awmr/core/units.h"
#include "awmr/identify/tables/subject.h"
#include "awmr/model/fitted_law.h"

namespace awmr {
namespace {

/// Degrees of freedom of g3, the fitted yaw resistance: those of the table fit. If g3 was fitted to
/// logs: 10,000, with which Student's t is nearly the normal distribution.
double degrees_of_law(const Model& model) {
  constexpr double kOfALog = 1e4;
  for (const EstimatorReport& report : model.record.reports) {
    if (report.subject == FitSubject::kYaw && report.degrees_of_freedom > 0) {
      return report.degrees_of_freedom;
    }
  }
  return kOfALog;
}

Interval range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

/// Range of the yaw rates that g3 was fitted to, rad/s; absent if g3 is from logs only.
std::optional<Interval> fitted_rates(const TrialSet<TurningRow>& turning) {
  if (turning.rows.empty()) return std::nullopt;
  std::vector<double> rates;
  for (const TurningRow& row : turning.rows) rates.push_back(row.yaw_rate_radps);
  return range_of(rates);
}

/// Least-squares line y = mean_y + slope (x - mean_x).
struct StraightLine {
  double mean_x = 0.0, mean_y = 0.0, slope = 0.0;
  double xx = 0.0;                 ///< sum (x - mean_x)^2
  double residual_variance = 0.0;  ///< variance of the residuals, n - 2 degrees of freedom
  double count = 0.0;

  double at(double x) const { return mean_y + slope * (x - mean_x); }
  double variance_at(double x) const {
    return residual_variance * (1.0 / count + (x - mean_x) * (x - mean_x) / xx);
  }
};

/// Fits a line. Precondition: three points or more.
StraightLine line_through(const std::vector<double>& x, const std::vector<double>& y) {
  StraightLine line{.count = static_cast<double>(x.size())};
  line.mean_x = std::accumulate(x.begin(), x.end(), 0.0) / line.count;
  line.mean_y = std::accumulate(y.begin(), y.end(), 0.0) / line.count;
  double xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.xx += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    xy += (x[i] - line.mean_x) * (y[i] - line.mean_y);
    yy += (y[i] - line.mean_y) * (y[i] - line.mean_y);
  }
  if (line.xx > 0.0) line.slope = xy / line.xx;
  line.residual_variance = std::max(yy - line.slope * xy, 0.0) / (line.count - 2.0);
  return line;
}

/// True if the scrub moments y_i change with x_i (t test of the slope at 95 %). Every moment y_i is
/// the applied moment minus the fitted yaw resistance g3(r_i), so the variance of the slope
/// includes that of g3:
///   slope = sum_i w_i y_i,  w_i = (x_i - mean x)/sum (x - mean x)^2
bool is_sloped(const std::vector<double>& x, const std::vector<double>& y,
               const std::vector<double>& rates_radps, const Model& model) {
  const StraightLine line = line_through(x, y);
  if (!(line.xx > 0.0)) return false;
  std::vector<double> weights;
  for (const double one : x) weights.push_back((one - line.mean_x) / line.xx);
  const double variance = line.residual_variance / line.xx +
                          variance_of_law(model, TrialKind::kTurning, rates_radps, weights);
  return std::abs(line.slope) > t_quantile_95(line.count - 2.0) * std::sqrt(variance);
}

/// Scrub moments of the differential turns, in the order of the rows.
struct ScrubMoments {
  std::vector<double> applied_m;  ///< tau_i, the moment of the wheel forces
  std::vector<double> rates_radps;
  std::vector<double> moments_m;  ///< c_i = tau_i - g3(r_i)
};

ScrubMoments met_by(const std::vector<SteadyPoint>& turns, const Resistance<double>& law) {
  ScrubMoments met;
  for (const SteadyPoint& turn : turns) {
    met.applied_m.push_back(turn.force);
    met.rates_radps.push_back(turn.rate);
    met.moments_m.push_back(turn.force - law.at(turn.rate));
  }
  return met;
}

/// Mean scrub moment with its standard error and interval; absent if its variance is 0.
std::optional<YawScrub> mean_scrub(const ScrubMoments& met, double of_law, double degrees_of_law) {
  const auto n = static_cast<double>(met.moments_m.size());
  const double mean = std::accumulate(met.moments_m.begin(), met.moments_m.end(), 0.0) / n;
  double squares = 0.0;
  for (const double moment : met.moments_m) squares += (moment - mean) * (moment - mean);
  const double of_scatter = squares / (n - 1.0) / n;
  const double variance = of_scatter + of_law;
  if (!(variance > 0.0) || !std::isfinite(variance)) return std::nullopt;
  const double degrees_of_freedom =
      variance * variance /
      (of_scatter * of_scatter / (n - 1.0) + of_law * of_law / degrees_of_law);
  const double std_error = std::sqrt(variance);
  const double half = t_quantile_95(degrees_of_freedom) * std_error;
  return YawScrub{.moment_m = mean,
                  .std_error_m = std_error,
                  .ci95_m = {mean - half, mean + half},
                  .rows = static_cast<int>(n),
                  .yaw_rate_radps = range_of(met.rates_radps)};
}

/// Range of the scrub moment; absent unless the scrub changes with the yaw rate r. The range spans
/// the 95 % intervals of a fitted line at the slowest and at the fastest turn. The moments c_i must
/// change significantly both with r and with the applied moment tau: noise of r alone makes c fall
/// with r, and noise of tau alone makes c rise with tau.
std::optional<Interval> changing_scrub(const ScrubMoments& met, const Model& model) {
  for (const auto* over : {&met.rates_radps, &met.applied_m}) {
    if (!is_sloped(*over, met.moments_m, met.rates_radps, model)) return std::nullopt;
  }
  const StraightLine by_rate = line_through(met.rates_radps, met.moments_m);
  const double quantile = t_quantile_95(by_rate.count - 2.0);
  const Interval rates = range_of(met.rates_radps);
  std::vector<double> ends;
  for (const double rate : {rates.lo, rates.hi}) {
    const double of_law = variance_of_law(model, TrialKind::kTurning, std::span(&rate, 1));
    const double half = quantile * std::sqrt(by_rate.variance_at(rate) + of_law);
    ends.push_back(by_rate.at(rate) - half);
    ends.push_back(by_rate.at(rate) + half);
  }
  return range_of(ends);
}

/// Differential turns in which the vehicle stood still. SteadyPoint::force is the yaw moment
/// without the wheels' dead zone.
std::vector<SteadyPoint> standing_turns(const TrialSet<TurningRow>& turning, const Model& model) {
  return turning_points(turning.standing, *model[ParameterId::kWheelDeadZone].value);
}

std::optional<double> held_moment_m(const std::vector<SteadyPoint>& standing) {
  std::optional<double> most;
  for (const SteadyPoint& turn : standing) most = std::max(most.value_or(0.0), turn.force);
  return most;
}

void note(Model& model, const TrialSet<TurningRow>& turning, const char* code,
          std::string message) {
  const TurningRow& first =
      turning.by_sides.empty() ? turning.standing.front() : turning.by_sides.front();
  model.record.findings.push_back(
      {turning.file, first.line, Severity::kWarning, code, std::move(message)});
}

void note_standing(Model& model, const TrialSet<TurningRow>& turning,
                   const std::vector<SteadyPoint>& standing) {
  std::string lines;
  for (const SteadyPoint& turn : standing) {
    lines += fmt::format("{}{}", lines.empty() ? "" : ", ", turn.line);
  }
  note(model, turning, "scrub-holds",
       fmt::format(
           "the vehicle did not turn in {} of {} differential turns (line{} {}). The largest yaw "
           "moment in these turns is {:.3g} m (divided by F_max), so the tyre scrub (moment to "
           "drag the tyres sideways) is at least as large. Repeat the turns with a larger "
           "difference between the left and right forces; awmr suggest lists forces",
           standing.size(), standing.size() + turning.by_sides.size(),
           standing.size() == 1 ? "" : "s", lines, *model.yaw_held_m));
}

void note_limits(Model& model, const TrialSet<TurningRow>& turning, const ScrubMoments& met) {
  const YawScrub& scrub = *model.yaw_scrub;
  const Interval rates = scrub.yaw_rate_radps;
  const auto range = fitted_rates(turning);
  if (range && (rates.hi > kLittleFurther * range->hi || kLittleFurther * rates.lo < range->lo)) {
    note(model, turning, "scrub-beyond-trials",
         fmt::format("the differential turns are at {:.3g} to {:.3g} deg/s, the steered turns at "
                     "{:.3g} to {:.3g} deg/s. The tyre scrub is therefore computed with an "
                     "extrapolated yaw resistance; record both kinds of turns at the same yaw "
                     "rates",
                     degrees(rates.lo), degrees(rates.hi), degrees(range->lo), degrees(range->hi)));
  }
  if (scrub.changing_m) {
    const auto [slow, fast] = std::ranges::minmax_element(met.rates_radps);
    const auto slowest = static_cast<std::size_t>(slow - met.rates_radps.begin());
    const auto fastest = static_cast<std::size_t>(fast - met.rates_radps.begin());
    note(
        model, turning, "scrub-grows",
        fmt::format("the scrub moment of the tyres (divided by F_max) changes with the yaw rate: "
                    "{:.3g} to {:.3g} m in the differential turns at {:.3g} to {:.3g} deg/s. "
                    "Simulations use the mean, {:.3g} m, at every yaw rate; compare --break-even "
                    "also considers {:.3g} to {:.3g} m, the fitted line with its 95 % interval",
                    met.moments_m[slowest], met.moments_m[fastest], degrees(rates.lo),
                    degrees(rates.hi), scrub.moment_m, scrub.changing_m->lo, scrub.changing_m->hi));
  }
}

}  // namespace

void measure_scrub(const TrialSet<TurningRow>& turning, Model& model) {
  const auto law = fitted_law(model, TrialKind::kTurning);
  if ((turning.by_sides.empty() && turning.standing.empty()) || !law) return;
  const std::vector<SteadyPoint> standing = standing_turns(turning, model);
  model.yaw_held_m = held_moment_m(standing);
  if (model.yaw_held_m) note_standing(model, turning, standing);
  const std::vector<SteadyPoint> turns =
      turning_points(turning.by_sides, *model[ParameterId::kWheelDeadZone].value);
  if (turns.size() < kMinScrubRows) {
    note(model, turning, "few-scrub-rows",
         fmt::format("{} differential turns are too few for an interval of the tyre scrub; record "
                     "at least {}",
                     turns.size(), kMinScrubRows));
    return;
  }
  const ScrubMoments met = met_by(turns, *law);
  const double of_law = variance_of_law(model, TrialKind::kTurning, met.rates_radps);
  std::optional<YawScrub> scrub = mean_scrub(met, of_law, degrees_of_law(model));
  if (!scrub) return;
  if (scrub->ci95_m.hi < 0.0) {
    note(model, turning, "negative-scrub",
         fmt::format("the tyre scrub of the differential turns (yaw moment divided by F_max) is "
                     "negative, {:.3g} m (95 %: {:.3g} to {:.3g}), but tyres that are dragged "
                     "sideways cannot drive a turn; check the unit of the yaw rates, the forces of "
                     "these rows, half_track_m, and whether something brakes the steered turns",
                     scrub->moment_m, scrub->ci95_m.lo, scrub->ci95_m.hi));
    return;
  }
  scrub->changing_m = changing_scrub(met, model);
  model.yaw_scrub = scrub;
  note_limits(model, turning, met);
}

}  // namespace awmr
