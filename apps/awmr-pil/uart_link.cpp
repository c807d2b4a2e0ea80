#include <fmt/format.h>

#include "emulator.h"
#include "frame_link.h"

namespace awmr::pil {
namespace {

/// A request at 500 kbit/s takes 25,000 cycles, a step 24,000, an answer 12,000; ten times that.
constexpr std::uint64_t kAnswerCycles = 16'000'000;

class EmulatedLine : public Line {
 public:
  explicit EmulatedLine(std::unique_ptr<Emulator> emulator) : emulator_(std::move(emulator)) {
    emulator_->on_uart_output([this](std::uint8_t byte) { received_.push_back(byte); });
    emulator_->connect_uart();
  }

  Status open() override {
    if (auto asleep = emulator_->run_to_sleep(kAnswerCycles); !asleep) return asleep;
    emulator_->paint_stack();
    return {};
  }
  Status send(std::span<const std::uint8_t> bytes) override {
    emulator_->send_to_uart(bytes);
    return {};
  }
  Result<std::uint8_t> receive() override {
    if (auto ran = emulator_->run_until([this] { return at_ < received_.size(); }, kAnswerCycles);
        !ran) {
      return tl::unexpected(ran.error());
    }
    const std::uint8_t byte = received_[at_++];
    if (at_ == received_.size()) {
      received_.clear();
      at_ = 0;
    }
    return byte;
  }
  ChipFigures figures() const override {
    return {emulator_->flash_bytes(), emulator_->ram_bytes(), emulator_->stack_bytes()};
  }

 private:
  std::unique_ptr<Emulator> emulator_;
  std::vector<std::uint8_t> received_;
  std::size_t at_ = 0;
};

}  // namespace

Result<std::unique_ptr<Chip>> uart_link(const std::filesystem::path& elf, bool damage_parameters,
                                        std::uint32_t parameters_crc) {
  auto emulator = Emulator::load(elf);
  if (!emulator) return tl::unexpected(emulator.error());
  if (damage_parameters) (*emulator)->flash("awmr_parameters", 1)[0] ^= 0x01U;
  return frame_link(std::make_unique<EmulatedLine>(std::move(*emulator)), parameters_crc);
}

}  // namespace awmr::pil
