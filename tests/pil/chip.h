/// Programs of tests/pil on the emulated ATmega2560, built with the emitted library.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "emit/paper_robot.h"
#include "emulator.h"
#include "support/toolchain.h"

namespace awmr::testing {

class Chip : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kCyclesMax = 160'000'000;  // 10 s of the chip's time

  /// Builds tests/pil/PROGRAM.cpp with the emitted library and runs it until it sets its variable
  /// log_done.
  void run_chip(const std::string& program, const std::string& flags = "") {
    ASSERT_TRUE(found(kAvrGxx));
    write_library(directory_.path());
    ASSERT_TRUE(succeeded(
        run_process(std::string(kAvrGxx) +
                        " -mmcu=atmega2560 -DF_CPU=16000000UL -std=c++11 -Os -Wall -Wextra "
                        "-Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror -Isrc " +
                        flags + "'" AWMR_SOURCE_DIR "/tests/pil/" + program + ".cpp' -o log.elf",
                    directory_.path())));
    auto emulator = pil::Emulator::load(directory_.path() / "log.elf");
    ASSERT_TRUE(emulator) << to_text(emulator.error());
    emulator_ = std::move(*emulator);
    emulator_->on_uart_output([this](std::uint8_t byte) { file_ += static_cast<char>(byte); });
    emulator_->connect_uart();
    const auto done = emulator_->ram("log_done", 1);
    const auto ran = emulator_->run_until([&] { return done[0] != 0; }, kCyclesMax);
    ASSERT_TRUE(ran) << to_text(ran.error());
  }

  TemporaryDirectory directory_;
  std::unique_ptr<pil::Emulator> emulator_;
  std::string file_;
};

}  // namespace awmr::testing
