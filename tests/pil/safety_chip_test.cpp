/// Sensor checks, commands, arming and the direction of the speed on the emulated chip: the host's
/// bits, and the cost.
#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

#include "awmr/emit/board/sensor_fault.h"
#include "pil/chip.h"

namespace awmr::testing {
namespace {

class SafetyChip : public Chip {
 protected:
  void SetUp() override { run_chip("safety_chip", "-I'" AWMR_SOURCE_DIR "/tests/pil' -Isrc "); }
  unsigned word(const char* name) const {
    const auto bytes = emulator_->ram(name, 2);
    return bytes[0] + 256U * bytes[1];
  }
};

/// The same sequence on the host, with the library that the chip uses.
constexpr const char* kSafetyHost = R"(#include <stdio.h>
#include "safety_sequence.h"
static safety_sequence::Sequence sequence;
static const awmr_point points[] = {{10.0f, 2.0f}, {100.0f, -5.0f}};
int main() {
  safety_sequence::begin(sequence);
  if (awmr_init() != 0) return 1;
  awmr_follow(points, 2, 1.0f);
  for (uint16_t number = 0; number < safety_sequence::kSteps; ++number) {
    safety_sequence::prepare(sequence, number);
    safety_sequence::step(sequence, number);
    awmr_step(&sequence.input, &sequence.output);
    safety_sequence::finish(sequence);
  }
  printf("%lu %u", (unsigned long)sequence.hash, sequence.disarmed);
  for (int i = 0; i < awmr::kSensorFaultCount; ++i) printf(" %u", sequence.causes[i]);
  return 0;
}
)";

TEST_F(SafetyChip, SensorChecksCommandsArmingAndDirectionGiveTheHostsBitsWithinTheirBudgets) {
  write_all(directory_.path() / "host.cpp", kSafetyHost);
  ASSERT_TRUE(succeeded(
      run_process(std::string(kGxx) + " -O2 -std=c++14 -ffp-contract=off -Isrc -I'" AWMR_SOURCE_DIR
                                      "/tests/pil' host.cpp src/awmr.cpp -o host",
                  directory_.path())));
  std::istringstream host(run_process("./host", directory_.path()).out);
  unsigned long hash = 0;
  unsigned disarmed = 0;
  host >> hash >> disarmed;
  const auto bytes = emulator_->ram("safety_hash", 4);
  EXPECT_EQ(
      bytes[0] | bytes[1] << 8U | bytes[2] << 16U | static_cast<unsigned long>(bytes[3]) << 24U,
      hash);
  EXPECT_EQ(emulator_->ram("safety_disarmed", 1)[0], disarmed);
  EXPECT_GE(disarmed, 6U);
  const auto causes = emulator_->ram("safety_causes", kSensorFaultCount);
  for (std::size_t i = 0; i < kSensorFaultCount; ++i) {
    unsigned steps = 0;
    host >> steps;
    EXPECT_EQ(causes[i], steps) << i;
    // The sequence must trigger these faults.
    for (const std::size_t seen : {0, 2, 3, 4, 5, 7, 10, 12}) {
      if (seen == i) {
        EXPECT_GT(steps, 0U) << i;
      }
    }
  }
  const unsigned step = word("safety_step_cycles");
  const unsigned whole = word("safety_whole_cycles");
  const unsigned fix = word("safety_fix_cycles");
  std::cout << "step to waypoints with the direction of the speed " << step
            << " cycles at most, with sensor checks and commands " << whole
            << ", while a fix is worked on " << fix << "; " << emulator_->flash_bytes()
            << " bytes of flash, " << emulator_->ram_bytes() << " of RAM\n";
  // The budget of a step is 20,000 cycles. The bounds are those of avr-gcc 5.4 plus 1 %.
  EXPECT_LE(step, 16830U);
  EXPECT_LE(whole, 19130U);
  EXPECT_LE(fix, 19950U);
  EXPECT_LE(emulator_->flash_bytes(), 29050U);
  EXPECT_LE(emulator_->ram_bytes(), 1012U);
}

}  // namespace
}  // namespace awmr::testing
