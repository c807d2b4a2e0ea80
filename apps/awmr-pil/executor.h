// Whatever executes the control step: the host's own build of it, the emulated chip, a board.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/control/autopilot.h"
#include "awmr/core/result.h"
#include "awmr/emit/emit.h"
#include "mission.h"

namespace awmr::pil {

struct Step {
  AutopilotOutput output{};
  std::optional<unsigned> cycles;  ///< absent on the host
  bool restarted = false;          ///< the chip had been reset, and was started anew before it
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Starts it: the fault of its start-up check. Errors: the link or the chip fails.
  virtual Result<std::uint8_t> start() = 0;
  /// Resets the chip in mid-run; the next step starts it anew, with the same points.
  virtual Status reset() = 0;
  /// Goes to these points, or along the line through them, as the mission says.
  virtual Status follow(const Points& points) = 0;
  virtual Result<Step> step(const AutopilotInput& input) = 0;
};

/// What a chip's firmware takes, where it can be told.
struct ChipFigures {
  unsigned flash_bytes = 0;
  unsigned ram_bytes = 0;
  std::optional<unsigned> stack_bytes = {};  ///< unknown of a real board
  std::optional<std::size_t> repeats = {};   ///< requests sent again; absent without a line
};

class Chip : public Executor {
 public:
  virtual ChipFigures figures() const = 0;
};

/// In float on this machine, as the chip does it; both have to outlive it.
std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters,
                                        const Mission& mission);

/// Through the RAM of an emulated chip. `damage_parameters`: flips a bit of them in flash first.
Result<std::unique_ptr<Chip>> memory_link(const std::filesystem::path& elf, bool damage_parameters);
/// Through the USART of an emulated chip, over a line that flips a share `noise` of the bits and
/// loses the same share of the bytes, both ways.
Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc, double noise);
/// Through a serial port. `elf` is what the board is to have been flashed with.
Result<std::unique_ptr<Chip>> port_link(const std::filesystem::path& port, unsigned baud,
                                        const std::filesystem::path& elf,
                                        std::uint32_t parameters_crc);
/// Gives an emulated chip's USART to whoever opens the pseudo-terminal, whose name goes to stdout;
/// until its other end is closed.
Status serve_terminal(const std::filesystem::path& elf);

}  // namespace awmr::pil
