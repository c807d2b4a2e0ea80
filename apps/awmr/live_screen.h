/// Display of `awmr live`: a screen that is redrawn on a terminal, otherwise a line per update.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr::cli {

/// Interim result for the recording so far.
struct LiveUpdate {
  double span_s = 0.0;  ///< duration of the recording by its time column
  std::size_t rows = 0;
  std::size_t set_aside = 0;  ///< damaged lines
  /// Reasons why the recording cannot be used as a log yet.
  std::vector<Fault> faults = {};
  std::optional<Model> model = {};  ///< result of the last completed fit
  /// true: the last fit exceeded its time limit, so `model` is the result of an earlier fit
  bool out_of_time = false;
  /// Manoeuvre that would improve the model most; empty if the model is accurate enough.
  std::string next = {};
  /// Target precision: half width of a 95 % interval at which a parameter is known well enough.
  double enough = 0.1;
  /// Parameters whose intervals must be small enough; empty: all.
  std::vector<ParameterId> requested = {};
};

/// Returns the half widths of the 95 % intervals as text: "surge.alpha +-0.12 %, yaw.beta +-0.012".
/// The half width of an exponent is absolute, that of another parameter is relative to its value.
/// An unknown half width is "-".
std::string widths_text(const LiveUpdate& update);
/// Returns "enough: ..." if every interval is narrow enough, else the next manoeuvre to drive.
std::string verdict_text(const LiveUpdate& update);

/// Shows the updates on stderr.
class LiveScreen {
 public:
  /// `title`: first line of the screen, which names the file of the recording.
  explicit LiveScreen(std::string title) : title_(std::move(title)) {}
  void show(const LiveUpdate& update);
  /// Prints a permanent line above the screen.
  void say(const std::string& line);

 private:
  void draw(const LiveUpdate& update);
  void print_lines(const LiveUpdate& update);

  std::string title_;
  std::size_t drawn_ = 0;  ///< lines on the terminal to be redrawn
  std::string faults_told_ = {};
};

}  // namespace awmr::cli
