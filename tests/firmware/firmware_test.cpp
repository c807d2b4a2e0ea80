/// The emitted header and the simulator's controller, built and linked for the ATmega2560.
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <sstream>

#include "emit/paper_robot.h"
#include "support/toolchain.h"

namespace awmr::testing {
namespace {

// Size with avr-gcc 5.4, 10,622 and 50 bytes, plus 1 %; the chip has 262,144 and 8,192.
constexpr long kFlashBytesMax = 10730;
constexpr long kRamBytesMax = 51;  // without the stack

class Firmware : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(found(kAvrGxx));
    ASSERT_TRUE(found(kAvrSize));
    write_all(directory_.path() / "awmr_params.h",
              params_header(paper_robot(), kPaperGains, paper_inputs()).value());
  }

  ProcessResult avr_gxx(const std::string& options) const {
    return run_process(std::string("'") + kAvrGxx +
                           "' -mmcu=atmega2560 -std=c++14 -Os -ffunction-sections -fdata-sections "
                           "-Wall -Wextra -Wpedantic -Wshadow -Werror -I. -I'" AWMR_SOURCE_DIR
                           "/lib' -I'" AWMR_SOURCE_DIR "/tests' " +
                           options,
                       directory_.path());
  }

  /// Bytes by section, as `avr-size -A` lists them.
  std::map<std::string, long> section_sizes(const std::string& file) const {
    const ProcessResult sized =
        run_process(std::string("'") + kAvrSize + "' -A " + file, directory_.path());
    EXPECT_TRUE(succeeded(sized));
    std::map<std::string, long> sizes;
    std::istringstream lines(sized.out);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string name;
      long bytes = 0;
      if (words >> name >> bytes) sizes[name] = bytes;
    }
    return sizes;
  }

  TemporaryDirectory directory_;
};

TEST_F(Firmware, LinksAndFitsTheChip) {
  const ProcessResult built = avr_gxx(
      "'" AWMR_SOURCE_DIR "/tests/firmware/firmware.cpp' -Wl,--gc-sections -o firmware.elf");
  ASSERT_TRUE(succeeded(built));
  EXPECT_EQ(built.err, "");

  std::map<std::string, long> sizes = section_sizes("firmware.elf");
  const long flash_bytes = sizes[".text"] + sizes[".data"];
  const long ram_bytes = sizes[".data"] + sizes[".bss"];
  std::cout << "ATmega2560: " << flash_bytes << " bytes of flash, " << ram_bytes
            << " bytes of RAM without the stack\n";
  RecordProperty("flash_bytes", std::to_string(flash_bytes));
  RecordProperty("ram_bytes", std::to_string(ram_bytes));
  // More than start-up code and vectors alone (about 250 bytes): the controller is included.
  EXPECT_GT(flash_bytes, 1000);
  EXPECT_LT(flash_bytes, kFlashBytesMax);
  EXPECT_LT(ram_bytes, kRamBytesMax);
}

TEST_F(Firmware, NeedsNoHeapAndNoExceptions) {
  // Undefined symbols of the object file: none of a C++ run-time is allowed.
  ASSERT_TRUE(
      succeeded(avr_gxx("-c '" AWMR_SOURCE_DIR "/tests/firmware/firmware.cpp' -o firmware.o")));
  const std::string bytes = read_all(directory_.path() / "firmware.o");
  for (const char* symbol : {"malloc", "_Znw", "_Zna", "__cxa_", "__gxx_personality"}) {
    EXPECT_EQ(bytes.find(symbol), std::string::npos) << symbol;
  }
}

}  // namespace
}  // namespace awmr::testing
