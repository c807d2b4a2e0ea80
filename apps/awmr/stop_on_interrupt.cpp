#include "stop_on_interrupt.h"

#include <csignal>

#include "progress.h"

namespace awmr::cli {
namespace {

std::atomic<bool> stop_requested = false;
struct sigaction before_stop = {};

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
  struct sigaction action = {};
  action.sa_handler = [](int) {
    stop_requested.store(true);
    sigaction(SIGINT, &before_stop, nullptr);
  };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, nullptr, &before_stop);
  sigaction(SIGINT, &action, nullptr);
}

StopOnInterrupt::~StopOnInterrupt() { sigaction(SIGINT, &before_stop, nullptr); }

std::atomic<bool>& StopOnInterrupt::requested() { return stop_requested; }

void end_interrupted(const std::string& notice) {
  print_notice(notice);
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
}

}  // namespace awmr::cli
