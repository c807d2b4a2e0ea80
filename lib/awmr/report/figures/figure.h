/// A print figure as plain values: axes, panels and series; and the text of its files: one CSV file
/// per figure, and figures.json. Private to report/.
///
/// figures_of.h makes figures from results, and assets/plot.py draws them.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// Role of a series. It determines the style of the series in plot.py. Series are drawn in the
/// order of the roles, so that later roles are on top.
enum class Role {
  kMeasured,
  kDoubtful,  ///< measured rows with a warning
  kModel,     ///< a fitted curve
  kPredicted,
  kDifferential,
  kSteering,
  kCombined,
  kReference,
  kMinor,  ///< drawn in grey, because it is less important
};

enum class SeriesShape {
  kLine,
  kPoints,
  kBand,    ///< an area over x, filled between `low` and `high`
  kTicks,   ///< short vertical lines at x, in row y of an axis with row names
  kRanges,  ///< bar from `low` to `high` along x with a mark at x, in row y of such an axis
};

/// One series of a panel. It has a legend entry unless its name is empty.
struct Series {
  std::string name = {};
  SeriesShape shape = SeriesShape::kLine;
  Role role = Role::kMeasured;
  std::vector<double> x = {};
  std::vector<double> y = {};     ///< y of each point; empty for kBand
  std::vector<double> low = {};   ///< lower ends, for kBand and kRanges
  std::vector<double> high = {};  ///< upper ends, for kBand and kRanges
};

/// An axis: its quantity and unit, or row names. In `quantity`, `_{...}` is an index, `^{...}` an
/// exponent.
struct Axis {
  std::string quantity = {};
  std::string unit = {};  ///< empty if dimensionless
  bool zero = false;      ///< true: the range includes 0 and has a line there
  /// Row names at y = 0, 1, ... from the top. Empty for an axis with numbers.
  std::vector<std::string> rows = {};
};

struct FigureCircle {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// A panel of a figure. All panels are stacked above one x axis.
struct Panel {
  Axis y;
  std::vector<Series> series = {};
};

struct Figure {
  std::string name = {};     ///< name of the figure's file, without extension
  std::string meaning = {};  ///< one sentence for figures.json; it is not drawn
  Axis x;
  std::vector<Panel> panels = {};
  bool equal_axes = false;  ///< true: x and y have the same scale; only for a figure with one panel
  std::vector<FigureCircle> circles = {};  ///< obstacles; only for equal_axes
};

/// Text of the CSV file of a figure: one row per point with the columns panel, series (indices from
/// 0), name (of the series), x, y, low, high. Error (input): a number is not finite; the message
/// names series and figure.
Result<std::string> figure_csv(const Figure& figure);

/// Text of figures.json: names, axes, panels, and series with their shapes and roles, without the
/// numbers of the CSV files.
std::string figures_text(const std::vector<Figure>& figures);

}  // namespace awmr
