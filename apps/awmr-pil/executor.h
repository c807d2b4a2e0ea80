// Interface to the executor of the control step. It is a build of the sources for the host, the
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

/// Timeout of the start of the firmware, s, on an emulated or a real chip. The firmware needs 0.024 s
/// (without optional parts) to 0.029 s (with all), above all to check its parameters. Measured on the
/// emulated chip.
constexpr double kStartTimeout_s = 1.0;

struct Step {
  AutopilotOutput output{};
  std::optional<unsigned> cycles;  ///< clock cycles that the step took; absent on the host
  bool restarted = false;          ///< the chip was reset and restarted before this step
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Starts the controller and returns the fault bits of its start-up check; 0 if the check found
  /// no fault. Errors: the link or the chip fails.
  virtual Result<std::uint8_t> start() = 0;
  /// Resets the chip during the run. Its guidance then starts again at the first point of the path.
  /// Errors (input): the chip is on a real board, which this program cannot reset.
  virtual Status reset() = 0;
  /// From the next step on, the vehicle follows these points. The mission determines whether they
  /// are waypoints or corners of a line. Errors (input): more points than the firmware has room
  /// for.
  virtual Status follow(const Points& points) = 0;
  virtual Result<Step> step(const AutopilotInput& input) = 0;
};

/// Memory use of the chip's firmware, and repeated requests on its serial line.
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

/// Returns an executor that runs the control step in float on this machine. It refers to the
/// arguments, which must outlive it.
std::unique_ptr<Executor> host_executor(const AutopilotParameters& parameters,
                                        const Mission& mission);

/// Returns a chip that is emulated and exchanges data through its RAM. `elf`: its firmware.
/// `damage_parameters`: flip a bit of the parameters in flash before the start, to test the
/// start-up check. Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> memory_link(const std::filesystem::path& elf, bool damage_parameters);
/// Returns a chip that is emulated and exchanges data through its USART. `elf`: its firmware;
/// `damage_parameters`: as for memory_link(); `parameters_crc`: as for frame_link(). The line flips
/// a fraction `noise` of the bits and loses the same fraction of the bytes, in both directions.
/// Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc, double noise);
/// Returns a chip on a real board, which exchanges data through a serial port that start() opens.
/// `elf`: the firmware with which the board was flashed; it is read only to report the use of flash
/// and RAM. `parameters_crc`: as for frame_link(). Errors: those of Emulator::load().
Result<std::unique_ptr<Chip>> port_link(const std::filesystem::path& port, unsigned baud,
                                        const std::filesystem::path& elf,
                                        std::uint32_t parameters_crc);
/// Emulates a board: runs firmware on an emulated chip whose USART is connected to a
/// pseudo-terminal, and prints the terminal's name on stdout. Returns when the program that opened
/// the terminal closes it.
Status serve_terminal(const std::filesystem::path& elf);

}  // namespace awmr::pil
