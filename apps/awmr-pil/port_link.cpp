#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "awmr/core/files/serial_port.h"
#include "emulator.h"
#include "frame_link.h"

namespace awmr::pil {
namespace {

constexpr int kStartTimeout_ms = static_cast<int>(1000.0 * kStartTimeout_s);
/// Timeout of an answer. It is twice the slowest case, 140 bytes at 9600 baud, which take 146 ms.
constexpr int kAnswerTimeout_ms = 300;
/// Waiting time after the port is opened, ms. Opening the port resets a Mega 2560, whose boot
/// loader waits before it starts the firmware.
constexpr int kBootTime_ms = 2000;

class Port : public Line {
 public:
  Port(std::filesystem::path path, unsigned baud, unsigned flash_bytes, unsigned ram_bytes)
      : path_(std::move(path)), baud_(baud), flash_bytes_(flash_bytes), ram_bytes_(ram_bytes) {}

  Status open() override {
    AWMR_ASSIGN_OR_RETURN(Descriptor file, open_serial_port(path_, baud_));
    file_.emplace(std::move(file));
    const bool is_terminal = path_.string().starts_with("/dev/pts/");
    if (!is_terminal) ::usleep(kBootTime_ms * 1000);
    ::tcflush(file_->number(), TCIOFLUSH);
    return {};
  }

  Status reset() override {
    return input_error(ErrorCode::kConflict, "--inject",
                       "the fault 'reset' can be injected only on the emulated chip; on a board, "
                       "press its reset button");
  }

  Status send(std::span<const std::uint8_t> bytes) override {
    while (!bytes.empty()) {
      const ssize_t count = ::write(file_->number(), bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) {
        return input_error(
            ErrorCode::kCannotWrite, path_.string(),
            fmt::format("cannot write to the port: {}; check the cable and the board",
                        std::strerror(errno)));
      }
      if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return {};
  }

  Result<std::optional<std::uint8_t>> receive(Patience patience) override {
    if (at_ == count_) {
      pollfd waiting{.fd = file_->number(), .events = POLLIN, .revents = 0};
      const int timeout_ms = patience == Patience::kStart ? kStartTimeout_ms : kAnswerTimeout_ms;
      if (::poll(&waiting, 1, timeout_ms) <= 0) return std::optional<std::uint8_t>();
      const ssize_t count = ::read(file_->number(), buffer_, sizeof buffer_);
      if (count <= 0) {
        return input_error(ErrorCode::kCannotRead, path_.string(),
                           "the port was closed during the run; check the cable and the board");
      }
      at_ = 0;
      count_ = static_cast<std::size_t>(count);
    }
    return std::optional(buffer_[at_++]);
  }

  ChipFigures figures() const override {
    return {.flash_bytes = flash_bytes_, .ram_bytes = ram_bytes_};
  }

 private:
  std::filesystem::path path_;
  unsigned baud_;
  unsigned flash_bytes_;
  unsigned ram_bytes_;
  std::optional<Descriptor> file_;
  std::uint8_t buffer_[256] = {};
  std::size_t at_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

Result<std::unique_ptr<Chip>> port_link(const std::filesystem::path& port, unsigned baud,
                                        const std::filesystem::path& elf,
                                        std::uint32_t parameters_crc) {
  // The emulator is created only to read the use of flash and RAM from the ELF file.
  const auto emulator = Emulator::load(elf);
  if (!emulator) return tl::unexpected(emulator.error());
  return frame_link(
      std::make_unique<Port>(port, baud, (*emulator)->flash_bytes(), (*emulator)->ram_bytes()),
      parameters_crc);
}

namespace {

Result<int> open_terminal() {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0 ||
      !make_raw(terminal, 500000).value_or(false)) {
    return program_fault(fmt::format("cannot create a pseudo-terminal: {}", std::strerror(errno)));
  }
  return terminal;
}

/// Writes the bytes that the terminal accepts; further bytes are lost, as on a real line.
void write_to(int terminal, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::write(terminal, bytes.data() + sent, bytes.size() - sent);
    if (count <= 0) break;
    sent += static_cast<std::size_t>(count);
  }
}

}  // namespace

Status serve_terminal(const std::filesystem::path& elf) {
  auto emulator = Emulator::load(elf);
  if (!emulator) return tl::unexpected(emulator.error());
  AWMR_ASSIGN_OR_RETURN(const int terminal, open_terminal());
  std::string answer;
  (*emulator)->on_uart_output([&](std::uint8_t byte) { answer += static_cast<char>(byte); });
  (*emulator)->connect_uart();
  std::printf("%s\n", ::ptsname(terminal));
  std::fflush(stdout);
  // Cycle limit that is never reached.
  constexpr std::uint64_t kLong = 1'000'000'000'000;
  bool was_open = false;
  for (;;) {
    pollfd waiting{.fd = terminal, .events = POLLIN, .revents = 0};
    // Waits for input, at most 1 ms. Does not wait while output is pending.
    ::poll(&waiting, 1, answer.empty() ? 1 : 0);
    if ((waiting.revents & POLLIN) != 0) {
      std::uint8_t bytes[256];
      const ssize_t count = ::read(terminal, bytes, sizeof bytes);
      if (count > 0) {
        was_open = true;
        (*emulator)->send_to_uart({bytes, static_cast<std::size_t>(count)});
      }
    } else if ((waiting.revents & POLLHUP) != 0 && was_open) {
      break;
    }
    // Number of cycles that suffices for a request, its control step and its answer.
    const std::uint64_t end = (*emulator)->cycles() + 100'000;
    if (auto ran = (*emulator)->run_until([&] { return (*emulator)->cycles() >= end; }, kLong);
        !ran) {
      return ran;
    }
    write_to(terminal, answer);
    answer.clear();
  }
  ::close(terminal);
  return {};
}

}  // namespace awmr::pil
