// Executes the control step on a chip over a serial line, with the frames of firmware/frame.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "executor.h"

namespace awmr::pil {

/// Timeout for a byte: kStart while the chip checks its parameters, kAnswer otherwise.
enum class Patience { kStart, kAnswer };

/// Byte stream to and from a chip, emulated or real. Bytes may be damaged or lost on the way.
class Line {
 public:
  virtual ~Line() = default;
  virtual Status open() = 0;
  /// Resets the chip at the other end. Errors (input): not possible.
  virtual Status reset() = 0;
  virtual Status send(std::span<const std::uint8_t> bytes) = 0;
  /// Returns the next byte; none if the line stays silent. Errors: the chip or the line is gone.
  virtual Result<std::optional<std::uint8_t>> receive(Patience patience) = 0;
  virtual ChipFigures figures() const = 0;
};

/// `parameters_crc`: CRC of the parameters that the chip must hold.
std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc);

}  // namespace awmr::pil
