#include "live_stream.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include "awmr/core/files/serial_port.h"

namespace awmr::cli {
namespace {

using namespace std::chrono_literals;

/// Interval, ms, at which the thread checks whether it must stop or the file has grown.
constexpr int kPause_ms = 50;
/// Largest number of bytes that may wait for take(). When it is reached, the thread stops reading,
/// and the program that writes into a pipe has to wait.
constexpr std::size_t kMaxAhead = std::size_t{1} << 24U;

bool is_regular(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

/// True if another program made the file shorter than the part that was already read.
bool became_shorter(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && status.st_size < ::lseek(file, 0, SEEK_CUR);
}

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free,
              "a signal handler sets this variable, so it must be lock-free");
volatile std::sig_atomic_t hung_up = 0;
extern "C" void note_interruption(int signal) {
  interrupted = true;
  if (signal == SIGHUP) hung_up = 1;
}

}  // namespace

Result<OpenStream> open_stream(const StreamSource& source) {
  if (source.port) {
    AWMR_ASSIGN_OR_RETURN(Descriptor port, open_serial_port(*source.port, source.baud));
    return OpenStream{std::move(port)};
  }
  const std::string name = source.log->string();
  if (name == "-") {
    Descriptor input(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0));
    if (input.number() < 0) {
      return input_error(ErrorCode::kCannotRead, "--log -",
                         "standard input is closed; pipe the recorder's data into awmr live");
    }
    return OpenStream{std::move(input)};
  }
  // With O_NONBLOCK, opening a pipe does not wait for its writer, so that Ctrl-C works.
  Descriptor file(::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    return input_error(ErrorCode::kCannotRead, name,
                       std::string("cannot open the file: ") + std::strerror(errno));
  }
  std::error_code error;
  if (std::filesystem::is_directory(name, error)) {
    return input_error(ErrorCode::kWrongFile, name,
                       "this is a directory; give the file that the recorder writes");
  }
  const bool may_grow = is_regular(file.number());
  return OpenStream{std::move(file), may_grow};
}

RecorderStream::RecorderStream(OpenStream source)
    : source_(std::move(source)), reader_([this] { read_until_over(); }) {}

RecorderStream::~RecorderStream() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  reader_.join();
}

std::string RecorderStream::take(std::chrono::milliseconds longest) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, longest, [this] { return !bytes_.empty() || over_; });
  std::string taken = std::exchange(bytes_, {});
  lock.unlock();
  changed_.notify_all();
  return taken;
}

bool RecorderStream::is_over() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return over_ && bytes_.empty();
}

void RecorderStream::hand_over(std::string_view bytes) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return bytes_.size() < kMaxAhead || stop_; });
  bytes_.append(bytes);
  lock.unlock();
  changed_.notify_all();
}

void RecorderStream::read_until_over() {
  const int file = source_.file.number();
  char buffer[1 << 14];
  while (!stop_) {
    pollfd waiting{.fd = file, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&waiting, 1, kPause_ms);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = ready < 0 ? -1 : ::read(file, buffer, sizeof buffer);
    if (count > 0) {
      hand_over({buffer, static_cast<std::size_t>(count)});
    } else if (count < 0 && (errno == EINTR || errno == EAGAIN)) {
      continue;
    } else if (count == 0 && source_.may_grow && !became_shorter(file)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kPause_ms));
    } else {
      break;
    }
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  over_ = true;
  changed_.notify_all();
}

Interruption::Interruption() {
  interrupted = false;
  struct sigaction action {};
  action.sa_handler = note_interruption;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
    // A program that was started by nohup ignores SIGHUP, and must continue to do so.
    if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) continue;
    ::sigaction(kSignals[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  if (hung_up != 0) before_.back().sa_handler = SIG_IGN;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &before_[i], nullptr);
  }
}

bool Interruption::came() { return interrupted; }

}  // namespace awmr::cli
