/// Progress display of long work: one line on a terminal, shown after the first second.
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
  bool in_lines = true;     ///< lines of `live` without a terminal; false with `--quiet`, `--json`
};
void show_progress(ProgressManner manner);

/// True if progress is shown on a terminal, that is, enabled and stderr is a terminal.
bool draws_progress();
/// True if progress is printed as lines, that is, enabled and stderr is not a terminal (`live`).
bool prints_progress_lines();
/// Prints a line on stderr, such as why the next step takes long; not with `--quiet` or `--json`.
void print_notice(std::string_view text);

/// Width of the terminal; longer lines would wrap and could not be redrawn.
std::size_t terminal_columns();

/// During its lifetime the terminal's last line shows the current work and the elapsed time. With
/// reported parts it also shows the fraction done and the time left, else the longest expected
/// duration, if known. Nothing is drawn if stderr is not a terminal. Of several objects the latest
/// is displayed; they must be destroyed in reverse order.
class Working {
 public:
  /// `most_s`: approximate longest duration, s; 0 if unknown.
  explicit Working(std::string what, double most_s = 0.0);
  ~Working();  ///< clears the line
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

  /// Sets the current work and restarts the count of its parts.
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
  const Working* covered_ = nullptr;  ///< displayed again when this one ends
};

}  // namespace awmr::cli
