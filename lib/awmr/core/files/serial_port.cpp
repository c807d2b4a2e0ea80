#include "awmr/core/files/serial_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "awmr/core/option_text.h"

namespace awmr {
namespace {

struct BaudRate {
  unsigned baud;
  speed_t speed;
};
constexpr std::array<BaudRate, 11> kBaudRates{{{9600, B9600},
                                               {19200, B19200},
                                               {38400, B38400},
                                               {57600, B57600},
                                               {115200, B115200},
                                               {230400, B230400},
                                               {460800, B460800},
                                               {500000, B500000},
                                               {921600, B921600},
                                               {1000000, B1000000},
                                               {2000000, B2000000}}};

}  // namespace

Result<bool> make_raw(int file, unsigned baud) {
  const auto rate = std::find_if(kBaudRates.begin(), kBaudRates.end(),
                                 [&](const BaudRate& one) { return one.baud == baud; });
  if (rate == kBaudRates.end()) {
    std::string names;
    for (const BaudRate& one : kBaudRates) names += fmt::format(" {}", one.baud);
    return input_error(ErrorCode::kOutOfRange, option_text("baud"),
                       fmt::format("found {}; expected one of{}", baud, names));
  }
  termios settings{};
  if (::tcgetattr(file, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  ::cfsetspeed(&settings, rate->speed);
  return ::tcsetattr(file, TCSANOW, &settings) == 0;
}

Result<Descriptor> open_serial_port(const std::filesystem::path& path, unsigned baud) {
  // If O_NONBLOCK were missing, open() of a modem's port could wait for its carrier for ever.
  Descriptor port(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
  if (port.number() < 0) {
    return input_error(ErrorCode::kCannotRead, path.string(), std::strerror(errno));
  }
  ::fcntl(port.number(), F_SETFL, ::fcntl(port.number(), F_GETFL) & ~O_NONBLOCK);
  AWMR_ASSIGN_OR_RETURN(const bool raw, make_raw(port.number(), baud));
  if (!raw)
    return input_error(ErrorCode::kWrongFile, path.string(),
                       "this is not a serial port; give one, such as /dev/ttyUSB0");
  return port;
}

}  // namespace awmr
