/// A serial port that hands on bytes as they are.
#pragma once

#include <filesystem>

#include "awmr/core/descriptor.h"
#include "awmr/core/result.h"

namespace awmr {

/// Bytes of the terminal as they are, nothing echoed, at `baud`. Errors (input): a rate that is
/// none of 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600, 1000000, 2000000.
/// False: `file` is no terminal.
Result<bool> make_raw(int file, unsigned baud);

/// Opened for reading and writing, without waiting for a modem's carrier. A board that restarts when
/// its port is opened does so now. Errors (input): as make_raw(); the path cannot be opened or is no
/// serial port.
Result<Descriptor> open_serial_port(const std::filesystem::path& path, unsigned baud);

}  // namespace awmr
