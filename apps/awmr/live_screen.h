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
  std::size_t set_aside = 0;        ///< damaged lines
  std::vector<Fault> faults = {};   ///< reasons why the log cannot be used yet
  std::optional<Model> model = {};  ///< result of the last completed fit
  bool out_of_time = false;         ///< true: the fit was too slow; `model` is the previous one
  std::string next = {};            ///< the manoeuvre that would improve the model most
  double enough = 0.1;              ///< sufficient half width of the intervals
  std::vector<ParameterId> requested = {};  ///< parameters whose intervals must be sufficient;
                                            ///< empty: all
};

/// Half widths of the 95 % intervals as text: "surge.alpha +-0.12 %, yaw.beta +-0.012", or "-" if
/// unknown. Those of exponents are absolute, others are relative to the value.
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
