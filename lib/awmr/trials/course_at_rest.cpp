#include "course_at_rest.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/control/wrap_angle.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// The vehicle counts as at rest below this speed, or below a tenth of its highest speed if that is
/// smaller.
constexpr double kRest_mps = 0.1;
/// If the heading changes by more than this from one reading to the next, it is a jump of a GPS
/// course. Noise and turns on the spot change the heading less between two readings.
constexpr double kFar_rad = 20.0 * pi<double>() / 180.0;

double difference(double a_rad, double b_rad) { return std::abs(wrap_angle(a_rad - b_rad)); }

}  // namespace

CourseAtRest course_at_rest(std::span<const double> speed_mps, std::span<const double> heading_rad,
                            std::span<const std::size_t> present) {
  CourseAtRest found;
  double highest = 0.0;
  for (const std::size_t row : present) highest = std::max(highest, std::abs(speed_mps[row]));
  found.rest_mps = std::min(kRest_mps, 0.1 * highest);
  const auto rests = [&](std::size_t row) { return std::abs(speed_mps[row]) < found.rest_mps; };
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
    const bool was_turned = before && after && difference(*before, *after) > kFar_rad;
    // Searches for the largest change between neighbouring headings, from the last heading before
    // the rest to the first one after the rest.
    for (std::size_t next = std::max<std::size_t>(i, 1); !was_turned && next <= end; ++next) {
      if (next == present.size()) break;
      const double change = difference(heading_rad[present[next - 1]], heading_rad[present[next]]);
      found.jump_rad = std::max(found.jump_rad, change);
    }
    for (; i < end; ++i) found.rows.push_back(present[i]);
  }
  if (found.jump_rad <= kFar_rad) found.rows.clear();
  return found;
}

}  // namespace awmr
