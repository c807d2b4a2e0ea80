/// Rows of the log between the control step, which must not wait, and a card, which may make its
/// writer wait for a quarter of a second. Freestanding C++11.
///
/// One writer (the control step, an interrupt) and one reader (the idle loop) need no lock: each
/// changes its own counter, a byte, which an 8-bit processor reads and writes at once.
#pragma once

#include <stdint.h>

#include "awmr/control/log_row.h"

namespace awmr {

/// Rows in a block of a card.
constexpr uint8_t kLogBlockRows = 8;

/// kBlocks of 512 bytes. At a row each sample time it bridges (kBlocks - 1) * 8 sample times in
/// which nothing is written: 0.56 s with 8 blocks at 10 ms.
template <uint8_t kBlocks>
class LogRing {
  static_assert(kBlocks >= 2 && kBlocks <= 16 && (kBlocks & (kBlocks - 1)) == 0,
                "2, 4, 8 or 16 blocks: counters of a byte run through all rows");

 public:
  /// The row to fill in, or 0 where there is no room: it is lost, and the gap in the sequence shows
  /// it.
  LogRow* begin_row() {
    const uint32_t sequence = sequence_++;
    if (static_cast<uint8_t>(written_ - read_) == kRows) return 0;
    LogRow& row = rows_[written_ & kMask];
    row.sequence = sequence;
    return &row;
  }
  /// The row is whole.
  void end_row() {
    barrier();
    written_ = static_cast<uint8_t>(written_ + 1);
  }

  /// How many rows can be taken at once: those up to the end of a block, when all of them are
  /// there; with `rest` those that are.
  uint8_t ready(bool rest = false) const {
    const uint8_t there = static_cast<uint8_t>(written_ - read_);
    const uint8_t whole = static_cast<uint8_t>(kLogBlockRows - read_ % kLogBlockRows);
    if (there >= whole) return whole;
    return rest ? there : static_cast<uint8_t>(0);
  }
  /// The first of `count` rows that are ready, in one piece, sealed.
  const LogRow* sealed(uint8_t count) {
    barrier();
    LogRow* first = rows_ + (read_ & kMask);
    for (uint8_t i = 0; i < count; ++i) seal(first[i]);
    return first;
  }
  /// Their place may be written again.
  void release(uint8_t count) {
    barrier();
    read_ = static_cast<uint8_t>(read_ + count);
  }

 private:
  static constexpr uint8_t kRows = static_cast<uint8_t>(kBlocks * kLogBlockRows);
  static constexpr uint8_t kMask = static_cast<uint8_t>(kRows - 1);

  /// The compiler moves no access to a row past its counter's.
  static void barrier() { __asm__ volatile("" ::: "memory"); }

  LogRow rows_[kRows];
  uint32_t sequence_ = 0;
  volatile uint8_t written_ = 0;  ///< rows since the start, modulo 256
  volatile uint8_t read_ = 0;
};

}  // namespace awmr
