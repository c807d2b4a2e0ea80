/// Maps a panel's values to the page, and makes its marks. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"
#include "awmr/report/figures/ticks.h"

namespace awmr {

/// Maps values to points on the page.
struct PlotScale {
  Interval range;
  double from_pt = 0.0;  ///< position of range.lo
  double to_pt = 0.0;    ///< position of range.hi

  double operator()(double value) const {
    return from_pt + (value - range.lo) / (range.hi - range.lo) * (to_pt - from_pt);
  }
};

/// One panel on the page.
struct Plot {
  PlotScale x;
  PlotScale y;  ///< from the lower to the upper edge; the named row i is at -i
  Ticks x_ticks;
  Ticks y_ticks;
  bool is_lowest = false;  ///< lowest panel of the figure: it has the numbers and the title of x
};

/// Splits "quantity (10^{exponent} unit)" into runs.
std::vector<TextRun> axis_title(const Axis& axis, int exponent);

/// Grid lines at the ticks and the line at 0.
Layer grid_of(const Plot& plot, const Axis& x, const Axis& y);
/// Frame, ticks, numbers and titles. `title_x_pt`: position of y's title.
Layer axes_of(const Plot& plot, const Axis& x, const Axis& y, double title_x_pt);
/// An obstacle.
Disc obstacle_disc(PagePoint centre, double radius_pt);
Layer circles_of(const Plot& plot, const std::vector<FigureCircle>& circles);
Layer series_of(const Plot& plot, const Series& series);

/// Sample of a series, `width_pt` wide with its left end at `at`.
std::vector<Mark> sample_of(const Series& series, PagePoint at, double width_pt);

/// The name, shortened like "a long na…" if it is wider than `most_pt`.
std::string fitted(const std::string& name, double most_pt);

}  // namespace awmr
