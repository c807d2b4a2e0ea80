#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "awmr/core/option_text.h"
#include "style.h"

namespace awmr::cli {
namespace {

std::atomic<bool> drawn_on_terminal = true;
std::atomic<bool> progress_in_lines = true;
/// Working object whose progress line is on the terminal; null if there is none.
std::atomic<const Working*> seen = nullptr;

std::string duration_text(double seconds) {
  return seconds < 99.5 ? fmt::format("{:.0f} s", seconds)
                        : fmt::format("{:.0f} min", seconds / 60.0);
}

}  // namespace

void show_progress(ProgressManner manner) {
  drawn_on_terminal = manner.on_terminal;
  progress_in_lines = manner.in_lines;
}

bool draws_progress() { return drawn_on_terminal && is_terminal(stderr); }
bool prints_progress_lines() { return progress_in_lines && !is_terminal(stderr); }

void print_notice(std::string_view text) {
  if (!progress_in_lines) return;
  std::fputs((draws_progress() ? "\r\033[K" : ""), stderr);
  std::fputs(fmt::format("{}\n", spell_options(text, "--")).c_str(), stderr);
}

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

Working::Working(std::string what, double most_s)
    : what_(std::move(what)), most_s_(most_s), covered_(seen.exchange(this)) {
  if (draws_progress()) drawer_ = std::thread([this] { draw_until_over(); });
}

Working::~Working() {
  if (drawer_.joinable()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      over_ = true;
    }
    wake_.notify_one();
    drawer_.join();
  }
  seen = covered_;
}

void Working::doing(std::string_view what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  what_ = what;
  done_ = 0;
  counted_from_ = Clock::now();
}

void Working::operator()(std::size_t done, std::size_t total) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_ = std::min(done, total);
  total_ = total;
}

std::string Working::line() const {
  const auto since = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  if (done_ == 0) {
    const std::string limit =
        most_s_ > 0.0 ? fmt::format(" of about {} at most", duration_text(most_s_)) : std::string();
    return fmt::format("{} ... {}{}", what_, duration_text(since(start_)), limit);
  }
  const double passed_s = since(counted_from_);
  constexpr int kWidth = 24;
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  const int filled = static_cast<int>(share * kWidth);
  return fmt::format("{} [{:=<{}}{:<{}}] {:.0f} %, {} left", what_, "", filled, "", kWidth - filled,
                     100.0 * share, duration_text(passed_s * (1.0 - share) / share));
}

void Working::draw_until_over() {
  using namespace std::chrono_literals;
  std::unique_lock<std::mutex> lock(mutex_);
  bool drawn = false;
  for (auto pause = 1000ms; !wake_.wait_for(lock, pause, [this] { return over_; }); pause = 200ms) {
    if (seen != this) continue;
    const std::string text = line().substr(0, terminal_columns() - 1);
    std::fputs(("\r\033[K" + text).c_str(), stderr);
    std::fflush(stderr);
    drawn = true;
  }
  if (drawn) std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace awmr::cli
