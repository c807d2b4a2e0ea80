/// A figure for print as plain values: what is drawn, over which axes. Private to this folder.
///
/// The functions of figures_of.h make them of results, layout() (layout.h) lays them out on paper.
#pragma once

#include <string>
#include <vector>

namespace awmr {

/// What a series is, in the order of the legend; how each is drawn so that it is told apart in colour, in grey and by the
/// colour-blind stands in one table (pen.h).
enum class Role {
  kMeasured,
  kDoubtful,  ///< measured, with a warning
  kModel,     ///< a fit
  kPredicted,
  kDifferential,
  kSteering,
  kCombined,
  kReference,
  kMinor,  ///< what is not told to matter
};

enum class SeriesShape {
  kLine,
  kPoints,
  kBand,    ///< over x from `low` to `high`
  kTicks,   ///< short upright lines at x in the row y of a named axis
  kRanges,  ///< at the row y of a named axis from `low` to `high` along x, a mark at x
};

/// One thing in a panel, and an entry of the legend unless its name is empty.
struct Series {
  std::string name = {};
  SeriesShape shape = SeriesShape::kLine;
  Role role = Role::kMeasured;
  std::vector<double> x = {};
  std::vector<double> y = {};     ///< of kBand empty
  std::vector<double> low = {};   ///< of kBand and kRanges
  std::vector<double> high = {};  ///< of kBand and kRanges
};

/// A quantity and its unit. `_{...}` sets an index, `^{...}` an exponent.
struct Axis {
  std::string quantity = {};
  std::string unit = {};               ///< empty where dimensionless
  bool zero = false;                   ///< 0 is within the range, with a line
  std::vector<std::string> rows = {};  ///< names in place of numbers, from the top: 0, 1, 2, ...
};

struct FigureCircle {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// A plot; those of a figure stand below each other over one x axis.
struct Panel {
  Axis y;
  std::vector<Series> series = {};
};

struct Figure {
  std::string name = {};     ///< of its files, without extension
  std::string meaning = {};  ///< one sentence for the files' descriptions; it is not drawn
  Axis x;
  std::vector<Panel> panels = {};
  bool equal_axes = false;                 ///< a metre is as long on y as on x; of one panel
  std::vector<FigureCircle> circles = {};  ///< obstacles; with equal axes
};

}  // namespace awmr
