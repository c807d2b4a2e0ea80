#include "work_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <string_view>
#include <thread>

#include "awmr/core/files/process.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "awmr-pil-";
constexpr int kEndingSignals[] = {SIGINT,  SIGTERM, SIGHUP,    SIGQUIT, SIGALRM,
                                  SIGUSR1, SIGUSR2, SIGVTALRM, SIGXCPU, SIGXFSZ};

/// Locked while the folder is created or removed. When a signal ends the program, the thread that
/// handles the signal locks this mutex for ever, so that no folder can be created after the
/// clean-up.
std::mutex folder_mutex;
/// Path of this run's folder; empty if there is none. A signal may arrive while the program exits,
/// so the object is never destroyed.
fs::path& folder = *new fs::path;

/// True: the thread that handles signals was started.
bool can_end = false;
/// The signal thread posts this semaphore to answer question(): no signal that ends the program is
/// pending.
sem_t not_ending;

/// True for `awmr-pil-NUMBER-XXXXXX`, where NUMBER is a process ID.
bool is_run_folder(std::string_view name) {
  if (!name.starts_with(kPrefix)) return false;
  name.remove_prefix(kPrefix.size());
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  return digits > 0 && name.substr(digits).starts_with('-');
}

/// Locks the folder itself. The lock is held until the returned descriptor is closed or the process
/// ends. Returns -1 if another process holds the lock.
int lock_folder(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) ::close(file);
  return -1;
}

/// True for a folder that a killed run left: it belongs to this user, is no link, and no process
/// has locked it. The process ID in its name proves nothing: it may belong to another process by
/// now, for example in another container with the same TMPDIR.
bool is_left_over(const fs::path& path) {
  if (!is_run_folder(path.filename().string())) return false;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return false;
  if (status.st_uid != ::geteuid()) return false;
  const int lock = lock_folder(path);
  if (lock >= 0) ::close(lock);
  return lock >= 0;
}

/// Removes the folder. The main thread, or the compiler of a killed run, may still be writing into
/// it, so a failed attempt is repeated.
void remove_folder(const fs::path& path) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::error_code error;
    fs::remove_all(path, error);
    if (!error && !fs::exists(path, error)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void remove_left_overs(const fs::path& directory) {
  std::error_code ignored;
  for (fs::directory_iterator entry(directory, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (is_left_over(entry->path())) remove_folder(entry->path());
  }
}

sigset_t handled_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int number : kEndingSignals) {
    struct sigaction action {};
    ::sigaction(number, nullptr, &action);
    if (action.sa_handler != SIG_IGN) ::sigaddset(&signals, number);
  }
  return signals;
}

/// Signal by which the main thread asks the signal thread whether the program is about to end. Of
/// several pending signals, the one with the lowest number is delivered first, so the thread
/// receives this signal only if no signal that ends the program is pending.
int question() { return SIGRTMIN; }

/// Discards all further output on stderr, also that of the emulator's library. From here on, errors
/// such as a killed compiler or a missing file only result from the shutdown.
void silence_errors() {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

/// Body of the signal thread: waits for a signal, cleans up, ends the program by that signal.
void* end_at_signal(void*) {
  sigset_t signals = handled_signals();
  ::sigaddset(&signals, question());
  int number = question();
  while (number == question()) {
    if (::sigwait(&signals, &number) == 0 && number == question()) ::sem_post(&not_ending);
  }
  silence_errors();
  folder_mutex.lock();
  end_running_programs();
  if (!folder.empty()) remove_folder(folder);
  ::signal(number, SIG_DFL);
  sigset_t one;
  ::sigemptyset(&one);
  ::sigaddset(&one, number);
  ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  ::raise(number);
  return nullptr;
}

}  // namespace

Result<std::unique_ptr<WorkFolder>> WorkFolder::make() {
  const char* given = ::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe): never set here
  const fs::path directory = given != nullptr && *given != '\0' ? given : "/tmp";
  const auto failed = [&](const std::string& why) {
    return input_error(ErrorCode::kCannotWrite, "TMPDIR",
                       fmt::format("no folder can be made in '{}': {}; set TMPDIR to "
                                   "a folder that can be written to",
                                   directory.string(), why));
  };
  if (!directory.is_absolute()) return failed("it is not an absolute path");
  remove_left_overs(directory);
  const std::lock_guard lock(folder_mutex);
  std::string name = (directory / fmt::format("{}new-XXXXXX", kPrefix)).string();
  if (::mkdtemp(name.data()) == nullptr) return failed(std::strerror(errno));
  folder = name;
  std::unique_ptr<WorkFolder> made(new WorkFolder);
  made->path_ = name;
  made->lock_ = lock_folder(name);
  // The folder gets its final name only when it is locked, because other runs remove unlocked
  // folders with such names.
  const std::string suffix = name.substr(name.size() - 6);
  const fs::path locked = directory / fmt::format("{}{}-{}", kPrefix, ::getpid(), suffix);
  if (::rename(name.c_str(), locked.c_str()) == 0) folder = made->path_ = locked;
  return made;
}

WorkFolder::~WorkFolder() {
  const std::lock_guard lock(folder_mutex);
  remove_folder(path_);
  folder.clear();
  if (lock_ >= 0) ::close(lock_);
}

void clean_up_at_signals() {
  sigset_t signals = handled_signals();
  ::sigaddset(&signals, question());
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  ::sem_init(&not_ending, 0, 0);
  pthread_t thread{};
  if (::pthread_create(&thread, nullptr, end_at_signal, nullptr) == 0) {
    ::pthread_detach(thread);
    can_end = true;
  } else {
    ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

void exit_if_interrupted() {
  if (!can_end || ::kill(::getpid(), question()) != 0) return;
  while (::sem_wait(&not_ending) != 0) {
  }
}

}  // namespace awmr::pil
