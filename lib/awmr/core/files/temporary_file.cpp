#include "awmr/core/files/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>

namespace awmr {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".awmr-";
constexpr std::size_t kRandomCharacters = 6;
constexpr int kAttempts = 100;  ///< attempts to find an unused name

/// Id of the process that made a temporary file, from the file's name; empty for other files.
std::optional<pid_t> maker_of(std::string_view name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  name.remove_prefix(kPrefix.size());
  pid_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const std::string_view rest = name.substr(static_cast<std::size_t>(end - name.data()));
  const bool fits = error == std::errc() && number > 0 && rest.size() == kRandomCharacters + 1;
  return fits && rest[0] == '-' ? std::optional(number) : std::nullopt;
}

/// Paths of the files that the signal handler removes; null: free entry. The handler must not
/// allocate memory or lock, so the paths are copied to the heap beforehand.
constexpr int kSlots = 64;
std::atomic<char*> registered[kSlots];
static_assert(std::atomic<char*>::is_always_lock_free,
              "a signal handler reads this variable, so it must be lock-free");

/// Signals with which a user or the system ends a program.
constexpr int kEndingSignals[] = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM, SIGPIPE,
                                  SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU};

extern "C" void remove_and_end(int signal) {
  for (std::atomic<char*>& slot : registered) {
    if (const char* path = slot.load()) ::unlink(path);
  }
  // SA_RESETHAND has restored the default action of the signal. So raise() ends the program when
  // the handler returns.
  ::raise(signal);
}

/// Adds a path to the files that the signal handler removes. Returns its index in `registered`, or
/// -1 if all entries are in use; a signal then leaves the file behind, for
/// remove_stale_temporaries().
int register_path(const fs::path& path) {
  char* text = ::strdup(path.c_str());
  for (int i = 0; text != nullptr && i < kSlots; ++i) {
    char* empty = nullptr;
    if (registered[i].compare_exchange_strong(empty, text)) return i;
  }
  std::free(text);
  return -1;
}

std::string random_characters() {
  constexpr std::string_view kCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  unsigned char bytes[kRandomCharacters] = {};
  // If the system gives no random bytes, all names are equal, and TemporaryFile::in() fails after
  // kAttempts attempts.
  [[maybe_unused]] const ssize_t count = ::getrandom(bytes, sizeof bytes, 0);
  std::string text;
  for (const unsigned char byte : bytes) text += kCharacters[byte % kCharacters.size()];
  return text;
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

}  // namespace

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::optional<TemporaryFile> TemporaryFile::in(const fs::path& directory) {
  int reason = EEXIST;
  for (int i = 0; i < kAttempts && reason == EEXIST; ++i) {
    TemporaryFile made(directory /
                       fmt::format("{}{}-{}", kPrefix, ::getpid(), random_characters()));
    if (!made.path_.empty()) return made;
    reason = errno;
  }
  errno = reason;
  return std::nullopt;
}

// The path is registered before the file is made. In the reverse order, a signal between the two
// steps would leave the file behind.
TemporaryFile::TemporaryFile(fs::path path)
    : path_(std::move(path)),
      slot_(register_path(path_)),
      file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
  if (file_.number() < 0) {
    path_.clear();  // no file is removed: there is none, or it belongs to another process
    return;
  }
  // A failure does no harm: on a file system without locks, the process id in the name still shows
  // that the program is running.
  (void)::flock(file_.number(), LOCK_EX | LOCK_NB);
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      slot_(std::exchange(other.slot_, -1)),
      file_(std::move(other.file_)) {}

TemporaryFile::~TemporaryFile() {
  if (!path_.empty()) ::unlink(path_.c_str());
  unregister_path();
}

void TemporaryFile::unregister_path() {
  if (slot_ >= 0) std::free(registered[slot_].exchange(nullptr));
  slot_ = -1;
}

bool TemporaryFile::write(std::string_view bytes, mode_t mode) {
  return write_all(file_.number(), bytes) && ::fchmod(file_.number(), mode) == 0 &&
         ::fsync(file_.number()) == 0;
}

bool TemporaryFile::rename_to(const fs::path& target) {
  if (::rename(path_.c_str(), target.c_str()) != 0) return false;
  path_.clear();
  unregister_path();
  return true;
}

void remove_temporaries_on_signals() {
  struct sigaction action {};
  action.sa_handler = remove_and_end;
  action.sa_flags = SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  for (const int signal : kEndingSignals) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL) {
      ::sigaction(signal, &action, nullptr);
    }
  }
}

void remove_stale_temporaries(const fs::path& directory) {
  std::error_code error;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error)) {
    const auto maker = maker_of(it->path().filename().native());
    if (!maker || is_running(*maker)) continue;
    const Descriptor file(
        ::open(it->path().c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0) continue;
    if (!S_ISREG(status.st_mode) || ::flock(file.number(), LOCK_EX | LOCK_NB) != 0) continue;
    ::unlink(it->path().c_str());
  }
}

}  // namespace awmr
