/// What a recorder sends, taken up by a thread of its own: nothing is lost while a fit runs.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "awmr/core/descriptor.h"
#include "awmr/core/result.h"

namespace awmr::cli {

/// Where the bytes come from: one of the two.
struct StreamSource {
  std::optional<std::filesystem::path> port = {};  ///< of a serial line
  unsigned baud = 115200;
  std::optional<std::filesystem::path> log = {};  ///< "-": standard input; a file may still grow
};

/// A source, opened.
struct OpenStream {
  Descriptor file;
  bool may_grow = false;  ///< at its end another program may still write more
};

/// Errors (input): it cannot be opened, is a directory or no serial port.
Result<OpenStream> open_stream(const StreamSource& source);

class RecorderStream {
 public:
  explicit RecorderStream(OpenStream source);
  ~RecorderStream();
  RecorderStream(const RecorderStream&) = delete;
  RecorderStream& operator=(const RecorderStream&) = delete;

  /// What has come since the last call, waited for up to `longest`.
  std::string take(std::chrono::milliseconds longest);
  /// No more will come.
  bool is_over();

 private:
  void read_until_over();
  void hand_over(std::string_view bytes);

  OpenStream source_;
  std::string bytes_;  ///< read and not yet taken
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> stop_ = false;
  std::thread reader_;  ///< last: it uses all of the above
};

/// While it lives, SIGINT, SIGTERM and SIGHUP (a terminal that is closed) are noted in place of ending
/// the program. After a SIGHUP further ones are ignored for good, so that the results are written: the
/// kernel and the shell each send one. One object at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  static bool came();

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace awmr::cli
