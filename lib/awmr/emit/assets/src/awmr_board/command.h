/* What is typed: lines of a letter and perhaps a number, "H 30", over Serial. */
#ifndef AWMR_BOARD_COMMAND_H
#define AWMR_BOARD_COMMAND_H

#include <stdlib.h>

namespace awmr_board {

class Command {
 public:
  char letter = '\0';
  float value = 0.0f;    /* 0 where there is none */
  uint32_t heard_ms = 0; /* when the last character came; 0: none yet */

  /* True: a line is complete. Never waits. */
  bool read() {
    while (Serial.available() > 0) {
      const char c = static_cast<char>(Serial.read());
      heard_ms = millis();
      if (c != '\n' && c != '\r') {
        if (length_ < sizeof line_ - 1) line_[length_++] = c;
        continue;
      }
      if (length_ == 0) continue;
      line_[length_] = '\0';
      length_ = 0;
      letter = line_[0];
      value = static_cast<float>(atof(line_ + 1));
      return true;
    }
    return false;
  }

 private:
  char line_[16];
  uint8_t length_ = 0;
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_COMMAND_H */
