#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/emit/emit.h"
#include "emulator.h"
#include "executor.h"
#include "wire.h"

namespace awmr::pil {
namespace {

/// Time limit for the chip to go to sleep, in clock cycles. The longest wait is that at the start.
constexpr auto kStartCycles = static_cast<std::uint64_t>(kStartTimeout_s * kChipClock_Hz);

class MemoryLink : public Chip {
 public:
  explicit MemoryLink(std::unique_ptr<Emulator> emulator) : emulator_(std::move(emulator)) {}

  Result<std::uint8_t> start() override {
    AWMR_ASSIGN_OR_RETURN(const std::uint8_t fault, boot());
    emulator_->paint_stack();
    input_ = emulator_->ram("pil_input", kInputBytes);
    output_ = emulator_->ram("pil_output", kOutputBytes);
    steps_ = emulator_->ram("pil_steps", 1);
    return fault;
  }

  Status reset() override {
    emulator_->reset();
    AWMR_RETURN_IF_ERROR(boot());
    if (!points_.points_m.empty()) AWMR_RETURN_IF_ERROR(follow(points_));
    is_reset_ = true;
    return {};
  }

  Status follow(const Points& points) override {
    if (points.points_m.size() > kMaxPoints) {
      return input_error(ErrorCode::kTooLarge, "",
                         fmt::format("the firmware stores at most {} waypoints, found {}; use "
                                     "fewer",
                                     kMaxPoints, points.points_m.size()));
    }
    Writer writer;
    for (const Position<float>& point : points.points_m) writer.put(point.x_m).put(point.y_m);
    put("pil_points", writer);
    // The variable pil_acceptance_m exists only in firmware that follows waypoints. A line has no
    // acceptance radius.
    if (points.acceptance_m > 0.0F) put("pil_acceptance_m", Writer().put(points.acceptance_m));
    put("pil_point_count", Writer().put(static_cast<std::int16_t>(points.points_m.size())));
    points_ = points;
    return {};
  }

  /// Executes one step. The host may write the input now: the chip sleeps since its last step, so
  /// it cannot read a half-written input.
  Result<Step> step(const AutopilotInput& input) override {
    const std::vector<std::uint8_t> bytes = pack(input);
    std::copy(bytes.begin(), bytes.end(), input_.begin());
    const std::uint8_t before = steps_[0];
    while (steps_[0] == before) AWMR_RETURN_IF_ERROR(run_to_sleep());
    return Step{unpack(output_), emulator_->last_interrupt_cycles(),
                std::exchange(is_reset_, false)};
  }

  ChipFigures figures() const override {
    return {.flash_bytes = emulator_->flash_bytes(),
            .ram_bytes = emulator_->ram_bytes(),
            .stack_bytes = emulator_->stack_bytes()};
  }

 private:
  /// Lets the firmware start, up to its first sleep, and returns the fault of its start-up check.
  Result<std::uint8_t> boot() {
    AWMR_RETURN_IF_ERROR(run_to_sleep());
    return emulator_->ram("pil_init_fault", 1)[0];
  }

  /// Lets the chip run until it sleeps. Errors (input): the chip never sleeps, because a control
  /// step takes longer than the sample time.
  Status run_to_sleep() {
    const std::uint64_t begin = emulator_->cycles();
    const Status asleep = emulator_->run_to_sleep(kStartCycles);
    if (asleep || emulator_->cycles() - begin <= kStartCycles) return asleep;
    return input_error(
        ErrorCode::kTooLarge, "",
        fmt::format("a control step does not fit in the sample time: the chip was "
                    "busy for {} cycles ({:.1f} s) without a pause. Give "
                    "vehicle.json a longer sample_time_s and identify again",
                    kStartCycles, static_cast<double>(kStartCycles) / kChipClock_Hz));
  }

  void put(const std::string& symbol, const Writer& writer) {
    std::copy(writer.bytes().begin(), writer.bytes().end(),
              emulator_->ram(symbol, writer.bytes().size()).begin());
  }

  std::unique_ptr<Emulator> emulator_;
  std::span<std::uint8_t> input_;
  std::span<std::uint8_t> output_;
  std::span<std::uint8_t> steps_;
  Points points_;
  bool is_reset_ = false;
};

}  // namespace

Result<std::unique_ptr<Chip>> memory_link(const std::filesystem::path& elf,
                                          bool damage_parameters) {
  auto emulator = Emulator::load(elf);
  if (!emulator) return tl::unexpected(emulator.error());
  if (damage_parameters) (*emulator)->flash("awmr_parameters", 1)[0] ^= 0x01U;
  return std::make_unique<MemoryLink>(std::move(*emulator));
}

}  // namespace awmr::pil
