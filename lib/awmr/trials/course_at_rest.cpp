#include "course_at_rest.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/control/wrap_angle.h"
#include "awmr/core/sample_quantile.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// The vehicle counts as at rest below this speed, or below a tenth of its highest speed if that is
/// smaller.
constexpr double kRest_mps = 0.1;
double difference(double a_rad, double b_rad) { return std::abs(wrap_angle(a_rad - b_rad)); }

/// If the heading changes by more than this from one reading to the next, it is a jump of a GPS
/// course: 20 deg, or five standard deviations of such changes by the noise of the heading, if that
/// is more. Turns on the spot change the heading less. The noise is that of the moving vehicle, from
/// second differences, which a constant yaw rate does not change.
double far_rad(std::span<const double> heading_rad, std::span<const std::size_t> present,
               const auto& rests) {
  constexpr double kFar_rad = 20.0 * pi<double>() / 180.0;
  constexpr double kStandardDeviations = 5.0;
  std::vector<double> second;
  for (std::size_t i = 1; i + 1 < present.size(); ++i) {
    if (rests(present[i - 1]) || rests(present[i]) || rests(present[i + 1])) continue;
    const double middle = heading_rad[present[i]];
    second.push_back(std::abs(wrap_angle(heading_rad[present[i - 1]] - middle) +
                              wrap_angle(heading_rad[present[i + 1]] - middle)));
  }
  if (second.empty()) return kFar_rad;
  // Variances: 6 of a second difference, 2 of a change, in units of the variance of the noise.
  const double change_std = kStdPerMad * median(second) * std::sqrt(2.0 / 6.0);
  return std::max(kFar_rad, kStandardDeviations * change_std);
}

}  // namespace

CourseAtRest course_at_rest(std::span<const double> speed_mps, std::span<const double> heading_rad,
                            std::span<const std::size_t> present) {
  CourseAtRest found;
  double highest = 0.0;
  for (const std::size_t row : present) highest = std::max(highest, std::abs(speed_mps[row]));
  found.rest_mps = std::min(kRest_mps, 0.1 * highest);
  const auto rests = [&](std::size_t row) { return std::abs(speed_mps[row]) < found.rest_mps; };
  const double far = far_rad(heading_rad, present, rests);
  for (std::size_t i = 0; i < present.size();) {
    std::size_t end = i;
    while (end < present.size() && rests(present[end])) ++end;
    if (end == i) {
      ++i;
      continue;
    }
    std::optional<double> before;
    std::optional<double> after;
    if (i > 0) before = heading_rad[present[i - 1]];
    if (end < present.size()) after = heading_rad[present[end]];
    const bool was_turned = before && after && difference(*before, *after) > far;
    // Searches for the largest change between neighbouring headings, from the last heading before
    // the rest to the first one after the rest.
    for (std::size_t next = std::max<std::size_t>(i, 1); !was_turned && next <= end; ++next) {
      if (next == present.size()) break;
      const double change = difference(heading_rad[present[next - 1]], heading_rad[present[next]]);
      found.jump_rad = std::max(found.jump_rad, change);
    }
    for (; i < end; ++i) found.rows.push_back(present[i]);
  }
  if (found.jump_rad <= far) found.rows.clear();
  return found;
}

}  // namespace awmr
