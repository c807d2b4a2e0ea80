/// Words of the commands that command_line.h reads.
#pragma once

#include <stdint.h>

namespace awmr {

enum class CommandWord : uint8_t {
  kNone,
  kArm,      ///< ARM: motors can turn
  kStop,     ///< STOP: motors off until the next ARM
  kKeep,     ///< KEEP, or K: continue; resets the command time-out
  kGo,       ///< G: start the route or the run
  kNext,     ///< N: skip this run
  kYes,      ///< Y: the answer yes
  kHeading,  ///< H: heading, deg
  kSpeed,    ///< S: speed, m/s
  kMode,     ///< M: YawMode, 0, 1 or 2
  kForce     ///< T: wheel force divided by F_max
};

/// Returns the command with this name of 1 to 4 capital letters; kNone if no command has it. The
/// name STOP is not in the list, because CommandReader recognises STOP letter by letter.
inline CommandWord find_command(const char* name, uint8_t letters) {
  if (letters == 1) {
    switch (name[0]) {
      case 'K':
        return CommandWord::kKeep;
      case 'G':
        return CommandWord::kGo;
      case 'N':
        return CommandWord::kNext;
      case 'Y':
        return CommandWord::kYes;
      case 'H':
        return CommandWord::kHeading;
      case 'S':
        return CommandWord::kSpeed;
      case 'M':
        return CommandWord::kMode;
      case 'T':
        return CommandWord::kForce;
      default:
        return CommandWord::kNone;
    }
  }
  if (letters == 3 && name[0] == 'A' && name[1] == 'R' && name[2] == 'M') {
    return CommandWord::kArm;
  }
  if (letters == 4 && name[0] == 'K' && name[1] == 'E' && name[2] == 'E' && name[3] == 'P') {
    return CommandWord::kKeep;
  }
  return CommandWord::kNone;
}

}  // namespace awmr
