#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "awmr/core/text.h"
#include "awmr/report/figures/plot.h"

namespace awmr {
namespace {

constexpr double kTickPt = 3.0;
constexpr Stroke kFrameStroke{kBlack, 0.6};
constexpr Stroke kGridStroke{kGridGrey, 0.4};
/// Vertical distance from the middle of a line of text to its base line.
constexpr double kHalfTextPt = 0.36 * kTextSizePt;

Outline straight(PagePoint from, PagePoint to, const Stroke& stroke) {
  return {.points = {from, to}, .stroke = stroke};
}

void add_x_ticks(const Plot& plot, Layer& layer) {
  const double bottom = plot.y.from_pt;
  for (const Tick& tick : plot.x_ticks.list) {
    const double x = plot.x(tick.value);
    layer.marks.emplace_back(straight({x, bottom}, {x, bottom + kTickPt}, kFrameStroke));
    if (!plot.is_lowest) continue;
    layer.marks.emplace_back(Label{.at = {x, bottom + kTickPt + kTextSizePt},
                                   .anchor = Anchor::kMiddle,
                                   .runs = {{tick.text}}});
  }
}

void add_y_label(const Plot& plot, double y, const std::string& text, Layer& layer) {
  const double left = plot.x.from_pt;
  layer.marks.emplace_back(straight({left - kTickPt, y}, {left, y}, kFrameStroke));
  layer.marks.emplace_back(Label{
      .at = {left - kTickPt - 2.0, y + kHalfTextPt}, .anchor = Anchor::kEnd, .runs = {{text}}});
}

}  // namespace

std::vector<TextRun> text_runs(const std::string& marked) {
  std::vector<TextRun> runs;
  std::size_t from = 0;
  while (from < marked.size()) {
    const std::size_t mark = std::min(marked.find("_{", from), marked.find("^{", from));
    const std::size_t end = mark == std::string::npos ? mark : marked.find('}', mark);
    if (end == std::string::npos) {
      runs.push_back({marked.substr(from)});
      break;
    }
    if (mark > from) runs.push_back({marked.substr(from, mark - from)});
    runs.push_back({marked.substr(mark + 2, end - mark - 2),
                    marked[mark] == '_' ? Shift::kIndex : Shift::kExponent});
    from = end + 1;
  }
  return runs;
}

std::vector<TextRun> axis_title(const Axis& axis, int exponent) {
  std::string unit = axis.unit;
  if (exponent != 0) {
    const std::string sign = exponent < 0 ? "\u2212" : "";
    unit = fmt::format("10^{{{}{}}}{}{}", sign, std::abs(exponent), unit.empty() ? "" : " ", unit);
  }
  return text_runs(unit.empty() ? axis.quantity : fmt::format("{} ({})", axis.quantity, unit));
}

std::string fitted(const std::string& name, double most_pt) {
  // Upper bound before any measurement: no letter is narrower than a point.
  std::string text = std::string(first_characters(name, static_cast<std::size_t>(4.0 * most_pt)));
  if (text.size() == name.size() && width_of({{text}}) <= most_pt) return text;
  while (!text.empty() && width_of({{text + "…"}}) > most_pt) {
    text = std::string(first_characters(text, text.size() - 1));
  }
  return text + "…";
}

Layer grid_of(const Plot& plot, const Axis& x, const Axis& y) {
  Layer layer{.kind = "grid"};
  const auto upright = [&](double value, const Stroke& stroke) {
    const double at = plot.x(value);
    layer.marks.emplace_back(straight({at, plot.y.from_pt}, {at, plot.y.to_pt}, stroke));
  };
  const auto level = [&](double value, const Stroke& stroke) {
    const double at = plot.y(value);
    layer.marks.emplace_back(straight({plot.x.from_pt, at}, {plot.x.to_pt, at}, stroke));
  };
  for (const Tick& tick : plot.x_ticks.list) upright(tick.value, kGridStroke);
  for (const Tick& tick : plot.y_ticks.list) level(tick.value, kGridStroke);
  if (x.zero) upright(0.0, kFrameStroke);
  if (y.zero) level(0.0, kFrameStroke);
  return layer;
}

Layer axes_of(const Plot& plot, const Axis& x, const Axis& y, double title_x_pt) {
  Layer layer{.kind = "axes"};
  const auto [left, right] = std::pair(plot.x.from_pt, plot.x.to_pt);
  const auto [bottom, top] = std::pair(plot.y.from_pt, plot.y.to_pt);
  layer.marks.emplace_back(
      Outline{.points = {{left, bottom}, {right, bottom}, {right, top}, {left, top}},
              .closed = true,
              .stroke = kFrameStroke});
  add_x_ticks(plot, layer);
  for (const Tick& tick : plot.y_ticks.list) {
    add_y_label(plot, plot.y(tick.value), tick.text, layer);
  }
  for (std::size_t row = 0; row < y.rows.size(); ++row) {
    add_y_label(plot, plot.y(-static_cast<double>(row)), y.rows[row], layer);
  }
  layer.marks.emplace_back(Label{.at = {title_x_pt, 0.5 * (bottom + top)},
                                 .anchor = Anchor::kMiddle,
                                 .upwards = true,
                                 .runs = axis_title(y, plot.y_ticks.exponent)});
  if (plot.is_lowest) {
    layer.marks.emplace_back(
        Label{.at = {0.5 * (left + right), bottom + kTickPt + 2.6 * kTextSizePt},
              .anchor = Anchor::kMiddle,
              .runs = axis_title(x, plot.x_ticks.exponent)});
  }
  return layer;
}

}  // namespace awmr
