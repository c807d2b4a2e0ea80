#include "awmr/report/figures/layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/report/figures/page.h"
#include "awmr/report/figures/plot.h"

namespace awmr {
namespace {

constexpr double kBottomPt = 31.0;
constexpr double kBetweenPanelsPt = 11.0;
/// Minimum distance between two numbers of x, of y.
constexpr double kTickDistanceX = 62.0;
constexpr double kTickDistanceY = 30.0;

double height_pt(const Figure& figure) {
  const std::size_t rows = figure.panels.front().y.rows.size();
  if (rows > 0) return (22.0 + 5.5 * static_cast<double>(rows)) * kPointsPerMm;
  if (figure.equal_axes) {
    const Interval x = x_range(figure);
    const Interval y = y_range(figure, figure.panels.front());
    const double plot_pt = (kWidthPt - 2.0 * kBottomPt) * (y.hi - y.lo) / (x.hi - x.lo);
    return std::clamp(plot_pt + 2.0 * kBottomPt, 70.0 * kPointsPerMm, 150.0 * kPointsPerMm);
  }
  return (100.0 + 20.0 * static_cast<double>(figure.panels.size() - 1)) * kPointsPerMm;
}

double widest(const std::vector<Tick>& ticks) {
  double width = 0.0;
  for (const Tick& tick : ticks) width = std::max(width, width_of({{tick.text}}));
  return width;
}

/// As many ticks as there is space for their numbers.
Ticks x_ticks_in(Interval range, double length_pt) {
  for (int most = std::max(2, static_cast<int>(length_pt / kTickDistanceX));; --most) {
    Ticks ticks = ticks_in(range, most);
    const double room = length_pt / std::max(1.0, static_cast<double>(most));
    if (most == 2 || widest(ticks.list) + 8.0 < room) return ticks;
  }
}

/// Gives x and y the same scale: extends the range of the axis that has space left.
void make_axes_equal(PlotScale& x, PlotScale& y) {
  const auto per_point = [](const PlotScale& s) {
    return (s.range.hi - s.range.lo) / std::abs(s.to_pt - s.from_pt);
  };
  const double unit = std::max(per_point(x), per_point(y));
  for (PlotScale* s : {&x, &y}) {
    const double middle = 0.5 * (s->range.lo + s->range.hi);
    const double half = 0.5 * unit * std::abs(s->to_pt - s->from_pt);
    s->range = {middle - half, middle + half};
  }
}

struct Margins {
  double left_pt = 50.0;
  double right_pt = 12.0;
};

/// Distributes the panels between the margins; the top one starts at `top_pt`.
std::vector<Plot> plots_of(const Figure& figure, const Margins& margins, double top_pt) {
  const auto count = static_cast<double>(figure.panels.size());
  const double all = height_pt(figure) - kBottomPt - top_pt - (count - 1.0) * kBetweenPanelsPt;
  const double each = all / count;
  const Interval range = x_range(figure);
  std::vector<Plot> plots;
  for (const Panel& panel : figure.panels) {
    const double top = top_pt + static_cast<double>(plots.size()) * (each + kBetweenPanelsPt);
    Plot plot{.x = {range, margins.left_pt, kWidthPt - margins.right_pt},
              .y = {y_range(figure, panel), top + each, top},
              .x_ticks = {},
              .y_ticks = {},
              .is_lowest = plots.size() + 1 == figure.panels.size()};
    if (figure.equal_axes) make_axes_equal(plot.x, plot.y);
    plot.x_ticks = x_ticks_in(plot.x.range, plot.x.to_pt - plot.x.from_pt);
    const int most = std::max(2, static_cast<int>(each / kTickDistanceY));
    if (panel.y.rows.empty()) plot.y_ticks = ticks_in(plot.y.range, most);
    plots.push_back(std::move(plot));
  }
  return plots;
}

/// Left margin for title, numbers or names and ticks; right margin for half of the last number.
Margins margins_of(const Figure& figure, const std::vector<Plot>& plots) {
  double width = 0.0;
  for (const Plot& plot : plots) width = std::max(width, widest(plot.y_ticks.list));
  for (const Panel& panel : figure.panels) {
    for (const std::string& row : panel.y.rows) width = std::max(width, width_of({{row}}));
  }
  const bool has_title = !figure.panels.front().y.quantity.empty();
  return {kEdgePt + (has_title ? 1.7 * kTextSizePt : 0.0) + width + 6.0,
          std::max(12.0, 0.5 * widest(plots.back().x_ticks.list) + 2.0)};
}

int drawn_order(const Series& s) {
  if (s.shape == SeriesShape::kBand) return 0;
  return s.shape == SeriesShape::kLine ? 2 : 3;
}

void add_panel(const Figure& figure, const Panel& panel, const Plot& plot, Drawing& drawing) {
  const auto add_series = [&](int order) {
    for (const Series& s : panel.series) {
      if (drawn_order(s) == order) drawing.layers.push_back(series_of(plot, s));
    }
  };
  add_series(0);
  drawing.layers.push_back(grid_of(plot, figure.x, panel.y));
  if (!figure.circles.empty()) drawing.layers.push_back(circles_of(plot, figure.circles));
  add_series(2);
  add_series(3);
  drawing.layers.push_back(axes_of(plot, figure.x, panel.y, kEdgePt + 0.9 * kTextSizePt));
}

/// Shortens row names to two fifths of the page width.
Figure with_fitted_rows(Figure figure) {
  for (Panel& panel : figure.panels) {
    for (std::string& row : panel.y.rows) row = fitted(row, 0.4 * kWidthPt);
  }
  return figure;
}

}  // namespace

Result<Drawing> layout(const Figure& unfitted) {
  AWMR_RETURN_IF_ERROR(check_numbers(unfitted));
  const Figure figure = with_fitted_rows(unfitted);
  // The numbers determine the margins, and the margins slightly affect the positions of the
  // numbers.
  Margins margins;
  std::vector<Plot> plots;
  Legend legend;
  for (int look = 0; look < 3; ++look) {
    legend = legend_of(figure, margins.left_pt);
    plots = plots_of(figure, margins, legend.bottom_pt);
    if (look < 2) margins = margins_of(figure, plots);
  }
  Drawing drawing{figure.meaning, kWidthPt, height_pt(figure), {}};
  for (std::size_t i = 0; i < plots.size(); ++i) {
    add_panel(figure, figure.panels[i], plots[i], drawing);
  }
  drawing.layers.push_back(std::move(legend.layer));
  return drawing;
}

}  // namespace awmr
