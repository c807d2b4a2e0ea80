/// A print figure as plain values: series and axes. Private to this folder.
///
/// The functions of figures_of.h create figures from results, figure_files.h writes them, and
/// assets/plot.py draws them.
#pragma once

#include <string>
#include <vector>

namespace awmr {

/// Role of a series, in the order of the legend. plot.py has the style of each role.
enum class Role {
  kMeasured,
  kDoubtful,  ///< measured, with a warning
  kModel,     ///< a fit
  kPredicted,
  kDifferential,
  kSteering,
  kCombined,
  kReference,
  kMinor,  ///< not relevant
};

enum class SeriesShape {
  kLine,
  kPoints,
  kBand,    ///< over x from `low` to `high`
  kTicks,   ///< short vertical lines at x in the row y of a named axis
  kRanges,  ///< at the row y of a named axis from `low` to `high` along x, a mark at x
};

/// One series of a panel. It has a legend entry unless its name is empty.
struct Series {
  std::string name = {};
  SeriesShape shape = SeriesShape::kLine;
  Role role = Role::kMeasured;
  std::vector<double> x = {};
  std::vector<double> y = {};     ///< empty for kBand
  std::vector<double> low = {};   ///< for kBand and kRanges
  std::vector<double> high = {};  ///< for kBand and kRanges
};

/// A quantity and its unit. `_{...}` is an index, `^{...}` an exponent.
struct Axis {
  std::string quantity = {};
  std::string unit = {};               ///< empty if dimensionless
  bool zero = false;                   ///< the range includes 0, with a line there
  std::vector<std::string> rows = {};  ///< names instead of numbers, from the top: 0, 1, 2, ...
};

struct FigureCircle {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// A plot; the panels of a figure are stacked over one x axis.
struct Panel {
  Axis y;
  std::vector<Series> series = {};
};

struct Figure {
  std::string name = {};     ///< of its file, without extension
  std::string meaning = {};  ///< one sentence for figures.json; it is not drawn
  Axis x;
  std::vector<Panel> panels = {};
  bool equal_axes = false;                 ///< same scale on x and y; only for one panel
  std::vector<FigureCircle> circles = {};  ///< obstacles; with equal axes
};

}  // namespace awmr
