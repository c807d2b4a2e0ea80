// Writes a drawing as PDF and measures text, both with Cairo.
#include <cairo-pdf.h>
#include <cairo.h>

#include <memory>

#include "awmr/core/text.h"
#include "awmr/report/figures/drawing.h"

namespace awmr {
namespace {

struct DestroyCairo {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
using Context = std::unique_ptr<cairo_t, DestroyCairo>;
using Surface = std::unique_ptr<cairo_surface_t, DestroyCairo>;

/// A context for text on this surface. Glyphs and distances are those of the font, without hinting
/// for a screen.
Context context_on(cairo_surface_t* surface) {
  Context context(cairo_create(surface));
  const std::unique_ptr<cairo_font_options_t, DestroyCairo> options(cairo_font_options_create());
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context.get(), options.get());
  cairo_select_font_face(context.get(), kFontFamily, CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
  return context;
}

void set_size(cairo_t* c, const TextRun& run) {
  cairo_set_font_size(c, (run.shift == Shift::kNone ? 1.0 : kSmallTextShare) * kTextSizePt);
}

double width_on(cairo_t* c, const std::vector<TextRun>& runs) {
  double width = 0.0;
  for (const TextRun& run : runs) {
    set_size(c, run);
    cairo_text_extents_t extents;
    cairo_text_extents(c, printable(run.text).c_str(), &extents);
    width += extents.x_advance;
  }
  return width;
}

void set_colour(cairo_t* c, const Colour& colour) {
  cairo_set_source_rgb(c, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

/// Fills and strokes the current path, then clears it.
void paint(cairo_t* c, const std::optional<Stroke>& stroke, const std::optional<Colour>& fill) {
  if (fill) {
    set_colour(c, *fill);
    cairo_fill_preserve(c);
  }
  if (stroke) {
    set_colour(c, stroke->colour);
    cairo_set_line_width(c, stroke->width_pt);
    cairo_set_dash(c, stroke->dashes_pt.data(), static_cast<int>(stroke->dashes_pt.size()), 0.0);
    cairo_stroke_preserve(c);
  }
  cairo_new_path(c);
}

void draw(cairo_t* c, const Outline& outline) {
  for (const PagePoint& p : outline.points) cairo_line_to(c, p.x, p.y);
  if (outline.closed) cairo_close_path(c);
  paint(c, outline.stroke, outline.fill);
}

void draw(cairo_t* c, const Disc& disc) {
  constexpr double kFullTurn = 6.283185307179586;
  cairo_arc(c, disc.centre.x, disc.centre.y, disc.radius, 0.0, kFullTurn);
  cairo_close_path(c);
  paint(c, disc.stroke, disc.fill);
}

void draw(cairo_t* c, const Label& label) {
  constexpr double kQuarterTurn = 1.5707963267948966;
  cairo_save(c);
  cairo_translate(c, label.at.x, label.at.y);
  if (label.upwards) cairo_rotate(c, -kQuarterTurn);
  set_colour(c, kBlack);
  double x = 0.0;
  if (label.anchor != Anchor::kStart) {
    x = (label.anchor == Anchor::kMiddle ? -0.5 : -1.0) * width_on(c, label.runs);
  }
  for (const TextRun& run : label.runs) {
    set_size(c, run);
    cairo_move_to(c, x, lowered_pt(run.shift));
    cairo_show_text(c, printable(run.text).c_str());
    x += width_on(c, {run});
  }
  cairo_restore(c);
  cairo_new_path(c);  // text moves the current point to its end
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

double width_of(const std::vector<TextRun>& runs) {
  const Surface page(cairo_recording_surface_create(CAIRO_CONTENT_COLOR, nullptr));
  return width_on(context_on(page.get()).get(), runs);
}

Result<std::string> drawing_pdf(const Drawing& drawing) {
  std::string bytes;
  const Surface page(
      cairo_pdf_surface_create_for_stream(append, &bytes, drawing.width_pt, drawing.height_pt));
  // A date would make the bytes depend on the clock.
  cairo_pdf_surface_set_metadata(page.get(), CAIRO_PDF_METADATA_CREATE_DATE, nullptr);
  cairo_pdf_surface_set_metadata(page.get(), CAIRO_PDF_METADATA_TITLE,
                                 printable(drawing.meaning).c_str());
  cairo_status_t failed = CAIRO_STATUS_SUCCESS;
  {
    const Context context = context_on(page.get());
    cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_ROUND);
    for (const Layer& layer : drawing.layers) {
      for (const Mark& mark : layer.marks) {
        std::visit([&](const auto& one) { draw(context.get(), one); }, mark);
      }
    }
    cairo_show_page(context.get());
    failed = cairo_status(context.get());
  }
  cairo_surface_finish(page.get());
  if (failed == CAIRO_STATUS_SUCCESS) failed = cairo_surface_status(page.get());
  if (failed == CAIRO_STATUS_SUCCESS) return bytes;
  return program_fault(std::string("Cairo wrote no PDF: ") + cairo_status_to_string(failed));
}

}  // namespace awmr
