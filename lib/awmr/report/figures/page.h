/// The page of a figure: its width, the ranges of its axes, its legend. Private to this folder.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

inline constexpr double kPointsPerMm = 72.0 / 25.4;
inline constexpr double kWidthPt = 150.0 * kPointsPerMm;
inline constexpr double kEdgePt = 4.0;  ///< margin to the page's edge

/// Errors (input): a series has a number that is not finite or beyond 1e100.
Status check_numbers(const Figure& figure);

/// Range of an axis: all numbers with a small margin; around a constant, a tenth of it; around 0,
/// one.
Interval x_range(const Figure& figure);
Interval y_range(const Figure& figure, const Panel& panel);

struct Legend {
  Layer layer;
  double bottom_pt = 0.0;  ///< upper limit of the top plot
};
/// Lays the entries out in lines from `left_pt` on. A single entry is omitted, because it adds
/// nothing to the axes.
Legend legend_of(const Figure& figure, double left_pt);

}  // namespace awmr
