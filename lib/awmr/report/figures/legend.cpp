#include <algorithm>
#include <utility>

#include "awmr/report/figures/page.h"
#include "awmr/report/figures/plot.h"

namespace awmr {
namespace {

constexpr double kLegendLinePt = 13.0;
constexpr double kSamplePt = 22.0;
constexpr double kBeforeNamePt = kSamplePt + 5.0;

/// Each series once, in the order of roles.
std::vector<Series> legend_entries(const Figure& figure, double most_pt) {
  std::vector<Series> entries;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      const bool known = std::any_of(entries.begin(), entries.end(), [&](const Series& e) {
        return e.name == s.name && e.role == s.role && e.shape == s.shape;
      });
      if (known || s.name.empty()) continue;
      entries.push_back({.name = fitted(s.name, most_pt), .shape = s.shape, .role = s.role});
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Series& a, const Series& b) { return a.role < b.role; });
  return entries;
}

/// A name, and the sample before it.
struct Entry {
  std::string name;
  std::vector<Mark> (*sample)(const Series& series, PagePoint at, double width_pt);
  Series series = {};
};

std::vector<Mark> obstacle_sample(const Series&, PagePoint at, double width_pt) {
  return {obstacle_disc({at.x + 0.5 * width_pt, at.y}, 0.4 * kTextSizePt)};
}

}  // namespace

Legend legend_of(const Figure& figure, double left_pt) {
  Legend legend{.layer = {.kind = "legend"}, .bottom_pt = kEdgePt + 0.6 * kTextSizePt};
  const double right_pt = kWidthPt - kEdgePt;
  std::vector<Entry> entries;
  for (Series& one : legend_entries(figure, right_pt - left_pt - kBeforeNamePt)) {
    entries.push_back({one.name, sample_of, std::move(one)});
  }
  if (!figure.circles.empty()) {
    entries.push_back({figure.circles.size() == 1 ? "obstacle" : "obstacles", obstacle_sample});
  }
  if (entries.size() < 2) return legend;
  double x = left_pt;
  double middle = kEdgePt + 0.5 * kLegendLinePt;
  for (const Entry& entry : entries) {
    const double width = kBeforeNamePt + width_of({{entry.name}});
    if (x > left_pt && x + width > right_pt) {
      x = left_pt;
      middle += kLegendLinePt;
    }
    for (Mark& mark : entry.sample(entry.series, {x, middle}, kSamplePt)) {
      legend.layer.marks.push_back(std::move(mark));
    }
    legend.layer.marks.emplace_back(
        Label{.at = {x + kBeforeNamePt, middle + 0.36 * kTextSizePt}, .runs = {{entry.name}}});
    x += width + 14.0;
  }
  legend.bottom_pt = middle + 0.5 * kLegendLinePt + 5.0;
  return legend;
}

}  // namespace awmr
