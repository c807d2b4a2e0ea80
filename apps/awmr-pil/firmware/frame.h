// Frames that host and chip exchange over a serial line; both compile this file. A frame is
//   start, type, sequence, length, payload of `length` bytes, CRC-16 of all bytes between the start
//   and the CRC (low byte first)
// The chip answers each request of the host once, with the same type and sequence number. If the
// answer is lost, the host repeats the request. The chip then repeats the answer without executing
// the request again, except kHello. Damaged frames get no answer, so the host repeats its request
// after a silence.
#pragma once

#include <stdint.h>
#include <string.h>

#include "awmr/control/crc.h"

namespace pil {

constexpr uint8_t kFrameStart = 0xA5;
constexpr uint8_t kHeadBytes = 3;  // type, sequence, length
constexpr uint8_t kMaxPayload = 140;
constexpr uint8_t kMaxFrame = kHeadBytes + kMaxPayload + 2;  // bytes after the start byte

// Types of the requests, with the payloads of request and answer. An answer has the type of its
// request.
// Hello: starts the controller anew. Request: empty. Answer: the fault bits of awmr_init() (8 bit),
// then AWMR_PARAMETERS_CRC32 xor kPilMission (32 bit). By the second number, the host detects
// firmware that was made for other inputs. kPilMission is the checksum of the generated mission.h,
// or 0 if that header has only the defaults.
constexpr uint8_t kHello = 'H';
// Follow points. Request: the acceptance radius in m, then x_m and y_m of each point. Answer:
// empty.
constexpr uint8_t kFollow = 'F';
// Execute a control step. Request: awmr_input. Answer: awmr_output, then the clock cycles of the
// step (16 bit).
constexpr uint8_t kStep = 'S';

/// Reads frames byte by byte. take() adds one byte and returns true if this byte completes a valid
/// frame. The frame can be read until the next call. If a frame is damaged, the reader searches its
/// bytes for the start byte of the next frame.
struct FrameReader {
  uint8_t bytes[kMaxFrame];  // received bytes of the present frame, after its start byte
  uint8_t count;             // number of bytes in `bytes`
  bool is_inside;            // true: a start byte was received, the frame is not complete

  uint8_t type() const { return bytes[0]; }
  uint8_t sequence() const { return bytes[1]; }
  uint8_t length() const { return bytes[2]; }
  const uint8_t* payload() const { return bytes + kHeadBytes; }

  /// Discards an incomplete frame; to be called after a silence.
  void reset() {
    is_inside = false;
    count = 0;
  }

  bool take(uint8_t byte) {
    if (!is_inside) {
      count = 0;
      is_inside = byte == kFrameStart;
      return false;
    }
    bytes[count++] = byte;
    while (is_inside && !is_incomplete()) {
      if (is_whole()) {
        is_inside = false;
        return true;
      }
      go_to_next_start();
    }
    return false;
  }

 private:
  bool is_incomplete() const {
    if (count < kHeadBytes) return true;
    return length() <= kMaxPayload && count < kHeadBytes + length() + 2;
  }
  /// True if the bytes begin with a complete frame and its CRC is right. take() then drops all
  /// bytes after this frame; such bytes exist only if a damaged frame came before.
  bool is_whole() const {
    if (length() > kMaxPayload) return false;
    const uint8_t covered = static_cast<uint8_t>(kHeadBytes + length());
    const uint16_t crc = awmr::crc16_of(bytes, covered);
    return bytes[covered] == static_cast<uint8_t>(crc & 0xFFU) &&
           bytes[covered + 1] == static_cast<uint8_t>(crc >> 8U);
  }
  void go_to_next_start() {
    uint8_t start = 0;
    while (start < count && bytes[start] != kFrameStart) ++start;
    is_inside = start < count;
    count = is_inside ? static_cast<uint8_t>(count - start - 1) : static_cast<uint8_t>(0);
    memmove(bytes, bytes + start + 1, count);
  }
};

}  // namespace pil
