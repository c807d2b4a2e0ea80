/// A figure on paper: margins, scales, ticks, legend. Private to this folder.
#pragma once

#include "awmr/core/result.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

/// 150 mm wide; 100 mm high with one panel, 20 mm more for each further one, with named rows as
/// high as these need, and with equal axes from 70 to 150 mm, as the data are. The legend stands above the plots, so that it covers no data; every mark lies
/// within its plot. Of more than 2000 points as many as the eye tells apart (drawn_rows.h).
/// Errors (input): a series holds a number that is not finite or beyond 1e100; its name and the
/// figure's are told.
Result<Drawing> layout(const Figure& figure);

}  // namespace awmr
