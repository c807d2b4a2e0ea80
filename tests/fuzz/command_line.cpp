/// Fuzz target: sends the bytes to the reader of serial commands. Only a complete line or frame
/// gives a command, its value is finite, and the letters STOP always give the command to stop.
#include "awmr/emit/board/command_line.h"

#include <cmath>
#include <string>

#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  awmr::CommandReader reader;
  std::string line;
  bool is_stopped = false;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(data[i]);
    const awmr::CommandVerdict verdict = reader.take(c);
    const char upper = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    line += upper;
    const bool stops = line.size() >= 4 && line.compare(line.size() - 4, 4, "STOP") == 0;
    if (stops) {
      require(verdict == awmr::CommandVerdict::kTaken && reader.word == awmr::CommandWord::kStop,
              "the letters STOP give a stop command");
      is_stopped = true;
    }
    const bool ends = c == '\n' || c == '\r';
    if (verdict == awmr::CommandVerdict::kTaken && !stops) {
      require(ends && !is_stopped, "a command ends with a line end");
      require(line.size() <= awmr::kCommandLength + 1U, "a command fits its buffer");
      require(reader.word != awmr::CommandWord::kStop && reader.word != awmr::CommandWord::kNone,
              "a command has a known word");
      require(std::isfinite(reader.value), "a value is finite");
    }
    if (ends) {
      line.clear();
      is_stopped = false;
    }
  }
  return 0;
}
