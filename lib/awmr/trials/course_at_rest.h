/// Detects heading readings at rest of a sensor that measures the course. Private to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// A GPS gives the direction of motion as the heading. At rest there is none: the receiver repeats
/// the last one, writes 0, or noise, and jumps as soon as the vehicle moves. A compass does not jump:
/// it turns with the vehicle, on the spot too.
struct CourseAtRest {
  double rest_mps = 0.0;          ///< below this speed, the vehicle counts as at rest
  std::vector<std::size_t> rows;  ///< at rest; empty: the readings at rest are valid headings
  double jump_rad = 0.0;          ///< largest change between readings at rest, [0, pi]
};

/// `present`: the rows with a heading, rising. `speed_mps` and `heading_rad` have one value per
/// row;
/// the heading may wrap. A vehicle that was turned by hand between two drives is not reported,
/// because its headings before and after the rest differ.
CourseAtRest course_at_rest(std::span<const double> speed_mps, std::span<const double> heading_rad,
                            std::span<const std::size_t> present);

}  // namespace awmr
