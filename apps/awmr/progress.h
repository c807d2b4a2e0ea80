/// Progress line on the terminal for computations of more than a second.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace awmr::cli {

/// The kinds of progress display that are enabled.
struct ProgressManner {
  bool on_terminal = true;  ///< a redrawn line on a terminal; false with `--quiet`
  /// Printed lines, if stderr is no terminal; only `live` prints them. False with `--quiet` or
  /// `--json`.
  bool in_lines = true;
};
void show_progress(ProgressManner manner);

/// True if progress is drawn on a terminal: this is enabled, and stderr is a terminal.
bool draws_progress();
/// True if `live` prints lines: this is enabled, and stderr is not a terminal.
bool prints_progress_lines();
/// Prints a line on stderr, such as why the next step takes long; not with `--quiet` or `--json`.
void print_notice(std::string_view text);

/// Width of the terminal. A longer progress line would wrap and could not be redrawn.
std::size_t terminal_columns();

/// Shows a progress line at the bottom of the terminal as long as the object exists: the current
/// work and the elapsed time. If the work reports its parts, the line also shows the fraction done
/// and the time left. Otherwise it shows the longest expected duration, if that is known. If stderr
/// is not a terminal, nothing is shown. If several objects exist, only the line of the newest is
/// shown. Destroy them in reverse order: the line of the older one then appears again.
class Working {
 public:
  /// `most_s`: approximate longest duration, s; 0 if unknown.
  explicit Working(std::string what, double most_s = 0.0);
  ~Working();  ///< clears the line
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

  /// Sets the description of the current work. The count of its parts begins again.
  void doing(std::string_view what);
  /// Reports that `done` of `total` parts of the current work are done.
  void operator()(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;
  void draw_until_over();
  std::string line() const;

  std::string what_;
  double most_s_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point counted_from_ = start_;  ///< start of the current work
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread drawer_;
  /// Older object whose line this object hides; shown again when this object ends.
  const Working* covered_ = nullptr;
};

}  // namespace awmr::cli
