/* The log on the card: LOG00.AWL and following, for `awmr log` and `awmr identify --log`. On a
   board without a card, begin() returns false and the sketch reports that there is no log. */
#ifndef AWMR_BOARD_CARD_H
#define AWMR_BOARD_CARD_H

#include "steps.h"
#if AWMR_BOARD_HAS_CARD
#include "../awmr_log.h"
#endif

namespace awmr_board {

#if AWMR_BOARD_HAS_CARD
/* Creates the first file of NAME00 to NAME99 that does not exist. name_and_extension: "LOG00.AWL".
   Returns an invalid File if all exist. */
inline File next_file(const char* name_and_extension) {
  char name[13];
  strncpy(name, name_and_extension, sizeof name - 1);
  name[sizeof name - 1] = '\0';
  char* digits = strchr(name, '0');
  for (uint8_t i = 0; i < 100 && digits != 0; ++i) {
    digits[0] = static_cast<char>('0' + i / 10);
    digits[1] = static_cast<char>('0' + i % 10);
    if (!SD.exists(name)) return SD.open(name, FILE_WRITE);
  }
  return File();
}

class Log {
 public:
  /* Call in setup(). False: there is no card, or no name is left. */
  bool begin() {
    if (!SD.begin(kSdSelectPin)) return false;
    file_ = next_file("LOG00.AWL");
    return file_ && awmr_log::write_header(file_) && awmr_log::write_header(file_);
  }

  /* Call in the step: adds a row to the ring buffer. Never waits. */
  void put(const awmr_input& in, const awmr_output& out, uint8_t sensor_fault = 0) {
    awmr_log::put(ring_, in, out, step_number(), reset_cause(), sensor_fault);
  }

  /* Call in loop(): writes a complete block and waits for the card if necessary. Also flushes the
     file after every 16th block (1.3 s at 10 ms), so that the data survive a loss of power. */
  void drain() {
    if (!file_ || awmr_log::drain(ring_, file_) != awmr_log::kWritten) return;
    if (++blocks_ % kBlocksPerFlush == 0) file_.flush();
  }

 private:
  static const uint8_t kBlocksPerFlush = 16;
  awmr_log::Ring ring_;
  File file_;
  uint16_t blocks_ = 0;
};
#else
class Log {
 public:
  bool begin() { return false; }
  void put(const awmr_input&, const awmr_output&, uint8_t = 0) {}
  void drain() {}
};
#endif

}  // namespace awmr_board

#endif /* AWMR_BOARD_CARD_H */
