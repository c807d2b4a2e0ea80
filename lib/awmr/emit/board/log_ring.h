/// Ring buffer for log rows. The control step, which must not wait, writes the rows into the
/// buffer. The idle loop copies them to a card, which can block for a quarter of a second.
/// Freestanding C++11.
///
/// The writer (the control step, an interrupt) and the reader (the idle loop) need no lock: each
/// changes only its own counter. A counter is one byte, which an 8-bit processor reads and writes
/// atomically.
#pragma once

#include <stdint.h>

#include "awmr/trials/awl_row.h"

namespace awmr {

/// Number of log rows, 64 bytes each, in a block of the card, 512 bytes.
constexpr uint8_t kLogBlockRows = 8;

/// A ring buffer of kBlocks blocks of 512 bytes (8 rows). If the sketch adds one row per sample
/// time, no row is lost while the card is busy for up to (kBlocks - 1) * 8 sample times: 0.56 s for
/// 8 blocks and 10 ms.
template <uint8_t kBlocks>
class LogRing {
  static_assert(kBlocks >= 2 && kBlocks <= 16 && (kBlocks & (kBlocks - 1)) == 0,
                "kBlocks must be 2, 4, 8 or 16: one-byte counters number the rows, modulo 256");

 public:
  /// Returns the next row, which the caller fills in. If the buffer is full, returns null: the row
  /// is lost, and its sequence number is missing in the log.
  LogRow* begin_row() {
    const uint32_t sequence = sequence_++;
    if (static_cast<uint8_t>(written_ - read_) == kRows) return 0;
    LogRow& row = rows_[written_ & kMask];
    row.sequence = sequence;
    return &row;
  }
  /// Makes the row that begin_row() returned available to the reader.
  void end_row() {
    barrier();
    written_ = static_cast<uint8_t>(written_ + 1);
  }

  /// Returns the number of rows that can be read now: the remaining rows of the current block if it
  /// is complete, else 0. With `rest`, rows of an incomplete block can also be read.
  uint8_t ready(bool rest = false) const {
    const uint8_t there = static_cast<uint8_t>(written_ - read_);
    const uint8_t whole = static_cast<uint8_t>(kLogBlockRows - read_ % kLogBlockRows);
    if (there >= whole) return whole;
    return rest ? there : static_cast<uint8_t>(0);
  }
  /// Computes the check sums of the next `count` ready rows, which are adjacent in memory. Returns
  /// the first row.
  const LogRow* sealed(uint8_t count) {
    barrier();
    LogRow* first = rows_ + (read_ & kMask);
    for (uint8_t i = 0; i < count; ++i) seal(first[i]);
    return first;
  }
  /// Returns the space of the oldest `count` rows to the writer.
  void release(uint8_t count) {
    barrier();
    read_ = static_cast<uint8_t>(read_ + count);
  }

 private:
  static constexpr uint8_t kRows = static_cast<uint8_t>(kBlocks * kLogBlockRows);
  static constexpr uint8_t kMask = static_cast<uint8_t>(kRows - 1);

  /// Prevents the compiler from moving an access to a row past an access to a counter.
  static void barrier() { __asm__ volatile("" ::: "memory"); }

  LogRow rows_[kRows];
  uint32_t sequence_ = 0;
  volatile uint8_t written_ = 0;  ///< rows written since the start, modulo 256
  volatile uint8_t read_ = 0;     ///< rows released since the start, modulo 256
};

}  // namespace awmr
