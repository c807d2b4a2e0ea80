/// Frames on a disturbed line: a damaged one is rejected, the next one is accepted.
#include "firmware/frame.h"

#include <gtest/gtest.h>

#include <vector>

namespace awmr::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes framed(std::uint8_t sequence, const Bytes& payload) {
  Bytes frame{pil::kFrameStart, pil::kStep, sequence, static_cast<std::uint8_t>(payload.size())};
  frame.insert(frame.end(), payload.begin(), payload.end());
  const std::uint16_t crc = crc16_of(frame.data() + 1, frame.size() - 1);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return frame;
}

/// Sequence numbers of the frames accepted from these bytes.
std::vector<int> taken(pil::FrameReader& reader, const Bytes& bytes) {
  std::vector<int> sequences;
  for (const std::uint8_t byte : bytes) {
    if (reader.take(byte)) sequences.push_back(reader.sequence());
  }
  return sequences;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Frame, IsTakenWholeWithItsPayload) {
  pil::FrameReader reader{};
  const Bytes payload{1, pil::kFrameStart, 3};
  EXPECT_EQ(taken(reader, Bytes{9, 8} + framed(5, payload) + framed(6, {})),
            (std::vector<int>{5, 6}));
  taken(reader, framed(7, payload));
  EXPECT_EQ(Bytes(reader.payload(), reader.payload() + reader.length()), payload);
}

TEST(Frame, WithAnyOneBitFlippedIsNotTaken) {
  const Bytes good = framed(5, {1, 2, 3, 4});
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << bit % 8));
    pil::FrameReader reader{};
    EXPECT_TRUE(taken(reader, bad).empty()) << bit;
  }
}

TEST(Frame, IsFoundInsideOfADamagedOne) {
  // The first frame lost a byte, so the reader takes the first byte of the second frame for its
  // last one. The reader must still find the second frame.
  for (std::size_t lost = 0; lost < 10; ++lost) {
    Bytes bad = framed(5, {1, 2, 3, 4});
    bad.erase(bad.begin() + static_cast<std::ptrdiff_t>(lost));
    pil::FrameReader reader{};
    // If the length byte is lost, the first payload byte, 1, is read as the length.
    EXPECT_EQ(taken(reader, bad + framed(6, {7})), std::vector<int>{6}) << lost;
  }
}

TEST(Frame, WithAWrongLengthIsDroppedAtOnce) {
  pil::FrameReader reader{};
  const Bytes bad{pil::kFrameStart, pil::kStep, 1, 200};
  EXPECT_EQ(taken(reader, bad + framed(6, {7})), std::vector<int>{6});
}

TEST(Frame, ThatWasBegunIsForgottenAfterASilence) {
  pil::FrameReader reader{};
  taken(reader, {pil::kFrameStart, pil::kStep, 1, 100, 1, 2, 3});
  reader.reset();
  EXPECT_EQ(taken(reader, framed(6, {7})), std::vector<int>{6});
}

}  // namespace
}  // namespace awmr::testing
