/// What is on a page, in points (1/72 inch) from its upper left corner: outlines, marks and text.
/// Written as SVG and as PDF by drawing_svg() and drawing_pdf(). Private to this folder.
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

/// Straight lines through points.
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

/// A part of a label: upright, smaller and lower, or smaller and higher.
struct TextRun {
  std::string text = {};
  Shift shift = Shift::kNone;
};

struct Label {
  PagePoint at;  ///< on the base line
  Anchor anchor = Anchor::kStart;
  bool upwards = false;  ///< turned left by a quarter
  std::vector<TextRun> runs = {};
};

using Mark = std::variant<Outline, Disc, Label>;

/// What belongs together.
struct Layer {
  std::string kind = {};  ///< "grid", "axes", "series", "legend"
  std::string name = {};  ///< of a series
  std::vector<Mark> marks = {};
};

struct Drawing {
  std::string meaning = {};
  double width_pt = 0.0;
  double height_pt = 0.0;
  std::vector<Layer> layers = {};
};

/// One size of text throughout, and what indices and exponents are of it.
inline constexpr double kTextSizePt = 9.0;
inline constexpr double kSmallTextShare = 0.7;
/// How far indices go down and exponents up, of the size of the text.
inline constexpr double kIndexShift = 0.25;
inline constexpr double kExponentShift = 0.4;
inline constexpr const char* kFontFamily = "DejaVu Sans";
/// How far below the base line a run stands, points.
inline double lowered_pt(Shift shift) {
  if (shift == Shift::kNone) return 0.0;
  return (shift == Shift::kIndex ? kIndexShift : -kExponentShift) * kTextSizePt;
}

/// "tau_{speed} (10^{3} m)" in parts.
std::vector<TextRun> text_runs(const std::string& marked);

/// The same bytes from the same drawing.
std::string drawing_svg(const Drawing& drawing);
/// One page, the font embedded, without a date. Errors (fault): the memory ran out.
Result<std::string> drawing_pdf(const Drawing& drawing);

/// How wide Cairo sets them.
double width_of(const std::vector<TextRun>& runs);

}  // namespace awmr
