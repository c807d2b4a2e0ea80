#include "course_at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "awmr/control/wrap_angle.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

/// The vehicle counts as at rest below this speed, or below a tenth of its highest speed if that is
/// smaller.
constexpr double kRest_mps = 0.1;

/// Result of course_at_rest().
struct CourseAtRest {
  double rest_mps = 0.0;          ///< the vehicle counts as at rest below this speed
  std::vector<std::size_t> rows;  ///< rows with an invalid heading; empty: all headings are valid
  double jump_rad = 0.0;          ///< largest change between headings at rest, [0, pi]
};

double difference(double a_rad, double b_rad) { return std::abs(wrap_angle(a_rad - b_rad)); }

/// If the heading changes by more than this from one reading to the next, it is a jump of a GPS
/// course: 20 deg, or five standard deviations of such changes by the noise of the heading, if that
/// is more. Turns on the spot change the heading less. The noise is that of the moving vehicle,
/// from second differences, which a constant yaw rate does not change.
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

/// Finds the rows with an invalid heading (course_at_rest.h).
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

}  // namespace

void set_aside_course_at_rest(const DrivingLog& log, std::span<const double> speed_mps,
                              std::vector<double>& heading_rad, std::vector<std::size_t>& present,
                              std::vector<Finding>& findings) {
  const CourseAtRest found = course_at_rest(speed_mps, heading_rad, present);
  if (found.rows.empty() || found.rows.size() == present.size()) return;
  std::vector<std::size_t> kept;
  std::ranges::set_difference(present, found.rows, std::back_inserter(kept));
  present = std::move(kept);
  for (std::size_t row = 0; row < heading_rad.size(); ++row) {
    const auto next = std::ranges::lower_bound(present, row);
    heading_rad[row] = heading_rad[next != present.end() ? *next : present.back()];
  }
  findings.push_back(
      {log.file, log.line[found.rows.front()], Severity::kWarning, "course-at-rest",
       fmt::format("heading_deg: {} readings at rest (below {:.2g} m/s) jump by up to {:.0f} deg, "
                   "like the direction of motion that a GPS reports (its course). These readings "
                   "are not used; to have a heading at rest, log a compass",
                   found.rows.size(), found.rest_mps, degrees(found.jump_rad))});
}

}  // namespace awmr
