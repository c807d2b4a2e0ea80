/// Opens serial ports in raw mode.
#pragma once

#include <filesystem>

#include "awmr/core/files/descriptor.h"
#include "awmr/core/result.h"

namespace awmr {

/// Sets the serial port or terminal of the descriptor `file` to raw mode without echo, at `baud`
/// bit/s. Returns false if `file` is neither a serial port nor a terminal, or does not accept the
/// settings. Errors (input): the rate is not one of 9600, 19200, 38400, 57600, 115200, 230400,
/// 460800, 500000, 921600, 1000000, 2000000.
Result<bool> make_raw(int file, unsigned baud);

/// Opens a port for reading and writing, without waiting for a modem's carrier. Many boards restart
/// when their port is opened. Errors (input): as make_raw(); the path cannot be opened or is not a
/// serial port.
Result<Descriptor> open_serial_port(const std::filesystem::path& path, unsigned baud);

}  // namespace awmr
