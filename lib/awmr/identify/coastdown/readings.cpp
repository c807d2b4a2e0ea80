#include "awmr/identify/coastdown/readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/containers.h"
#include "awmr/trials/checks/channel_quality.h"

namespace awmr {
namespace {

/// Index of the first row with the speed 0 that begins the rest: at least half of the rows from
/// there on have the speed 0. The number of rows if there is no such row.
std::size_t first_zero(const std::vector<double>& speed_mps) {
  std::size_t first = speed_mps.size();
  std::size_t zeros = 0;
  for (std::size_t i = speed_mps.size(); i-- > 0;) {
    if (speed_mps[i] != 0.0) continue;
    ++zeros;
    if (2 * zeros >= speed_mps.size() - i) first = i;
  }
  return first;
}

/// Speed at row `end`, extrapolated by the least-squares line through the five rows before it. 0 if
/// there are fewer than five rows before. A coast-down flattens at low speed, so the true speed at
/// row `end` is higher.
double extrapolated_mps(const CoastCurve& curve, std::size_t end) {
  constexpr std::size_t kRows = 5;
  if (end < kRows) return 0.0;
  double sum_t = 0.0, sum_u = 0.0, sum_tt = 0.0, sum_tu = 0.0;
  for (std::size_t i = end - kRows; i < end; ++i) {
    const double t = curve.t_s[i] - curve.t_s[end];
    sum_t += t;
    sum_u += curve.speed_mps[i];
    sum_tt += t * t;
    sum_tu += t * curve.speed_mps[i];
  }
  constexpr auto n = static_cast<double>(kRows);
  return (sum_u * sum_tt - sum_t * sum_tu) / (n * sum_tt - sum_t * sum_t);
}

/// Cuts the curve at its first speed of 0. Returns the extrapolated speed at this row if it is
/// significantly above 0.
std::optional<double> cut_at_rest(double quantum_mps, CoastCurve& curve) {
  // Smallest extrapolated speed that counts as above 0: in standard deviations of the noise, and as
  // a share of the highest speed. A smaller speed can be due to noise or to the extrapolation.
  constexpr double kOverNoise = 5.0;
  constexpr double kShare = 0.03;
  const std::size_t end = first_zero(curve.speed_mps);
  if (end == curve.speed_mps.size()) return std::nullopt;
  const double lost_mps = extrapolated_mps(curve, end);
  curve.t_s.resize(end);
  curve.speed_mps.resize(end);
  if (end < kFewestRows) return std::nullopt;
  const double top_mps = std::ranges::max(curve.speed_mps);
  const bool is_lost =
      lost_mps > std::max({kOverNoise * noise_of(curve), kShare * top_mps, 2.0 * quantum_mps});
  return is_lost ? std::optional(lost_mps) : std::nullopt;
}

void report_cut_off(const std::vector<CoastCurve>& curves, const std::vector<double>& lost_mps,
                    std::vector<Finding>& findings) {
  if (lost_mps.empty()) return;
  findings.push_back(
      {curves.front().file, 0, Severity::kWarning, "speed-cut-off",
       fmt::format(
           "the speed of {} of {} coast-downs drops to 0 although the rows before extrapolate to "
           "up to {:.2g} m/s: the sensor reads 0 at low speed. The rows from the first speed of 0 "
           "on are not used; log a speed that is measured down to rest, e.g. with a longer timeout "
           "of the encoder",
           lost_mps.size(), curves.size(), std::ranges::max(lost_mps))});
}

/// Removes the rows of `curve` that repeat an old value of the sensor. `fresh`: for each row of all
/// curves, true if its value is new; `first`: index of the curve's first row in `fresh`. Returns
/// the curve unchanged if fewer than kFewestRows rows would remain.
CoastCurve thinned(const CoastCurve& curve, const std::vector<bool>& fresh, std::size_t first) {
  CoastCurve thin = curve;
  thin.t_s.clear();
  thin.speed_mps.clear();
  for (std::size_t i = 0; i < curve.t_s.size(); ++i) {
    if (i > 0 && !fresh[first + i]) continue;
    thin.t_s.push_back(curve.t_s[i]);
    thin.speed_mps.push_back(curve.speed_mps[i]);
  }
  return thin.t_s.size() < kFewestRows ? curve : thin;
}

/// Finds repeated values in all curves together, because a single curve has few changes of value.
ChannelQuality repeats_of(const std::vector<CoastCurve>& curves) {
  std::vector<double> values;
  for (const CoastCurve& curve : curves) {
    append(values, curve.speed_mps);
  }
  return find_repeats(values);
}

}  // namespace

CoastReadings measured_rows(const std::vector<CoastCurve>& curves, std::vector<Finding>& findings) {
  CoastReadings readings{.curves = curves};
  if (std::ranges::any_of(curves, &CoastCurve::of_bins)) return readings;
  const ChannelQuality quality = repeats_of(curves);
  if (quality.repeats == Repeats::kCoarse) readings.quantum_mps = quality.quantum;
  const bool is_held = quality.repeats == Repeats::kSlow;
  std::vector<double> lost_mps;
  std::size_t first = 0;
  std::size_t fresh = 0;
  double duration_s = 0.0;
  for (CoastCurve& curve : readings.curves) {
    const std::size_t rows = curve.t_s.size();
    if (const auto lost = cut_at_rest(readings.quantum_mps, curve)) lost_mps.push_back(*lost);
    if (!curve.t_s.empty()) duration_s += curve.t_s.back() - curve.t_s.front();
    if (is_held) curve = thinned(curve, quality.fresh, first);
    fresh += curve.t_s.size();
    first += rows;
  }
  report_cut_off(curves, lost_mps, findings);
  if (is_held) {
    findings.push_back(
        {curves.front().file, 0, Severity::kNote, "held-samples",
         fmt::format("the speed of the coast-downs repeats its value in several rows, because the "
                     "sensor is slower than the record. Nothing needs to be done: the fit uses "
                     "only the {} new values ({:.3g} Hz)",
                     fresh, static_cast<double>(fresh) / duration_s)});
  }
  return readings;
}

double noise_of(const CoastCurve& curve) {
  const std::vector<double>& t = curve.t_s;
  const std::vector<double>& u = curve.speed_mps;
  double squares = 0.0;
  for (std::size_t i = 1; i + 1 < u.size(); ++i) {
    const double w = (t[i] - t[i - 1]) / (t[i + 1] - t[i - 1]);
    const double e = u[i] - (1.0 - w) * u[i - 1] - w * u[i + 1];
    squares += e * e / (1.0 + w * w + (1.0 - w) * (1.0 - w));
  }
  return std::sqrt(squares / static_cast<double>(u.size() - 2));
}

}  // namespace awmr
