/// Fuzz target: uses the bytes as data on the serial line to the chip. Only complete frames with
/// the right checksum are accepted, and an exchange with a chip that sends these bytes ends.
#include "firmware/frame.h"

#include <algorithm>
#include <memory>
#include <span>

#include "frame_link.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

namespace {

/// Line to a simulated chip that sends the given bytes, whatever the requests are, and then
/// nothing.
class Recording : public awmr::pil::Line {
 public:
  explicit Recording(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  awmr::Status open() override { return {}; }
  awmr::Status reset() override { return {}; }
  awmr::Status send(std::span<const std::uint8_t> bytes) override {
    require(bytes.size() <= pil::kMaxFrame + 1U, "a request fits the chip's buffer");
    return {};
  }
  awmr::Result<std::optional<std::uint8_t>> receive(awmr::pil::Patience) override {
    if (at_ == bytes_.size()) return std::optional<std::uint8_t>();
    return std::optional(bytes_[at_++]);
  }
  awmr::pil::ChipFigures figures() const override { return {}; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Checks that the reader accepts a frame only if its checksum matches.
void check_reader(std::span<const std::uint8_t> bytes) {
  pil::FrameReader reader{};
  for (const std::uint8_t byte : bytes) {
    if (!reader.take(byte)) continue;
    require(reader.length() <= pil::kMaxPayload, "a payload fits its buffer");
    const std::size_t covered = pil::kHeadBytes + reader.length();
    const std::uint16_t crc = awmr::crc16_of(reader.bytes, covered);
    require(reader.bytes[covered] == (crc & 0xFFU) && reader.bytes[covered + 1] == crc >> 8U,
            "an accepted frame has the right checksum");
  }
}

/// Checks that a valid frame is read after any other bytes on the line.
void check_written(std::span<const std::uint8_t> bytes) {
  const auto length = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 140));
  pil::FrameReader reader{};
  reader.take(pil::kFrameStart);
  std::uint16_t crc = awmr::kCrc16Start;
  const auto take = [&](std::uint8_t byte) {
    require(!reader.take(byte), "no frame is complete before its checksum");
    crc = awmr::crc16_with(crc, byte);
  };
  take(pil::kStep);
  take(7);
  take(length);
  for (std::size_t i = 0; i < length; ++i) take(bytes[i]);
  require(!reader.take(static_cast<std::uint8_t>(crc & 0xFFU)), "a checksum has two bytes");
  require(reader.take(static_cast<std::uint8_t>(crc >> 8U)), "a complete frame is accepted");
  require(std::equal(reader.payload(), reader.payload() + length, bytes.begin()),
          "the payload is as sent");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  check_reader(bytes);
  check_written(bytes);
  const auto chip = awmr::pil::frame_link(std::make_unique<Recording>(bytes), 0x12345678U);
  (void)chip->start();
  (void)chip->follow({.points_m = {{1.0F, 2.0F}}, .acceptance_m = 1.0F});
  (void)chip->step({});
  (void)chip->reset();
  (void)chip->step({});
  return 0;
}
