/// Detects invalid headings of a GPS while the vehicle is at rest. Private to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// Result of course_at_rest(). The heading of a GPS is the direction of motion (the course). While
/// the vehicle rests, the GPS repeats the last course or writes 0 or noise, so its heading jumps
/// when the vehicle starts to move. The heading of a compass does not jump.
struct CourseAtRest {
  double rest_mps = 0.0;          ///< the vehicle counts as at rest below this speed
  std::vector<std::size_t> rows;  ///< rows with an invalid heading; empty: all headings are valid
  double jump_rad = 0.0;          ///< largest change between headings at rest, [0, pi]
};

/// Finds the rows with an invalid heading. If the heading jumps by more than 20 deg during a rest,
/// or at its beginning or end, the headings of all rows at rest are invalid. Exception: if the
/// headings before and after a rest differ by more than 20 deg, somebody may have turned the
/// vehicle by hand, so this rest does not show a jump. Instead of 20 deg, a noisy compass has five
/// standard deviations of the changes by its noise, if that is more. `present`: the rows with a heading,
/// ascending. `speed_mps` and `heading_rad` have one value per row; the heading may wrap.
CourseAtRest course_at_rest(std::span<const double> speed_mps, std::span<const double> heading_rad,
                            std::span<const std::size_t> present);

}  // namespace awmr
