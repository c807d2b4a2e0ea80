/// What `live` tells while it records: one screen that is drawn again on a terminal, else lines.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr::cli {

/// What is known of the recording so far.
struct LiveUpdate {
  double span_s = 0.0;  ///< of the log's own time
  std::size_t rows = 0;
  std::size_t set_aside = 0;
  std::vector<Fault> faults = {};   ///< why the log could not be used as it is now
  std::optional<Model> model = {};  ///< of the last fit
  bool out_of_time = false;  ///< the fit did not end in its budget: `model` is of the one before
  std::string next = {};     ///< the manoeuvre that would help most
  double enough = 0.1;       ///< the half width that is enough
  std::vector<ParameterId> asked = {};
};

/// "surge.alpha +-0.12 %, yaw.beta -", the widest last where there are many; for exponents, which
/// have no relative width, the half interval itself.
std::string widths_text(const LiveUpdate& update);
/// "enough: ..." or what to drive next.
std::string verdict_text(const LiveUpdate& update);

class LiveScreen {
 public:
  /// `title` stands above: where it is recorded.
  explicit LiveScreen(std::string title) : title_(std::move(title)) {}
  void show(const LiveUpdate& update);
  /// A line that stays.
  void say(const std::string& line);

 private:
  void draw(const LiveUpdate& update);
  void print_lines(const LiveUpdate& update);

  std::string title_;
  std::size_t drawn_ = 0;  ///< lines on the terminal that are drawn again
  std::string faults_told_ = {};
};

}  // namespace awmr::cli
