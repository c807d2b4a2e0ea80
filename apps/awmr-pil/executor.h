// Interface to the programs that execute the control step: the same sources built for the host, the
// firmware on the emulated chip, or the firmware on a real board.
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
  std::optional<unsigned> cycles;  ///< clock cycles that the step took; absent on the host
  bool restarted = false;          ///< the chip was reset and restarted before this step
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Starts the controller and returns the fault bits of its start-up check; 0 if it found none.
  /// Errors: the link or the chip fails.
  virtual Result<std::uint8_t> start() = 0;
  /// Resets the chip during the run. After the reset its guidance begins again at the first point
  /// of its path. Errors (input): the chip is a real board, which the program cannot reset.
  virtual Status reset() = 0;
  /// Follows these points from the next step on, as waypoints or as a line, depending on the
  /// mission. Errors (input): more points than the firmware has room for.
  virtual Status follow(const Points& points) = 0;
  virtual Result<Step> step(const AutopilotInput& input) = 0;
};

/// Resource use of the chip's firmware, as far as known.
struct ChipFigures {
  unsigned flash_bytes = 0;
  unsigned ram_bytes = 0;
  std::optional<unsigned> stack_bytes = {};  ///< largest use of the stack; unknown for a real board
  std::optional<std::size_t> repeats = {};   ///< requests sent again; absent without a serial line
};

class Chip : public Executor {
 public:
  virtual ChipFigures figures() const = 0;
};

/// Runs the control step in float on this machine. The arguments must outlive the executor, which
/// refers to them.
std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters,
                                        const Mission& mission);

/// Runs firmware on an emulated chip and exchanges data through its RAM. `damage_parameters`: flip
/// a bit of the parameters in flash before the start. Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> memory_link(const std::filesystem::path& elf, bool damage_parameters);
/// Runs firmware on an emulated chip and exchanges data through its USART. `parameters_crc`: see
/// frame_link(). The line flips a fraction `noise` of the bits and loses the same fraction of the
/// bytes, in both directions. Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc, double noise);
/// Exchanges data with a real board through a serial port, which start() opens. `elf`: the firmware
/// with which the board was flashed, read only for its use of flash and RAM. `parameters_crc`: see
/// frame_link(). Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> port_link(const std::filesystem::path& port, unsigned baud,
                                        const std::filesystem::path& elf,
                                        std::uint32_t parameters_crc);
/// Runs firmware on an emulated chip whose USART is connected to a pseudo-terminal, and prints the
/// terminal's name on stdout. Returns when the program that opened the terminal closes it.
Status serve_terminal(const std::filesystem::path& elf);

}  // namespace awmr::pil
