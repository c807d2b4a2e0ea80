/// Elements of a page, in points (1/72 inch) from its upper left corner: outlines, marks and text.
/// drawing_svg() and drawing_pdf() write it as SVG and as PDF. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/report/figures/pen.h"

namespace awmr {

struct PagePoint {
  double x = 0.0;
  double y = 0.0;
};

struct Stroke {
  Colour colour;
  double width_pt = 1.0;
  std::vector<double> dashes_pt = {};
};

/// Polyline through points.
struct Outline {
  std::vector<PagePoint> points = {};
  bool closed = false;
  std::optional<Stroke> stroke = {};
  std::optional<Colour> fill = {};
};

struct Disc {
  PagePoint centre;
  double radius = 0.0;
  std::optional<Stroke> stroke = {};
  std::optional<Colour> fill = {};
};

enum class Anchor { kStart, kMiddle, kEnd };
enum class Shift { kNone, kIndex, kExponent };

/// A part of a label: normal, subscript, or superscript.
struct TextRun {
  std::string text = {};
  Shift shift = Shift::kNone;
};

struct Label {
  PagePoint at;  ///< on the base line
  Anchor anchor = Anchor::kStart;
  bool upwards = false;  ///< rotated by 90 degrees to the left
  std::vector<TextRun> runs = {};
};

using Mark = std::variant<Outline, Disc, Label>;

/// Elements that belong together.
struct Layer {
  std::string kind = {};  ///< "grid", "axes", "series", "legend"
  std::string name = {};  ///< for a series
  std::vector<Mark> marks = {};
};

struct Drawing {
  std::string meaning = {};
  double width_pt = 0.0;
  double height_pt = 0.0;
  std::vector<Layer> layers = {};
};

/// The only size of text, and the size of indices and exponents relative to it.
inline constexpr double kTextSizePt = 9.0;
inline constexpr double kSmallTextShare = 0.7;
/// Vertical shift of indices (down) and exponents (up), as a fraction of the text size.
inline constexpr double kIndexShift = 0.25;
inline constexpr double kExponentShift = 0.4;
inline constexpr const char* kFontFamily = "DejaVu Sans";
/// Shift of a run below the base line, points.
inline double lowered_pt(Shift shift) {
  if (shift == Shift::kNone) return 0.0;
  return (shift == Shift::kIndex ? kIndexShift : -kExponentShift) * kTextSizePt;
}

/// Splits "tau_{speed} (10^{3} m)" into runs.
std::vector<TextRun> text_runs(const std::string& marked);

/// The same drawing gives the same bytes.
std::string drawing_svg(const Drawing& drawing);
/// One page, with embedded font and without a date. Errors (fault): out of memory.
Result<std::string> drawing_pdf(const Drawing& drawing);

/// Width of the runs as set by Cairo.
double width_of(const std::vector<TextRun>& runs);

}  // namespace awmr
