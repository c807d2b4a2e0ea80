/// Rows of the on-board log written by the chip's own code on the emulated chip: their cost in the
/// control step, and that they read back unchanged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "awmr/trials/awl.h"
#include "pil/chip.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

// Must equal the constants of log_chip.cpp.
constexpr std::size_t kSteps = 250;
constexpr std::size_t kStallFrom = 60, kStallTo = 150;
class LogChip : public Chip {
 protected:
  void SetUp() override { run_chip("log_chip"); }
};

class StepChip : public Chip {
 protected:
  void SetUp() override { run_chip("step_chip"); }
};

TEST_F(StepChip, AStepThatDoesNotEndResetsTheChipAndIsLogged) {
  const auto log = read_awl(file_, "a.awl");
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_EQ(log->runs, 2U);
  const auto& cause = log->columns[log->columns.size() - 2];
  const auto& run = log->columns.back();
  // Complete blocks of eight rows were written before the hundredth step.
  const auto first = static_cast<std::size_t>(std::count(run.begin(), run.end(), 1.0));
  EXPECT_EQ(first, 96U);
  for (std::size_t row = 0; row < log->rows(); ++row) {
    ASSERT_EQ(cause[row], run[row] == 1.0 ? 1.0 : 8.0);  // power-on, then watchdog
    // Steps are numbered from 1, one per sample time.
    ASSERT_NEAR(log->columns[0][row],
                0.01 * static_cast<double>((row < first ? row : row - first) + 1), 1e-12);
  }
  ASSERT_EQ(log->findings.size(), 1U);
  EXPECT_EQ(log->findings[0].code, "chip-reset");
  // In each of 200 sample times of 10 ms, four ticks read the serial lines.
  const auto calls = emulator_->ram("receive_calls", 2);
  EXPECT_NEAR(calls[0] + 256 * calls[1], 4 * 200, 4);
}

TEST_F(LogChip, ARowTakesAFewHundredCyclesOfTheStep) {
  const auto bytes = emulator_->ram("log_cycles_max", 2);
  const unsigned cycles = bytes[0] + 256U * bytes[1];
  std::cout << "a row of the log: " << cycles << " cycles at most, " << emulator_->ram_bytes()
            << " bytes of RAM with the ring\n";
  RecordProperty("cycles", std::to_string(cycles));
  EXPECT_GT(cycles, 100U);  // lower limit: storing 56 bytes takes two cycles each
  EXPECT_LT(cycles, 600U);
}

TEST_F(LogChip, RowsReadBackAsTheyWereAndThoseOfAStallAreCounted) {
  const auto log = read_awl(file_, "a.awl");
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_EQ(log->parameters_sha256, params_sha256(paper_inputs()));
  // The stall takes 90 sample times. The ring buffers 64 rows, minus those of an incomplete block
  // that it already contains. Writing the block after the stall takes one sample time.
  EXPECT_GE(log->lost, kStallTo - kStallFrom - 64);
  EXPECT_LE(log->lost, kStallTo - kStallFrom - 56 + 1);
  EXPECT_EQ(log->rows(), kSteps - log->lost);
  EXPECT_EQ(log->damaged_bytes, 0U);
  ASSERT_EQ(log->findings.size(), 1U);
  EXPECT_EQ(log->findings[0].code, "rows-lost");
  EXPECT_THAT(log->findings[0].message, HasSubstr("no room"));

  const auto column = [&](const std::string& name) -> const std::vector<double>& {
    const auto at = std::find(log->header.begin(), log->header.end(), name);
    return log->columns.at(static_cast<std::size_t>(at - log->header.begin()));
  };
  const double degree = 180.0 / std::acos(-1.0);
  for (std::size_t row = 0; row < log->rows(); ++row) {
    const double step = std::round(column("t_s")[row] * 100.0);
    const auto number = [&](int i) { return 0.125 * step + i; };  // exact in float
    ASSERT_EQ(column("force_left")[row], number(1));
    ASSERT_EQ(column("force_right")[row], -number(2));
    ASSERT_DOUBLE_EQ(column("steering_cmd_deg")[row], number(3) * degree);
    ASSERT_EQ(column("x_m")[row], number(4));
    ASSERT_EQ(column("y_m")[row], number(5));
    ASSERT_DOUBLE_EQ(column("heading_deg")[row], number(6) * degree);
    ASSERT_EQ(column("speed_mps")[row], number(7));
    ASSERT_EQ(column("yaw_rate_radps")[row], number(8));
    ASSERT_DOUBLE_EQ(column("heading_ref_deg")[row], number(9) * degree);
    ASSERT_EQ(column("speed_ref_mps")[row], number(10));
    ASSERT_EQ(column("tau_speed")[row], number(11));
    ASSERT_EQ(column("tau_turn_m")[row], number(12));
    ASSERT_EQ(column("mode")[row], std::fmod(step, 3.0));
    const double sensor_fault = std::fmod(step, 18.0);
    ASSERT_EQ(column("limits")[row],
              4.0 * std::fmod(step, 2.0) + 16.0 * std::fmod(sensor_fault, 16.0));
    ASSERT_EQ(column("reset_cause")[row], sensor_fault < 16.0 ? 1.0 : 129.0);
    ASSERT_EQ(column("run")[row], 1.0);
  }
}

}  // namespace
}  // namespace awmr::testing
