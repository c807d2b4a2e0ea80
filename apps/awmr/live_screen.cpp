#include "live_screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/text.h"
#include "awmr/identify/planning/precision.h"
#include "awmr/model/transform.h"
#include "progress.h"
#include "style.h"

namespace awmr::cli {
namespace {

/// Returns the half width of an interval as text: "+-1.2 %" if it is relative to the value,
/// "+-0.012" for an exponent, "-" if it is unknown.
std::string half_width_text(const Precision& precision) {
  if (!precision.half_width) return "-";
  const double half = *precision.half_width;
  return scale_of(precision.id) == Scale::kLinear ? fmt::format("+-{:.2g}", half)
                                                  : fmt::format("+-{:.2g} %", 100.0 * half);
}

/// Returns a bar that shows the half width of an interval on a logarithmic scale. The bar is full
/// if the half width is 1 (100 %) or more, and empty if it is `enough` or less.
std::string bar_of(const Precision& precision, double enough) {
  constexpr int kWidth = 10;
  const double half = std::clamp(precision.half_width.value_or(1.0), 1e-9, 1.0);
  const double share = half <= enough ? 0.0 : 1.0 - std::log(half) / std::log(enough);
  const int filled = half <= enough ? 0 : std::clamp(static_cast<int>(share * kWidth), 1, kWidth);
  return fmt::format("[{:#<{}}{:<{}}]", "", filled, "", kWidth - filled);
}

std::string parameter_line(const Model& model, const Precision& precision, double enough) {
  const Estimate& estimate = model[precision.id];
  const std::string value = estimate.value ? fmt::format("{:.5g}", *estimate.value) : "unknown";
  const std::string interval =
      estimate.ci95 ? fmt::format("[{:.4g}, {:.4g}]", estimate.ci95->lo, estimate.ci95->hi) : "-";
  return fmt::format("  {:<24} {:>9}  {:<19} {:<8} {}", info(precision.id).name, value, interval,
                     half_width_text(precision), bar_of(precision, enough));
}

std::string progress_text(const LiveUpdate& update) {
  std::string text = fmt::format("{:.1f} s, {} rows", update.span_s, update.rows);
  if (update.set_aside > 0) text += fmt::format(", {} lines set aside", update.set_aside);
  return text;
}

std::string text_of(const Fault& fault) { return "error: " + to_text(fault, "--"); }

/// Appends the text split into lines that fit the terminal width.
void add_wrapped(std::string_view text, std::size_t columns, std::vector<std::string>& lines) {
  const std::size_t width = std::max<std::size_t>(columns, 20) - 1;
  while (!text.empty()) {
    const std::string_view line = first_characters(text, width);
    lines.emplace_back(line);
    text.remove_prefix(line.size());
  }
}

void print_to_stderr(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string widths_text(const LiveUpdate& update) {
  if (!update.model) return "no parameter is estimated yet";
  std::string text;
  for (const Precision& precision : precision_of(*update.model, update.requested)) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", info(precision.id).name,
                        half_width_text(precision));
  }
  return text;
}

std::string verdict_text(const LiveUpdate& update) {
  if (!update.model) return "drive on: no parameter is estimated yet";
  if (is_enough(precision_of(*update.model, update.requested), update.enough)) {
    return fmt::format("enough: every half width is within {:g} %", 100.0 * update.enough);
  }
  const char* const delay_note =
      update.out_of_time
          ? " (the last fit exceeded --budget; these results are of the previous fit)"
          : "";
  return (update.next.empty() ? "drive on" : "next: " + update.next) + delay_note;
}

void LiveScreen::show(const LiveUpdate& update) {
  if (draws_progress()) {
    draw(update);
  } else if (prints_progress_lines()) {
    print_lines(update);
  }
}

void LiveScreen::say(const std::string& line) {
  if (draws_progress() || prints_progress_lines()) print_to_stderr(line + "\n");
}

void LiveScreen::draw(const LiveUpdate& update) {
  const std::size_t columns = terminal_columns();
  std::vector<std::string> lines;
  add_wrapped(fmt::format("{}: {}; Ctrl-C ends", title_, progress_text(update)), columns, lines);
  for (const Fault& fault : shown_faults(update.faults)) {
    add_wrapped(text_of(fault), columns, lines);
  }
  if (update.model) {
    for (const Precision& precision : precision_of(*update.model, update.requested)) {
      const std::string line = parameter_line(*update.model, precision, update.enough);
      lines.emplace_back(first_characters(line, columns - 1));
    }
  }
  add_wrapped(verdict_text(update), columns, lines);
  const Style style(stderr);
  std::string text = drawn_ > 0 ? fmt::format("\r\033[{}A", drawn_) : "";
  for (const std::string& line : lines) {
    const bool alarm = line.starts_with("error: ");
    text += (alarm ? style.error(line) : line) + "\033[K\n";
  }
  print_to_stderr(text + "\033[J");
  drawn_ = lines.size();
}

/// Prints one line for an update; before it the faults, if they have changed.
void LiveScreen::print_lines(const LiveUpdate& update) {
  std::string faults;
  for (const Fault& fault : shown_faults(update.faults)) faults += text_of(fault) + "\n";
  if (faults != faults_told_) print_to_stderr(faults);
  faults_told_ = faults;
  print_to_stderr(fmt::format("{}: {}; {}\n", progress_text(update), widths_text(update),
                              verdict_text(update)));
}

}  // namespace awmr::cli
