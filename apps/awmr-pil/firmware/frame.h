// The frames that host and chip exchange over a serial line; both compile this file.
//   start, type, length, payload of `length` bytes, CRC-16 of type, length and payload (low byte first)
// The host asks, the chip answers each request once. A frame that is damaged is not answered.
#pragma once

#include <stdint.h>

#include "awmr/control/crc.h"

namespace pil {

constexpr uint8_t kFrameStart = 0xA5;
constexpr uint8_t kMaxPayload = 140;

// Requests and what is in them; the answer has the same type.
constexpr uint8_t kHello = 'H';   // nothing -> awmr_init()'s fault, AWMR_PARAMETERS_CRC32
constexpr uint8_t kFollow = 'F';  // acceptance_m, points as x_m, y_m -> nothing
constexpr uint8_t kStep = 'S';    // awmr_input -> awmr_output, cycles (16 bit)

/// Takes bytes as they come; true when the last one completed a whole frame.
struct FrameReader {
  uint8_t type;
  uint8_t length;
  uint8_t payload[kMaxPayload];
  uint8_t count;  // bytes seen of this frame: 0 waits for the start
  uint16_t crc;

  bool take(uint8_t byte) {
    if (count == 0) {
      if (byte == kFrameStart) begin();
      return false;
    }
    const uint8_t place = count++;
    if (place == 1) {
      type = byte;
      crc = awmr::crc16_with(crc, byte);
    } else if (place == 2) {
      length = byte;
      crc = awmr::crc16_with(crc, byte);
      if (length > kMaxPayload) count = 0;
    } else if (place < 3 + length) {
      payload[place - 3] = byte;
      crc = awmr::crc16_with(crc, byte);
    } else if (place == 3 + length) {
      if (byte != static_cast<uint8_t>(crc & 0xFFU)) count = 0;
    } else {
      count = 0;
      return byte == static_cast<uint8_t>(crc >> 8U);
    }
    return false;
  }

 private:
  void begin() {
    count = 1;
    crc = awmr::kCrc16Start;
  }
};

}  // namespace pil
