#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace awmr::cli {

Progress::Progress(std::string title, int total)
    : title_(std::move(title)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      begin_(Clock::now()),
      last_(begin_) {}

void Progress::at(int done) {
  const Clock::time_point now = Clock::now();
  using Seconds = std::chrono::duration<double>;
  const double elapsed_s = Seconds(now - begin_).count();
  if (!terminal_ || elapsed_s < 1.0 || Seconds(now - last_).count() < 0.1) return;
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int filled = kWidth * done / total_;
  const double left_s = done > 0 ? elapsed_s * (total_ - done) / done : 0.0;
  const std::string bar =
      fmt::format("\r{} [{}{}] {}/{}, {:.0f} s left ", title_, std::string(filled, '#'),
                  std::string(kWidth - filled, '.'), done, total_, left_s);
  std::fwrite(bar.data(), 1, bar.size(), stderr);
  std::fflush(stderr);
}

void Progress::finish() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace awmr::cli
