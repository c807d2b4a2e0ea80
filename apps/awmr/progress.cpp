#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace awmr::cli {

ProgressBar::ProgressBar(bool shown) : shown_(shown && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::operator()(std::size_t done, std::size_t total) {
  using std::chrono::duration;
  const auto now = Clock::now();
  if (!shown_ || duration<double>(now - drawn_at_).count() < 0.1) return;
  const double passed_s = duration<double>(now - start_).count();
  if (passed_s < 1.0) return;
  drawn_at_ = now;
  drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  const double left_s = passed_s * (1.0 - share) / std::max(share, 1e-9);
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(share * kWidth);
  std::fputs(fmt::format("\r\033[K[{:=<{}}{:<{}}] {:3.0f} %  {}/{} runs  {:.0f} s left", "", filled,
                         "", kWidth - filled, 100.0 * share, done, total, left_s)
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

}  // namespace awmr::cli
