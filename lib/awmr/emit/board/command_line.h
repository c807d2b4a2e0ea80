/// Reads commands from a serial line: one command per line, as text for a terminal or as frames for
/// a program.
///
///     text   = WORD [" " NUMBER], for example "H 90"; see CommandWord:
///              ARM  STOP  KEEP  G  N  Y  H <deg>  S <m/s>  M <mode>  T <force>
///     frame  = "#" SEQUENCE " " text "*" CRC
///     SEQUENCE: 0 to 255, one more than in the last frame (256 is 0)
///     CRC: CRC-16 (crc.h) of the characters between # and *, four hexadecimal digits
///
/// - A line is executed only if it is a complete command.
/// - Exception: STOP acts at its last letter, anywhere in a line, even in one that is too long or
///   damaged.
/// - A frame counts as new if its sequence number is 1 to 127 above that of the last new frame,
///   modulo 256. Other frames are refused. So a faulty transmitter that repeats one frame cannot
///   keep the command time-out from stopping the vehicle.
/// - After the first frame, text other than STOP is refused until the next reset: noise on a radio
///   link can look like a short text, but not like a frame.
#pragma once

#include <stdint.h>

#include "awmr/control/crc.h"

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

enum class CommandVerdict : uint8_t {
  kNone,       ///< no complete line yet
  kTaken,      ///< `word` and `value` are valid
  kUnknown,    ///< no such command, or its value is missing, malformed or too large
  kTooLong,    ///< more than kCommandLength characters
  kDamaged,    ///< a frame with a wrong check sum or form
  kRepeated,   ///< a frame with an old sequence number
  kTextLocked  ///< text is refused after the first frame
};

/// Maximum number of characters of a line, without the line end.
constexpr uint8_t kCommandLength = 31;

class CommandReader {
 public:
  CommandWord word = CommandWord::kNone;
  float value = 0.0F;      ///< 0 if the command has none
  bool is_framed = false;  ///< the last line was a frame
  uint8_t sequence = 0;    ///< sequence number of the last new frame

  /// Processes a character. If it ends a line, returns the result for this line; within a line, and
  /// for an empty line, returns kNone. Exception: the last letter of STOP gives kTaken at once.
  CommandVerdict take(char c) {
    if (is_stop_at(c)) {
      // Skip the rest of this line.
      is_skipping_ = true;
      word = CommandWord::kStop;
      value = 0.0F;
      is_framed = false;
      return CommandVerdict::kTaken;
    }
    if (c == '\n' || c == '\r') return end_line();
    if (length_ < kCommandLength) {
      line_[length_] = upper(c);
      if (c < ' ' || c > '~') is_text_ = false;
    }
    if (length_ <= kCommandLength) ++length_;
    return CommandVerdict::kNone;
  }

 private:
  char line_[kCommandLength + 1] = {};
  uint8_t length_ = 0;
  uint8_t stop_letters_ = 0;
  bool is_text_ = true;
  bool is_skipping_ = false;
  bool has_sequence_ = false;

  static char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

  bool is_stop_at(char c) {
    const char letter = upper(c);
    const char wanted = stop_letters_ == 0   ? 'S'
                        : stop_letters_ == 1 ? 'T'
                        : stop_letters_ == 2 ? 'O'
                                             : 'P';
    if (letter == wanted) {
      ++stop_letters_;
    } else {
      stop_letters_ = letter == 'S' ? 1 : 0;
    }
    if (stop_letters_ < 4) return false;
    stop_letters_ = 0;
    return true;
  }

  CommandVerdict end_line() {
    const uint8_t length = length_;
    const bool is_text = is_text_;
    const bool is_over = is_skipping_ || length == 0;
    length_ = 0;
    is_text_ = true;
    is_skipping_ = false;
    if (is_over) return CommandVerdict::kNone;
    is_framed = line_[0] == '#';
    if (length > kCommandLength) return CommandVerdict::kTooLong;
    line_[length] = '\0';
    if (is_framed) return is_text ? read_frame(length) : CommandVerdict::kDamaged;
    if (!is_text) return CommandVerdict::kUnknown;
    if (has_sequence_) return CommandVerdict::kTextLocked;
    return read_text(line_);
  }

  CommandVerdict read_frame(uint8_t length) {
    // The shortest frame is "#0 K*0000".
    if (length < 9 || line_[length - 5] != '*') return CommandVerdict::kDamaged;
    uint16_t sum = 0;
    for (uint8_t i = static_cast<uint8_t>(length - 4); i < length; ++i) {
      const uint8_t digit = hex(line_[i]);
      if (digit > 15) return CommandVerdict::kDamaged;
      sum = static_cast<uint16_t>(sum << 4U | digit);
    }
    const size_t covered = static_cast<size_t>(length - 6);
    if (crc16_of(reinterpret_cast<const uint8_t*>(line_ + 1), covered) != sum) {
      return CommandVerdict::kDamaged;
    }
    line_[length - 5] = '\0';
    const char* text = line_ + 1;
    uint16_t number = 0;
    uint8_t digits = 0;
    for (; *text >= '0' && *text <= '9' && digits < 4; ++text, ++digits) {
      number = static_cast<uint16_t>(number * 10U + static_cast<uint16_t>(*text - '0'));
    }
    if (digits == 0 || number > 255 || *text != ' ') return CommandVerdict::kDamaged;
    const uint8_t ahead = static_cast<uint8_t>(number - sequence);
    if (has_sequence_ && (ahead == 0 || ahead > 127)) return CommandVerdict::kRepeated;
    const CommandVerdict verdict = read_text(text + 1);
    // An unknown command also uses up its sequence number, so that a repetition of the frame is
    // refused.
    sequence = static_cast<uint8_t>(number);
    has_sequence_ = true;
    return verdict;
  }

  CommandVerdict read_text(const char* text) {
    char name[5];
    uint8_t letters = 0;
    while (*text >= 'A' && *text <= 'Z') {
      if (letters == 4) return CommandVerdict::kUnknown;
      name[letters++] = *text++;
    }
    name[letters] = '\0';
    const CommandWord found = find_command(name, letters);
    if (found == CommandWord::kNone) return CommandVerdict::kUnknown;
    float number = 0.0F;
    if (takes_number(found)) {
      if (*text++ != ' ' || !read_number(text, number)) return CommandVerdict::kUnknown;
    } else if (*text != '\0') {
      return CommandVerdict::kUnknown;
    }
    word = found;
    value = number;
    return CommandVerdict::kTaken;
  }

  /// Reads a decimal number of one to eight digits, [+-]d*[.d*], that ends with the text. Returns
  /// false if the text has another form.
  static bool read_number(const char* text, float& number) {
    const bool is_negative = *text == '-';
    if (*text == '-' || *text == '+') ++text;
    uint32_t digits = 0;
    uint8_t count = 0;
    float scale = 1.0F;
    bool has_point = false;
    for (; *text != '\0'; ++text) {
      if (*text == '.' && !has_point) {
        has_point = true;
        continue;
      }
      if (*text < '0' || *text > '9' || ++count > 8) return false;
      digits = digits * 10U + static_cast<uint32_t>(*text - '0');
      if (has_point) scale *= 10.0F;
    }
    if (count == 0) return false;
    number = static_cast<float>(digits) / scale;
    if (is_negative) number = -number;
    return true;
  }

  static uint8_t hex(char c) {
    if (c >= '0' && c <= '9') return static_cast<uint8_t>(c - '0');
    return c >= 'A' && c <= 'F' ? static_cast<uint8_t>(c - 'A' + 10) : static_cast<uint8_t>(16);
  }
};

}  // namespace awmr
