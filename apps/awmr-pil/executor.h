// Interface of what executes the control step: the host's own build, the emulated chip or a board.
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
  std::optional<unsigned> cycles;  ///< cycles of the chip; absent on the host
  bool restarted = false;          ///< the chip was reset and restarted before this step
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Starts the controller and returns the fault of its start-up check. Errors: the link or the
  /// chip fails.
  virtual Result<std::uint8_t> start() = 0;
  /// Resets the chip during the run; the next step restarts the controller with the same points.
  virtual Status reset() = 0;
  /// Follows these points as waypoints or as a line, depending on the mission.
  virtual Status follow(const Points& points) = 0;
  virtual Result<Step> step(const AutopilotInput& input) = 0;
};

/// Resource use of the chip's firmware, as far as known.
struct ChipFigures {
  unsigned flash_bytes = 0;
  unsigned ram_bytes = 0;
  std::optional<unsigned> stack_bytes = {};  ///< unknown for a real board
  std::optional<std::size_t> repeats = {};   ///< requests sent again; absent without a serial line
};

class Chip : public Executor {
 public:
  virtual ChipFigures figures() const = 0;
};

/// Runs the control step in float on this machine. The executor keeps references to the arguments.
std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters,
                                        const Mission& mission);

/// Exchanges data through the RAM of an emulated chip. `damage_parameters`: flips a bit of the
/// parameters in flash before the start.
Result<std::unique_ptr<Chip>> memory_link(const std::filesystem::path& elf, bool damage_parameters);
/// Exchanges data through the USART of an emulated chip. The line flips a fraction `noise` of the
/// bits and loses the same fraction of the bytes, in both directions.
Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc, double noise);
/// Exchanges data through a serial port. `elf`: the firmware with which the board was flashed.
Result<std::unique_ptr<Chip>> port_link(const std::filesystem::path& port, unsigned baud,
                                        const std::filesystem::path& elf,
                                        std::uint32_t parameters_crc);
/// Connects an emulated chip's USART to a pseudo-terminal and prints the terminal's name on stdout.
/// Returns when the other end is closed.
Status serve_terminal(const std::filesystem::path& elf);

}  // namespace awmr::pil
