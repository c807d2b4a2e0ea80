/// Where a panel's values come to lie, and its marks. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/report/figures/drawing.h"
#include "awmr/report/figures/figure.h"
#include "awmr/report/figures/ticks.h"

namespace awmr {

/// From values to points on the page.
struct PlotScale {
  Interval range;
  double from_pt = 0.0;  ///< where range.lo is
  double to_pt = 0.0;    ///< where range.hi is

  double operator()(double value) const {
    return from_pt + (value - range.lo) / (range.hi - range.lo) * (to_pt - from_pt);
  }
};

/// One panel on the page.
struct Plot {
  PlotScale x;
  PlotScale y;  ///< from the lower to the upper edge; the named row i lies at -i
  Ticks x_ticks;
  Ticks y_ticks;
  bool is_lowest = false;  ///< of the figure's panels: has the numbers and the title of x
};

/// "quantity (10^{exponent} unit)" in parts.
std::vector<TextRun> axis_title(const Axis& axis, int exponent);

/// The thin lines at the ticks and the line at 0.
Layer grid_of(const Plot& plot, const Axis& x, const Axis& y);
/// Frame, ticks, numbers and titles. `title_x_pt`: where the title of y stands.
Layer axes_of(const Plot& plot, const Axis& x, const Axis& y, double title_x_pt);
/// An obstacle on the page.
Disc obstacle_disc(PagePoint centre, double radius_pt);
Layer circles_of(const Plot& plot, const std::vector<FigureCircle>& circles);
Layer series_of(const Plot& plot, const Series& series);

/// A piece of a series as it is drawn, `width_pt` wide with its left end at `at`.
std::vector<Mark> sample_of(const Series& series, PagePoint at, double width_pt);

/// "a long na…" where the name is wider than `most_pt`.
std::string fitted(const std::string& name, double most_pt);

}  // namespace awmr
