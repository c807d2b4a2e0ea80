#include <fmt/format.h>

#include <optional>

#include "awmr/core/random.h"
#include "emulator.h"
#include "frame_link.h"

namespace awmr::pil {
namespace {

/// Timeout of the start, in clock cycles.
constexpr auto kLineStartCycles = static_cast<std::uint64_t>(kStartTimeout_s * kChipClock_Hz);
/// Timeout of an answer, in clock cycles: 30 ms. A request, its control step and its answer take 3
/// ms. But the timeout must also exceed the pause of 20 ms after which the chip discards an
/// incomplete frame. With a shorter timeout, the chip would read the repeated request as a part of
/// that frame.
constexpr std::uint64_t kLineAnswerCycles = 480'000;

/// Simulates a noisy line. A fraction `share` of the bytes is lost, and the same fraction of the
/// bits of the other bytes is flipped, in a deterministic sequence.
class Noise {
 public:
  explicit Noise(double share) : share_(share) {}

  /// Returns the byte as received, or nothing if it is lost.
  std::optional<std::uint8_t> after(std::uint8_t byte) {
    if (share_ <= 0.0) return byte;
    if (random_.uniform() < share_) return std::nullopt;
    for (unsigned bit = 0; bit < 8; ++bit) {
      if (random_.uniform() < share_) byte = static_cast<std::uint8_t>(byte ^ (1U << bit));
    }
    return byte;
  }

 private:
  double share_;
  Random random_{1, 0};
};

class EmulatedLine : public Line {
 public:
  EmulatedLine(std::unique_ptr<Emulator> emulator, double noise)
      : emulator_(std::move(emulator)), noise_(noise) {
    emulator_->on_uart_output([this](std::uint8_t byte) {
      if (const auto arrived = noise_.after(byte)) received_.push_back(*arrived);
    });
    emulator_->connect_uart();
  }

  Status open() override {
    AWMR_RETURN_IF_ERROR(emulator_->run_to_sleep(kLineStartCycles));
    emulator_->paint_stack();
    return {};
  }
  Status reset() override {
    emulator_->reset();
    received_.clear();
    at_ = 0;
    return {};
  }
  Status send(std::span<const std::uint8_t> bytes) override {
    std::vector<std::uint8_t> arriving;
    for (const std::uint8_t byte : bytes) {
      if (const auto arrived = noise_.after(byte)) arriving.push_back(*arrived);
    }
    emulator_->send_to_uart(arriving);
    return {};
  }
  Result<std::optional<std::uint8_t>> receive(Patience patience) override {
    const std::uint64_t end =
        emulator_->cycles() + (patience == Patience::kStart ? kLineStartCycles : kLineAnswerCycles);
    const auto done = [&] { return at_ < received_.size() || emulator_->cycles() >= end; };
    AWMR_RETURN_IF_ERROR(emulator_->run_until(done, 2 * kLineStartCycles));
    if (at_ == received_.size()) return std::optional<std::uint8_t>();
    const std::uint8_t byte = received_[at_++];
    if (at_ == received_.size()) {
      received_.clear();
      at_ = 0;
    }
    return std::optional(byte);
  }
  ChipFigures figures() const override {
    return {.flash_bytes = emulator_->flash_bytes(),
            .ram_bytes = emulator_->ram_bytes(),
            .stack_bytes = emulator_->stack_bytes()};
  }

 private:
  std::unique_ptr<Emulator> emulator_;
  Noise noise_;
  std::vector<std::uint8_t> received_;
  std::size_t at_ = 0;
};

}  // namespace

Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc, double noise) {
  auto emulator = Emulator::load(elf);
  if (!emulator) return tl::unexpected(emulator.error());
  if (damage_parameters) (*emulator)->flash("awmr_parameters", 1)[0] ^= 0x01U;
  return frame_link(std::make_unique<EmulatedLine>(std::move(*emulator), noise), parameters_crc);
}

}  // namespace awmr::pil
