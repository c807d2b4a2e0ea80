// Executes the control step on a chip at a serial line, with the frames of firmware/frame.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "executor.h"

namespace awmr::pil {

/// Selects the longest wait for a byte: kStart while the chip starts and checks its parameters,
/// which takes longer than a step; kAnswer at all other times. The waiting times differ between an
/// emulated and a real chip.
enum class Patience { kStart, kAnswer };

/// Byte stream to and from a chip, emulated or real. Bytes may be damaged or lost on the way.
class Line {
 public:
  virtual ~Line() = default;
  virtual Status open() = 0;
  /// Resets the chip at the other end of the line. Errors (input): the chip is on a real board,
  /// which this program cannot reset.
  virtual Status reset() = 0;
  virtual Status send(std::span<const std::uint8_t> bytes) = 0;
  /// Returns the next byte; none if the line stays silent. Errors: the chip or the line is gone.
  virtual Result<std::optional<std::uint8_t>> receive(Patience patience) = 0;
  virtual ChipFigures figures() const = 0;
};

/// Returns a chip that executes the control step over the line. `parameters_crc`: the value that
/// the firmware must report at its start, the CRC-32 of the parameters xor mission_crc(). Otherwise
/// start() returns an error (input), because the firmware was made for other inputs.
std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc);

}  // namespace awmr::pil
