#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "awmr/core/drawn_rows.h"
#include "awmr/report/figures/plot.h"

namespace awmr {
namespace {

constexpr std::size_t kMostMarks = 2000;
constexpr double kMarkRadiusPt = 2.2;

Stroke stroke_of(const Pen& pen) { return {pen.colour, pen.width_pt, pen.dashes_pt}; }

Mark marker_at(const Pen& pen, PagePoint at) {
  const double r = kMarkRadiusPt;
  if (pen.marker == Marker::kDiamond) {
    const double d = 1.4 * r;
    return Outline{
        .points = {{at.x - d, at.y}, {at.x, at.y - d}, {at.x + d, at.y}, {at.x, at.y + d}},
        .closed = true,
        .stroke = Stroke{pen.colour, 1.0},
        .fill = Colour{255, 255, 255}};
  }
  if (pen.marker == Marker::kSquare) {
    return Outline{.points = {{at.x - r, at.y - r},
                              {at.x + r, at.y - r},
                              {at.x + r, at.y + r},
                              {at.x - r, at.y + r}},
                   .closed = true,
                   .stroke = Stroke{pen.colour, 1.0},
                   .fill = Colour{255, 255, 255}};
  }
  return Disc{.centre = at, .radius = r, .fill = pen.colour};
}

/// The points to draw: all, or the most visible ones if there are very many.
std::vector<std::size_t> drawn_points(const Series& series) {
  std::vector<std::size_t> order(series.x.size());
  std::iota(order.begin(), order.end(), 0);
  if (order.size() <= kMostMarks) return order;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return series.x[a] < series.x[b]; });
  std::vector<double> x;
  std::vector<std::vector<double>> y(1);
  for (const std::size_t i : order) {
    x.push_back(series.x[i]);
    y[0].push_back(series.y[i]);
  }
  std::vector<std::size_t> drawn = drawn_rows(x, y, kDrawnTolerance, kMostMarks);
  for (std::size_t& row : drawn) row = order[row];
  return drawn;
}

void add_band(const Plot& plot, const Series& series, Layer& layer) {
  Outline area{.closed = true, .fill = pen_of(series.role).band};
  const std::size_t count = series.x.size();
  for (std::size_t i = 0; i < count; ++i) {
    area.points.push_back({plot.x(series.x[i]), plot.y(series.high[i])});
  }
  for (std::size_t i = count; i-- > 0;) {
    area.points.push_back({plot.x(series.x[i]), plot.y(series.low[i])});
  }
  layer.marks.emplace_back(std::move(area));
}

void add_ticks(const Plot& plot, const Series& series, Layer& layer) {
  constexpr double kHalfPt = 4.0;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double x = plot.x(series.x[i]);
    const double y = plot.y(-series.y[i]);
    layer.marks.emplace_back(Outline{.points = {{x, y - kHalfPt}, {x, y + kHalfPt}},
                                     .stroke = Stroke{pen_of(series.role).colour, 0.5}});
  }
}

void add_ranges(const Plot& plot, const Series& series, Layer& layer) {
  const Pen& pen = pen_of(series.role);
  constexpr double kEndPt = 2.5;
  const Stroke stroke{pen.colour, 1.2};
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double y = plot.y(-series.y[i]);
    const auto [low, high] = std::pair(plot.x(series.low[i]), plot.x(series.high[i]));
    if (high > low) {
      layer.marks.emplace_back(Outline{.points = {{low, y}, {high, y}}, .stroke = stroke});
      for (const double end : {low, high}) {
        layer.marks.emplace_back(
            Outline{.points = {{end, y - kEndPt}, {end, y + kEndPt}}, .stroke = stroke});
      }
    }
    layer.marks.push_back(marker_at(pen, {plot.x(series.x[i]), y}));
  }
}

}  // namespace

Layer series_of(const Plot& plot, const Series& series) {
  Layer layer{.kind = "series", .name = series.name};
  const Pen& pen = pen_of(series.role);
  switch (series.shape) {
    case SeriesShape::kLine: {
      Outline line{.stroke = stroke_of(pen)};
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        line.points.push_back({plot.x(series.x[i]), plot.y(series.y[i])});
      }
      layer.marks.emplace_back(std::move(line));
      break;
    }
    case SeriesShape::kPoints:
      for (const std::size_t i : drawn_points(series)) {
        layer.marks.push_back(marker_at(pen, {plot.x(series.x[i]), plot.y(series.y[i])}));
      }
      break;
    case SeriesShape::kBand:
      add_band(plot, series, layer);
      break;
    case SeriesShape::kTicks:
      add_ticks(plot, series, layer);
      break;
    case SeriesShape::kRanges:
      add_ranges(plot, series, layer);
      break;
  }
  return layer;
}

Disc obstacle_disc(PagePoint centre, double radius_pt) {
  return {
      .centre = centre, .radius = radius_pt, .stroke = Stroke{kBlack, 0.6}, .fill = kObstacleGrey};
}

Layer circles_of(const Plot& plot, const std::vector<FigureCircle>& circles) {
  Layer layer{.kind = "circles"};
  for (const FigureCircle& circle : circles) {
    const double radius = std::abs(plot.x(circle.x + circle.radius) - plot.x(circle.x));
    layer.marks.emplace_back(obstacle_disc({plot.x(circle.x), plot.y(circle.y)}, radius));
  }
  return layer;
}

std::vector<Mark> sample_of(const Series& series, PagePoint at, double width_pt) {
  // A series of two points on a plot as wide as the sample.
  Series piece = series;
  piece.x = {0.0, 1.0};
  piece.y = {0.0, 0.0};
  piece.low = {-0.5, -0.5};
  piece.high = {0.5, 0.5};
  const bool is_long = series.shape == SeriesShape::kLine || series.shape == SeriesShape::kBand;
  if (!is_long) piece.x = {0.5};
  if (series.shape == SeriesShape::kRanges) {
    piece.low = {0.0};
    piece.high = {1.0};
  }
  const Plot plot{.x = {{0.0, 1.0}, at.x, at.x + width_pt},
                  .y = {{-0.5, 0.5}, at.y + 0.4 * kTextSizePt, at.y - 0.4 * kTextSizePt},
                  .x_ticks = {},
                  .y_ticks = {}};
  return series_of(plot, piece).marks;
}

}  // namespace awmr
