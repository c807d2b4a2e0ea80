/// Words of the commands that command_line.h reads.
#pragma once

#include <stdint.h>

namespace awmr {

/// Commands. The value of a command with one letter is this letter.
enum class CommandWord : uint8_t {
  kNone,
  kArm,            ///< ARM: motors can turn
  kStop,           ///< STOP: motors off until the next ARM
  kKeep = 'K',     ///< KEEP, or K: continue; resets the command time-out
  kGo = 'G',       ///< G: start the route or the run
  kNext = 'N',     ///< N: skip this run
  kYes = 'Y',      ///< Y: the answer yes
  kHeading = 'H',  ///< H: heading, deg
  kSpeed = 'S',    ///< S: speed, m/s
  kMode = 'M',     ///< M: YawMode, 0, 1 or 2
  kForce = 'T'     ///< T: wheel force divided by F_max
};

/// True if a number follows the command.
inline bool takes_number(CommandWord word) {
  return word == CommandWord::kHeading || word == CommandWord::kSpeed ||
         word == CommandWord::kMode || word == CommandWord::kForce;
}

/// Returns the command with this name of 1 to 4 capital letters; kNone if no command has it. The
/// name STOP is not in the list, because CommandReader recognises STOP letter by letter.
inline CommandWord find_command(const char* name, uint8_t letters) {
  if (letters == 1) {
    const CommandWord word = static_cast<CommandWord>(name[0]);
    switch (word) {
      case CommandWord::kKeep:
      case CommandWord::kGo:
      case CommandWord::kNext:
      case CommandWord::kYes:
      case CommandWord::kHeading:
      case CommandWord::kSpeed:
      case CommandWord::kMode:
      case CommandWord::kForce:
        return word;
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
