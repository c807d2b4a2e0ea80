/// The page that a figure is laid out on: its width, the ranges of its axes, its legend. Private to
/// this folder.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

inline constexpr double kPointsPerMm = 72.0 / 25.4;
inline constexpr double kWidthPt = 150.0 * kPointsPerMm;
inline constexpr double kEdgePt = 4.0;  ///< to the page's edge

/// Errors (input): a series holds a number that is not finite or beyond 1e100.
Status check_numbers(const Figure& figure);

/// What an axis shows: every number with a little room, around a constant a tenth of it, around 0
/// one.
Interval x_range(const Figure& figure);
Interval y_range(const Figure& figure, const Panel& panel);

struct Legend {
  Layer layer;
  double bottom_pt = 0.0;  ///< the uppermost plot may begin here
};
/// In lines from `left_pt` on. One entry alone says nothing that the axes do not, and is left out.
Legend legend_of(const Figure& figure, double left_pt);

}  // namespace awmr
