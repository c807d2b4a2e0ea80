// The control step over a line of bytes: firmware/frame.h's frames.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "executor.h"

namespace awmr::pil {

/// Bytes to and from a chip, emulated or real.
class Line {
 public:
  virtual ~Line() = default;
  virtual Status open() = 0;
  virtual Status send(std::span<const std::uint8_t> bytes) = 0;
  /// Errors (fault): none came in time.
  virtual Result<std::uint8_t> receive() = 0;
  virtual ChipFigures figures() const = 0;
};

/// `parameters_crc`: of the parameters that the chip has to hold.
std::unique_ptr<Chip> frame_link(std::unique_ptr<Line> line, std::uint32_t parameters_crc);

}  // namespace awmr::pil
