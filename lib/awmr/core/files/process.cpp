#include "awmr/core/files/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>

#include "awmr/core/containers.h"
#include "awmr/core/files/descriptor.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kOutputBytes = 65536;
constexpr int kPoll_ms = 20;

/// Process groups of the programs that run_program() waits for. After end_running_programs(),
/// `may_start` is false, and no further program is started.
std::mutex running_mutex;
std::set<pid_t> running;
bool may_start = true;

/// Settings of a new process: working directory, stdin, stdout and stderr; no other open files; no
/// signal blocked or ignored; its own process group, so that it can be killed together with its
/// children.
class SpawnSettings {
 public:
  SpawnSettings(const fs::path& directory, int output) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    ::posix_spawn_file_actions_addchdir_np(&actions_, directory.c_str());
    ::posix_spawnattr_init(&attributes_);
    sigset_t signals;
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  list.reserve(texts.size() + 1);
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

/// Starts a program. Returns its process id, which is also its process group, or a negative error
/// number.
pid_t start(const ProgramCall& call, int output) {
  std::vector<std::string> arguments{call.program.string()};
  append(arguments, call.arguments);
  std::vector<std::string> environment = call.environment;
  const SpawnSettings settings(call.directory, output);
  const std::lock_guard lock(running_mutex);
  if (!may_start) return -ECANCELED;
  pid_t process = 0;
  const int error =
      ::posix_spawn(&process, call.program.c_str(), settings.actions(), settings.attributes(),
                    pointers(arguments).data(), pointers(environment).data());
  if (error != 0) return -error;
  running.insert(process);
  return process;
}

/// Reads the available bytes of a pipe. Keeps the first kOutputBytes. False at the end of the pipe.
bool read_on(int file, std::string& output) {
  std::array<char, 4096> block;
  const ssize_t count = ::read(file, block.data(), block.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  const std::size_t room = kOutputBytes - output.size();
  output.append(block.data(), std::min(room, static_cast<std::size_t>(count)));
  return count > 0;
}

/// Reads the output until the process has ended or reached its time limit. Then kills its process
/// group, which includes its children.
ProgramEnd wait_for(pid_t process, int file, double time_limit_s) {
  ProgramEnd end;
  const auto deadline = Clock::now() + std::chrono::duration<double>(time_limit_s);
  bool readable = true;
  siginfo_t ended{};
  while (true) {
    pollfd waiting{.fd = readable ? file : -1, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kPoll_ms) > 0) readable = read_on(file, end.output);
    if (waiting.revents != 0 && readable && Clock::now() < deadline) continue;
    // WNOWAIT keeps the ended process in the process table, so no other process can get its id
    // before its process group has been killed.
    const int waited =
        ::waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (waited == 0 && ended.si_pid == process) break;
    if (Clock::now() >= deadline) {
      end.timed_out = true;
      break;
    }
  }
  ::kill(-process, SIGKILL);
  int status = 0;
  {
    const std::lock_guard lock(running_mutex);
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    running.erase(process);
  }
  if (WIFEXITED(status) && !end.timed_out) end.exit_code = WEXITSTATUS(status);
  return end;
}

}  // namespace

std::optional<fs::path> find_program(std::string_view name) {
  const char* given = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  std::string_view rest = given != nullptr ? given : "/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path directory(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const fs::path file = directory / name;
    std::error_code ignored;
    if (directory.is_absolute() && fs::is_regular_file(file, ignored) &&
        ::access(file.c_str(), X_OK) == 0) {
      return file;
    }
  }
  return std::nullopt;
}

std::vector<std::string> plain_environment(const fs::path& temporary) {
  std::vector<std::string> environment{"TMPDIR=" + temporary.string()};
  for (const char* name : {"PATH", "HOME", "LANG"}) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    if (value != nullptr) environment.push_back(fmt::format("{}={}", name, value));
  }
  return environment;
}

Result<ProgramEnd> run_program(const ProgramCall& call) {
  const auto failed = [&](int error) {
    return input_error(ErrorCode::kNotInstalled, call.program.string(),
                       fmt::format("cannot start this program in {}: {}", call.directory.string(),
                                   std::strerror(error)));
  };
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) return failed(errno);
  const Descriptor read_end(ends[0]);
  const pid_t process = [&] {
    // Closed on return, so that reading ends when the program ends.
    const Descriptor write_end(ends[1]);
    return start(call, write_end.number());
  }();
  if (process < 0) return failed(-process);
  return wait_for(process, read_end.number(), call.time_limit_s);
}

void end_running_programs() {
  const std::lock_guard lock(running_mutex);
  may_start = false;
  for (const pid_t group : running) ::kill(-group, SIGKILL);
}

}  // namespace awmr
