/// Reads a recorder's data in a thread of its own, so that no data are lost during a fit.
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

#include "awmr/core/files/descriptor.h"
#include "awmr/core/result.h"

namespace awmr::cli {

/// Source of the data: exactly one of `port` and `log` is set.
struct StreamSource {
  std::optional<std::filesystem::path> port = {};  ///< a serial port
  unsigned baud = 115200;
  /// a file to which another program may append; "-": standard input
  std::optional<std::filesystem::path> log = {};
};

struct OpenStream {
  Descriptor file;
  bool may_grow = false;  ///< another program may append to the file
};

/// Errors (input): the source cannot be opened, is a directory, or is not a serial port.
Result<OpenStream> open_stream(const StreamSource& source);

/// Reads a source in a thread of its own, as long as the object exists.
class RecorderStream {
 public:
  explicit RecorderStream(OpenStream source);
  ~RecorderStream();
  RecorderStream(const RecorderStream&) = delete;
  RecorderStream& operator=(const RecorderStream&) = delete;

  /// Returns the bytes that arrived since the last call; if there are none, waits up to `longest`.
  std::string take(std::chrono::milliseconds longest);
  /// True if no more data will come.
  bool is_over();

 private:
  void read_until_over();
  void hand_over(std::string_view bytes);

  OpenStream source_;
  std::string bytes_;  ///< received but not yet taken
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> stop_ = false;
  /// Last member, because the thread uses all members above.
  std::thread reader_;
};

/// While an object exists, SIGINT, SIGTERM and SIGHUP (terminal closed) do not end the program.
/// After one of them has arrived, came() returns true. After the first SIGHUP, further SIGHUPs are
/// ignored: when a terminal closes, kernel and shell send one each, and the results must still be
/// written. Only one object may exist at a time.
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
