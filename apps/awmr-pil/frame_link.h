// The control step over a line of bytes: firmware/frame.h's frames.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "executor.h"

namespace awmr::pil {

/// How long to wait for a byte: for a chip that checks its parameters first, or for an answer.
enum class Patience { kStart, kAnswer };

/// Bytes to and from a chip, emulated or real. They may be damaged or lost on the way.
class Line {
 public:
  virtual ~Line() = default;
  virtual Status open() = 0;
  /// Resets the chip at its other end. Errors (input): it cannot.
  virtual Status reset() = 0;
  virtual Status send(std::span<const std::uint8_t> bytes) = 0;
  /// The next byte; none where the line stays silent. Errors: the chip or the line is gone.
  virtual Result<std::optional<std::uint8_t>> receive(Patience patience) = 0;
  virtual ChipFigures figures() const = 0;
};

/// `parameters_crc`: of the parameters that the chip has to hold.
std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc);

}  // namespace awmr::pil
