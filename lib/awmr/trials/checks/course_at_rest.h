/// Detects invalid headings of a GPS while the vehicle is at rest. Private to trials/.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Removes the rows with an invalid heading from `present`, the rows with a heading (ascending). In
/// these rows, replaces the heading by the next valid heading. Adds the finding `course-at-rest`.
/// `speed_mps` and `heading_rad` have one value per row; the heading may wrap.
///
/// The heading of a GPS is the direction of motion (the course). While the vehicle rests, the GPS
/// repeats the last course or writes 0 or noise, so its heading jumps when the vehicle starts to
/// move. The heading of a compass does not jump. If the heading jumps by more than 20 deg during a
/// rest, or at its beginning or end, the headings of all rows at rest are invalid. Exception: if
/// the headings before and after a rest differ by more than 20 deg, somebody may have turned the
/// vehicle by hand, so this rest does not show a jump. Instead of 20 deg, a noisy compass has five
/// standard deviations of the changes by its noise, if that is more.
void set_aside_course_at_rest(const DrivingLog& log, std::span<const double> speed_mps,
                              std::vector<double>& heading_rad, std::vector<std::size_t>& present,
                              std::vector<Finding>& findings);

}  // namespace awmr
