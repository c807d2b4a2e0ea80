/// Ring buffer for log rows. The control step, which must not wait, writes rows into it. The idle
/// loop stores them on a card, which can block for a quarter of a second. Freestanding C++11.
///
/// The writer (the control step, an interrupt) and the reader (the idle loop) need no lock. Each of
/// them changes only its own counter. A counter is a byte, which an 8-bit processor reads and
/// writes atomically.
#pragma once

#include <stdint.h>

#include "awmr/control/log_row.h"

namespace awmr {

/// Rows of 64 bytes per card block of 512 bytes.
constexpr uint8_t kLogBlockRows = 8;

/// A ring of kBlocks blocks of 512 bytes. At one row per sample time, no row is lost while the card
/// is busy for up to (kBlocks - 1) * 8 sample times: 0.56 s with 8 blocks and 10 ms.
template <uint8_t kBlocks>
class LogRing {
  static_assert(kBlocks >= 2 && kBlocks <= 16 && (kBlocks & (kBlocks - 1)) == 0,
                "kBlocks must be 2, 4, 8 or 16: one-byte counters number the rows, modulo 256");

 public:
  /// Returns the row to fill in. If the ring is full, returns 0: this row is lost, and its sequence
  /// number is missing in the log.
  LogRow* begin_row() {
    const uint32_t sequence = sequence_++;
    if (static_cast<uint8_t>(written_ - read_) == kRows) return 0;
    LogRow& row = rows_[written_ & kMask];
    row.sequence = sequence;
    return &row;
  }
  /// Makes the row of begin_row() available to the reader.
  void end_row() {
    barrier();
    written_ = static_cast<uint8_t>(written_ + 1);
  }

  /// Number of rows that can be read now: the remaining rows of the current block once it is
  /// complete, else 0. With `rest`, also the complete rows of an incomplete block.
  uint8_t ready(bool rest = false) const {
    const uint8_t there = static_cast<uint8_t>(written_ - read_);
    const uint8_t whole = static_cast<uint8_t>(kLogBlockRows - read_ % kLogBlockRows);
    if (there >= whole) return whole;
    return rest ? there : static_cast<uint8_t>(0);
  }
  /// Computes the check sums of the next `count` ready rows and returns the first; the others
  /// follow it in memory.
  const LogRow* sealed(uint8_t count) {
    barrier();
    LogRow* first = rows_ + (read_ & kMask);
    for (uint8_t i = 0; i < count; ++i) seal(first[i]);
    return first;
  }
  /// Frees the space of these `count` rows for writing.
  void release(uint8_t count) {
    barrier();
    read_ = static_cast<uint8_t>(read_ + count);
  }

 private:
  static constexpr uint8_t kRows = static_cast<uint8_t>(kBlocks * kLogBlockRows);
  static constexpr uint8_t kMask = static_cast<uint8_t>(kRows - 1);

  /// Prevents the compiler from moving row accesses across counter accesses.
  static void barrier() { __asm__ volatile("" ::: "memory"); }

  LogRow rows_[kRows];
  uint32_t sequence_ = 0;
  volatile uint8_t written_ = 0;  ///< rows written since the start, modulo 256
  volatile uint8_t read_ = 0;     ///< rows released since the start, modulo 256
};

}  // namespace awmr
