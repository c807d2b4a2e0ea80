// Writes a drawing as SVG: text stays text, in the reader's DejaVu Sans or the nearest font.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "awmr/core/text.h"
#include "awmr/report/figures/drawing.h"

namespace awmr {
namespace {

/// Formats to a hundredth of a point, without trailing zeros.
std::string in_points(double x) {
  std::string text = fmt::format("{:.2f}", x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string hex(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string painted(const std::optional<Stroke>& stroke, const std::optional<Colour>& fill) {
  std::string text = fmt::format(" fill=\"{}\"", fill ? hex(*fill) : "none");
  if (!stroke) return text;
  text += fmt::format(" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
                      hex(stroke->colour), in_points(stroke->width_pt));
  std::string dashes;
  for (const double dash : stroke->dashes_pt)
    dashes += (dashes.empty() ? "" : " ") + in_points(dash);
  if (!dashes.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", dashes);
  return text;
}

std::string element(const Outline& outline) {
  std::string points;
  for (const PagePoint& p : outline.points) {
    points += fmt::format("{}{},{}", points.empty() ? "" : " ", in_points(p.x), in_points(p.y));
  }
  return fmt::format("<{}{} points=\"{}\"/>\n", outline.closed ? "polygon" : "polyline",
                     painted(outline.stroke, outline.fill), points);
}

std::string element(const Disc& disc) {
  return fmt::format("<circle{} cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", painted(disc.stroke, disc.fill),
                     in_points(disc.centre.x), in_points(disc.centre.y), in_points(disc.radius));
}

std::string element(const Label& label) {
  static constexpr std::array<const char*, 3> kAnchors{"start", "middle", "end"};
  std::string runs;
  double reached = 0.0;
  for (const TextRun& run : label.runs) {
    const double lowered = lowered_pt(run.shift);
    if (run.shift == Shift::kNone && reached == 0.0) {
      runs += escaped(run.text);
      continue;
    }
    const double size = (run.shift == Shift::kNone ? 1.0 : kSmallTextShare) * kTextSizePt;
    runs += fmt::format("<tspan dy=\"{}\" font-size=\"{}\">{}</tspan>",
                        in_points(lowered - reached), in_points(size), escaped(run.text));
    reached = lowered;
  }
  const std::string x = in_points(label.at.x);
  const std::string y = in_points(label.at.y);
  return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     kAnchors[static_cast<std::size_t>(label.anchor)],
                     label.upwards ? fmt::format(" transform=\"rotate(-90 {} {})\"", x, y) : "",
                     runs);
}

std::string group(const Layer& layer) {
  std::string text = fmt::format("<g class=\"{}\">\n", layer.kind);
  if (!layer.name.empty()) text += fmt::format("<title>{}</title>\n", escaped(layer.name));
  for (const Mark& mark : layer.marks) {
    text += std::visit([](const auto& one) { return element(one); }, mark);
  }
  return text + "</g>\n";
}

}  // namespace

std::string drawing_svg(const Drawing& drawing) {
  const double mm_per_point = 25.4 / 72.0;
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} "
      "{}\" font-family=\"{}, Verdana, Arial, sans-serif\" font-size=\"{}\" role=\"img\">\n",
      in_points(drawing.width_pt * mm_per_point), in_points(drawing.height_pt * mm_per_point),
      in_points(drawing.width_pt), in_points(drawing.height_pt), kFontFamily,
      in_points(kTextSizePt));
  text += fmt::format("<title>{}</title>\n", escaped(drawing.meaning));
  text += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";  // for dark viewers
  for (const Layer& layer : drawing.layers) text += group(layer);
  return text + "</svg>\n";
}

}  // namespace awmr
