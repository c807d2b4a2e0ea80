/// What long work tells the person who waits: a line on a terminal, from the first second on.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace awmr::cli {

/// Who is told how the work goes, from now on.
struct ProgressManner {
  bool on_terminal = true;  ///< lines that are drawn and drawn again; not with `--quiet`
  bool in_lines = true;     ///< where there is no terminal, of `live`; not with `--json` either
};
void show_progress(ProgressManner manner);

/// What was asked for, where stderr can be drawn on, and where it cannot.
bool draws_progress();
bool tells_progress_in_lines();
/// A line on stderr, but not with `--quiet` or `--json`: why work that begins now takes long.
void print_notice(std::string_view text);

/// Of the terminal; longer lines would wrap, and could not be drawn again.
std::size_t terminal_columns();

/// While it lives, the terminal's last line says what is being done and for how long, and once parts
/// are told, the share done and the time left; else, where it is known, the longest that it may take. Nothing is drawn where stderr is no terminal. Of several
/// that live at once the latest is seen; they end in the opposite order.
class Working {
 public:
  /// `most_s`: about the longest that it takes, s; 0 where that is not known.
  explicit Working(std::string what, double most_s = 0.0);
  ~Working();  ///< clears the line
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

  /// What is done now; its parts, if any, are counted anew.
  void doing(std::string_view what);
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
  Clock::time_point counted_from_ = start_;  ///< the beginning of what is done now
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread drawer_;
  const Working* covered_ = nullptr;  ///< that is seen again when this one has ended
};

}  // namespace awmr::cli
