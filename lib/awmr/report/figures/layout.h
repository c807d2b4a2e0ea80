/// Places a figure on paper: margins, scales, ticks, legend. Private to this folder.
#pragma once

#include "awmr/core/result.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

/// 150 mm wide. 100 mm high with one panel, 20 mm more for each further one. Named rows have the
/// height that they need; with equal axes, the height is 70 to 150 mm, depending on the data. The
/// legend is above the plots, so that it covers no data; every mark is within its plot. More than
/// 2000 points are reduced to the visible ones (drawn_rows.h).
/// Errors (input): a series has a number that is not finite or beyond 1e100; the message names the
/// series and the figure.
Result<Drawing> layout(const Figure& figure);

}  // namespace awmr
