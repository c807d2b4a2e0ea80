/// The emitted library on other boards. The sketches are compiled with Arduino's core for Mega and
/// Uno. The autopilot runs on an emulated ARM and must give the same bits as on the host.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "emit/paper_robot.h"
#include "support/toolchain.h"

namespace awmr::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kArduino = "/usr/share/arduino/hardware/arduino/avr";

class Boards : public ::testing::Test {
 protected:
  void emit(const EmitOptions& options = {}) { write_library(directory_.path(), options); }
  std::string text(const char* path) const { return read_all(directory_.path() / path); }
  ProcessResult run(const std::string& line) const { return run_process(line, directory_.path()); }

  TemporaryDirectory directory_;
};

/// Properties of a board, from Arduino's boards.txt and platform.txt.
struct Board {
  const char* chip;
  const char* name;
  const char* variant;
  std::vector<std::string> sketches;
  int flash_bytes;  ///< without the bootloader
  int ram_bytes;    ///< for variables: a quarter is reserved for the stack
};
const Board kMega{
    "atmega2560",
    "AVR_MEGA2560",
    "mega",
    {"BringUp", "CompassCalibration", "HeadingHold", "RecordTrials", "WaypointFollowing"},
    253952,
    6144};
const Board kUno{"atmega328p", "AVR_UNO",
                 "standard",   {"BringUp", "HeadingHold", "WaypointFollowing"},
                 32256,        1536};

class Sketches : public Boards, public ::testing::WithParamInterface<const Board*> {
 protected:
  static std::string flags() {
    const std::string libraries = std::string(kArduino) + "/libraries/";
    return fmt::format(
        " -mmcu={} -DF_CPU=16000000L -DARDUINO=10819 -DARDUINO_{} -DARDUINO_ARCH_AVR -Os "
        "-flto -fno-fat-lto-objects -ffunction-sections -fdata-sections -I{}/cores/arduino "
        "-I{}/variants/{} -I{}Wire/src "
        "-I{}SPI/src -I{}SoftwareSerial/src -I{}/tests/emit/arduino -I../src -Isrc ",
        GetParam()->chip, GetParam()->name, kArduino, kArduino, GetParam()->variant, libraries,
        libraries, libraries, AWMR_SOURCE_DIR);
  }
  static std::string cxx() {
    return std::string("'") + kAvrGxx +
           "' -std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics" + flags();
  }
  /// Builds Arduino's core and libraries as an archive, as its IDE does. Warnings are off, because
  /// these sources cause some. WString.cpp needs a macro that avr-gcc 5.4 defines only for C.
  ProcessResult build_core() const {
    const std::string core = std::string(kArduino) + "/cores/arduino";
    const std::string libraries = std::string(kArduino) + "/libraries";
    return run("mkdir -p core && cd core && for f in " + core + "/*.c " + libraries +
               "/Wire/src/utility/*.c; do '" + kAvrGcc + "' -std=gnu11 -w" + flags() +
               "-c $f || exit 1; done && for f in " + core + "/*.cpp " + libraries +
               "/Wire/src/*.cpp " + libraries + "/SoftwareSerial/src/*.cpp; do " + cxx() +
               "-w -DDECIMAL_DIG=9 -c $f || exit 1; done && '" + kAvrGccAr + "' rcs ../core.a *.o");
  }
};

TEST_P(Sketches, CompileLinkAndFit) {
  ASSERT_TRUE(fs::exists(kArduino)) << "scripts/setup installs arduino-core-avr";
  emit();
  ASSERT_TRUE(succeeded(build_core()));
  ASSERT_TRUE(succeeded(run(cxx() + "-Wall -Wextra -Werror -c src/awmr.cpp -o awmr.o")));
  for (const std::string& name : GetParam()->sketches) {
    SCOPED_TRACE(name);
    const std::string sketch = fmt::format("examples/{}/{}.ino", name, name);
    ASSERT_TRUE(succeeded(run(cxx() + "-Wall -Wextra -Werror -x c++ -include Arduino.h -c " +
                              sketch + " -o sketch.o")));
    ASSERT_TRUE(
        succeeded(run(fmt::format("'{}' -mmcu={} -Os -flto -fuse-linker-plugin -Wl,--gc-sections "
                                  "sketch.o awmr.o core.a -lm -o sketch.elf",
                                  kAvrGxx, GetParam()->chip))));
    const ProcessResult size = run(std::string("'") + kAvrSize + "' sketch.elf | tail -1");
    std::istringstream numbers(size.out);
    int text = 0;
    int data = 0;
    int bss = 0;
    ASSERT_TRUE(numbers >> text >> data >> bss) << size.out << size.err;
    EXPECT_LE(text + data, GetParam()->flash_bytes);
    EXPECT_LE(data + bss, GetParam()->ram_bytes);
  }
}
INSTANTIATE_TEST_SUITE_P(, Sketches, ::testing::Values(&kMega, &kUno),
                         [](const auto& test) { return std::string(test.param->variant); });

using SketchesOnUno = Sketches;
TEST_P(SketchesOnUno, ReportAMissingCard) {
  emit();
  for (const char* name : {"CompassCalibration", "RecordTrials"}) {
    const ProcessResult built = run(cxx() + "-x c++ -include Arduino.h -c examples/" + name + "/" +
                                    name + ".ino -o sketch.o");
    EXPECT_NE(built.exit_code, 0);
    EXPECT_THAT(built.err, HasSubstr("which an Uno has no RAM for"));
  }
}
INSTANTIATE_TEST_SUITE_P(, SketchesOnUno, ::testing::Values(&kUno),
                         [](const auto&) { return std::string("uno"); });

/// Program that runs the autopilot on random inputs, with one more part in each round, and prints a
/// checksum of all output bits after each. Built without fused multiply-add (-ffp-contract=off).
constexpr const char* kDriven = R"(#include "awmr.h"
#include <stdio.h>
#include <string.h>
static uint32_t seed = 1;
static uint32_t draw(void) { seed = seed * 1664525u + 1013904223u; return seed >> 8; }
static float between(float lo, float hi) {
  return lo + (hi - lo) * ((float)draw() * (1.0f / 16777216.0f));
}
static uint32_t hash = 2166136261u;
static void put(float x) {
  uint32_t bits;
  int i;
  memcpy(&bits, &x, 4);
  if (x != x) bits = 0x7FC00000u;
  for (i = 0; i < 32; i += 8) hash = (hash ^ (bits >> i & 255u)) * 16777619u;
}
static const awmr_point corners[3] = {{0.0f, 0.0f}, {10.0f, 0.0f}, {20.0f, 5.0f}};
static const awmr_obstacle obstacle[1] = {{10.0f, 0.0f, 1.0f}};
static awmr_sector room[1];
int main(void) {
  const awmr_line_law law = {1.0f, 3.0f, 1.0f, 1};
  const awmr_path path = {10.0f, 10.0f, 0.01f, 0.03f, 0.5f};
  const awmr_avoidance avoidance = {6.0f, 1.0f, 0.2f, 0.8f, 0.5f, 0.5f, 1.5f, 1.5f};
  const awmr_shaping shaping = {4.0f, 1.0f, 5.0f};
  const awmr_observer observer = {5.0f, 0.1f, 0.5f, 1};
  awmr_input in;
  awmr_output out;
  int part, step;
  memset(&in, 0, sizeof in);
  if (awmr_init() != AWMR_FAULT_NONE) return 1;
  for (part = 0; part < 7; ++part) {
    if (part == 1) awmr_follow(corners, 3, 1.0f);
    if (part == 2) awmr_follow_line(corners, 3, &law);
    if (part == 3) awmr_follow_path(&path);
    if (part == 4) awmr_avoid(&avoidance, obstacle, room, 1);
    if (part == 5) awmr_shape(&shaping);
    if (part == 6) awmr_observe(&observer);
    for (step = 0; step < 2000; ++step) {
      in.mode = (uint8_t)(draw() % 3u);
      in.psi_rad = between(-7.0f, 7.0f);
      in.u_mps = between(-1.5f, 1.5f);
      in.v_mps = between(-0.3f, 0.3f);
      in.r_radps = between(-2.0f, 2.0f);
      in.x_m = between(-5.0f, 25.0f);
      in.y_m = between(-5.0f, 10.0f);
      in.psi_ref_rad = between(-7.0f, 7.0f);
      in.psi_ref_rate_radps = between(-1.0f, 1.0f);
      in.psi_ref_accel_radps2 = between(-1.0f, 1.0f);
      in.u_ref_mps = between(-1.0f, 1.5f);
      in.u_ref_accel_mps2 = between(-1.0f, 1.0f);
      in.now_ms = in.heading_ms = in.speed_ms = in.command_ms = 10u * (uint32_t)(2000 * part + step);
      awmr_step(&in, &out);
      if (out.fault != AWMR_FAULT_NONE) return 2;
      put(out.force_left);
      put(out.force_right);
      put(out.steering_rad);
      put(out.tau_speed);
      put(out.tau_turn_m);
      put(out.psi_ref_rad);
    }
    printf("%d %08lx\n", part, (unsigned long)hash);
  }
  return 0;
}
)";

/// Start-up code of a Cortex-M: the vector table, and enabling the floating-point unit.
constexpr const char* kArmStart = R"(extern void _start(void);
static void reset(void) {
#ifdef __ARM_FP
  *(volatile unsigned long*)0xE000ED88 |= 0xFul << 20;
  __asm__ volatile("dsb\n isb");
#endif
  _start();
}
__attribute__((section(".vectors"), used)) static void* const vectors[16] = {(void*)0x20400000,
                                                                             (void*)reset};
)";

class OtherProcessors : public Boards {
 protected:
  void SetUp() override {
    EmitOptions options;
    for (const FirmwarePart part : values_in(kFirmwarePartNames)) options.parts.insert(part);
    emit(options);
    write_all(directory_.path() / "driven.c", kDriven);
    write_all(directory_.path() / "start.c", kArmStart);
  }
  std::string on_host(const std::string& flags) const {
    const ProcessResult built =
        run(fmt::format("'{}' -O2 -ffp-contract=off -std=c99 -Isrc -c driven.c -o driven.o && '{}' "
                        "-O2 {} -std=c++14 "
                        "-Isrc driven.o src/awmr.cpp -o driven",
                        kGcc, kGxx, flags));
    EXPECT_TRUE(succeeded(built));
    const ProcessResult result = run("./driven");
    EXPECT_TRUE(succeeded(result));
    return result.out;
  }
  std::string on_arm(const std::string& cpu, const std::string& machine) const {
    const std::string cxx_flags =
        cpu + " -O2 -Wall -Wextra -Wpedantic -Werror -std=c++14 -fno-exceptions -fno-rtti -Isrc ";
    const ProcessResult built = run(fmt::format(
        "'{0}' {1} -O2 -ffp-contract=off -std=c99 -Isrc -c driven.c start.c && '{2}' {3} -c "
        "src/awmr.cpp -o awmr.o && '{0}' {1} --specs=rdimon.specs -Wl,--section-start=.vectors=0 "
        "start.o driven.o awmr.o -lm -o driven.elf",
        kArmGcc, cpu, kArmGxx, cxx_flags));
    EXPECT_TRUE(succeeded(built));
    const ProcessResult result = run(fmt::format(
        "timeout 120 '{}' -M {} -nographic -semihosting-config enable=on,target=native -kernel "
        "driven.elf",
        kQemuArm, machine));
    EXPECT_TRUE(succeeded(result));
    return result.out;
  }
};

/// awmr.cpp disables fused multiply-add (vfma), which a compiler for an FPU would use.
TEST_F(OtherProcessors, GiveTheHostsBitsWithAndWithoutAnFpu) {
  for (const char* program : {kArmGcc, kArmGxx, kQemuArm}) {
    if (!found(program)) GTEST_SKIP() << "the ARM tools are not installed (scripts/setup all)";
  }
  const std::string host = on_host("-ffp-contract=off");
  EXPECT_THAT(host, HasSubstr("6 "));
  EXPECT_EQ(on_arm("-mcpu=cortex-m3 -mthumb", "mps2-an385"), host);
  EXPECT_EQ(on_arm("-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16", "mps2-an386"),
            host);
  EXPECT_EQ(on_arm("-mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16", "mps2-an500"), host);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("fma") != 0) {
    EXPECT_EQ(on_host("-mfma -ffp-contract=fast"), host);
  }
#endif
}

TEST_F(OtherProcessors, DoNotGetOptionsThatDisableTheChecks) {
  const ProcessResult built =
      run(std::string("'") + kGxx + "' -O2 -ffast-math -Isrc -c src/awmr.cpp -o awmr.o");
  EXPECT_NE(built.exit_code, 0);
  EXPECT_THAT(built.err, HasSubstr("without -ffast-math"));
}

TEST_F(Boards, TheMetadataAreWhatArduinoAndPlatformIoRead) {
  emit();
  const std::string properties = text("library.properties");
  EXPECT_THAT(properties, HasSubstr("name=awmr\nversion="));
  for (const char* key :
       {"author", "maintainer", "sentence", "paragraph", "category", "architectures", "includes"}) {
    EXPECT_TRUE(std::regex_search(properties, std::regex(std::string(key) + "=.+\n"))) << key;
  }
  const auto json = nlohmann::json::parse(text("library.json"));
  EXPECT_EQ(json["name"], "awmr");
  EXPECT_TRUE(
      std::regex_match(json["version"].get<std::string>(), std::regex("\\d+\\.\\d+\\.\\d+")));
  EXPECT_THAT(properties, HasSubstr("version=" + json["version"].get<std::string>()));
  // keywords.txt lists each function and type of awmr.h with its kind after a tab.
  std::set<std::string> keywords;
  std::istringstream lines(text("keywords.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '#') continue;
    EXPECT_TRUE(std::regex_match(line, std::regex("\\w+\t(KEYWORD1|KEYWORD2|LITERAL1)"))) << line;
    keywords.insert(line.substr(0, line.find('\t')));
  }
  const std::string header = text("src/awmr.h");
  const std::regex declared("(?:^|\n)(?:void|uint8_t) (awmr_\\w+)\\(|\\} (awmr_\\w+);");
  for (std::sregex_iterator at(header.begin(), header.end(), declared), end; at != end; ++at) {
    const std::string name = (*at)[1].matched ? (*at)[1] : (*at)[2];
    EXPECT_TRUE(keywords.count(name) == 1) << name;
  }
}

}  // namespace
}  // namespace awmr::testing
