/// The emitted sketches, compiled for this machine, with a simulated vehicle and sensors
/// (host_core/). Each hazard of SAFETY.md is injected; its table contains the measured results.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "emit/paper_robot.h"
#include "support/toolchain.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

/// Row of the table: failure, detecting check, its code, and the time until the motors are off.
struct Hazard {
  const char* name;  ///< name in host_core/failures.h
  const char* hazard;
  const char* detector;
  int cause;             ///< SensorFault; 0: none
  double within_s;       ///< maximum time until the motors are off
  bool on_route = true;  ///< also run with WaypointFollowing
};

constexpr Hazard kHazards[] = {
    {"compass-silent", "compass does not answer", "no new field for 0.5 s", 5, 0.6},
    {"compass-frozen", "compass repeats its words", "same three words for 0.5 s", 6, 0.6},
    {"compass-jump", "compass jumps by 57 deg", "innovation above 20 deg for 0.2 s", 7, 0.4},
    {"compass-stuck", "compass is stuck in a turn", "innovation above 20 deg for 0.2 s", 7, 1.5,
     false},
    {"gyro-silent", "gyroscope does not answer", "no word for 0.1 s", 1, 0.2},
    {"gyro-frozen", "gyroscope repeats its word", "same word for 0.5 s", 2, 0.6},
    {"gyro-range", "gyroscope reset to another range", "range register read back every 5 steps", 3,
     0.1},
    {"gyro-drift", "gyroscope drifts by 8.6 deg/s", "mean innovation above 6 deg over 5 s", 7, 6.0},
    {"gps-silent", "GPS silent", "no sentence for the speed time-out", 8, 0.7},
    {"gps-no-fix", "GPS without a fix", "status V, or mode N or E", 9, 0.9},
    {"gps-empty", "GPS sentence with empty fields", "strict reader", 9, 0.9},
    {"gps-damaged", "GPS sentence with a wrong check sum", "strict reader", 9, 0.9},
    {"gps-repeated", "GPS repeats a sentence", "UTC does not advance", 10, 0.9},
    {"gps-late", "GPS latency of 2 s", "silence, then UTC behind the clock by 0.5 s", 8, 0.9},
    {"gps-jump", "GPS position jumps by 20 m", "displacement above (1.5 u + 1 m/s) t + 3 m", 12,
     0.9},
    {"gps-position-frozen", "GPS position is stuck", "1.5 m by speed, none by position", 13, 2.5},
    {"gps-speed-zero", "GPS speed is stuck at 0", "6 m further along the heading than by speed", 13,
     40.0},
    {"motors-reversed", "motors drive the wrong way, but turn the right way",
     "2 m against the commanded direction", 14, 8.0},
    {"sides-swapped", "left and right motors swapped", "quarter turn against the commanded moment",
     16, 10.0, false},
    {"gyro-reversed", "gyroscope of the wrong sign", "innovation above 20 deg for 0.2 s", 7, 5.0,
     false},
    {"steering-stuck", "servo is stuck", "distance driven off the wanted heading", 17, 40.0, false},
    {"servo-reversed", "servo turns the wrong way", "quarter turn against the commanded moment", 16,
     20.0, false},
    {"compass-turning", "compass turns away by 2.5 deg/s", "track 30 deg off the heading over 10 m",
     15, 35.0, false},
    {"command-silence", "operator silent", "no command for the command time-out", 0, 1.4},
    {"command-noise", "noise on the line", "no whole command", 0, 1.4},
    {"command-unknown", "lines that are no command", "no known command", 0, 1.4},
    {"command-repeated-frame", "transmitter repeats a frame", "sequence number", 0, 1.7},
    {"stop", "operator sends STOP", "the command", 0, 0.05},
    {"stop-in-noise", "STOP amid noise, without a line's end", "its last letter", 0, 0.05}};

/// Formats one row of the table in SAFETY.md.
std::string table_row(const Hazard& h) {
  return fmt::format("| {} | {} | {} | {:g} | `{}` |\n", h.hazard, h.detector,
                     h.cause != 0 ? std::to_string(h.cause) : "-", h.within_s, h.name);
}

/// A vehicle with low resistance, m' = 1 and g1 = 0.2 u: with |u| as its input, its speed law
/// diverges.
Model rolling_robot() {
  Model model = paper_robot();
  model[ParameterId::kSurgeAlpha].value = 0.2;
  model[ParameterId::kSurgeBeta].value = 1.0;
  model[ParameterId::kMassNorm].value = 1.0;
  return model;
}
constexpr Gains<double> kRollingGains{.heading = kPaperGains.heading, .speed = {3.0, 1.0}};

/// Library with steps of 50 ms, during which a serial port's buffer would overflow.
Model slow_robot() {
  Model model = paper_robot();
  model.vehicle.sample_time_s = 0.05;
  return model;
}
constexpr Gains<double> kSlowGains{.heading = {1.0, 2.0, 1.0}, .speed = {2.0, 2.0}};

class SafeSketches : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    paper_ = new TemporaryDirectory;
    rolling_ = new TemporaryDirectory;
    slow_ = new TemporaryDirectory;
    build(*paper_, paper_robot(), kPaperGains);
    build(*rolling_, rolling_robot(), kRollingGains);
    build(*slow_, slow_robot(), kSlowGains);
  }
  static void TearDownTestSuite() {
    delete paper_;
    delete rolling_;
    delete slow_;
  }

  static void build(const TemporaryDirectory& directory, const Model& model,
                    const Gains<double>& gains) {
    const auto files = firmware_library(model, gains, paper_inputs(), {});
    ASSERT_TRUE(files);
    for (const EmittedFile& file : *files) {
      std::filesystem::create_directories((directory.path() / file.path).parent_path());
      write_all(directory.path() / file.path, file.bytes);
    }
    const std::string core = std::string(AWMR_SOURCE_DIR) + "/tests/emit/host_core";
    // Removes the attribute `naked`, which only compilers for the chip support.
    const std::string flags =
        " -w -ffp-contract=off -Isrc -I" + core + " -Dnaked= -D__AVR_ATmega2560__ ";
    // With -Og rather than -O1, compiling takes half the time.
    const std::string sanitize = " -fsanitize=address,undefined -fno-sanitize-recover=all ";
    const auto compile = [&](const std::string& arguments) {
      return succeeded(run_process(cached(kGxx) + flags + arguments, directory.path()));
    };
    ASSERT_TRUE(compile(sanitize + "-Og -std=c++14 -c src/awmr.cpp -o awmr.o"));
    // The simulated world is compiled without sanitizers, because it is not under test. The sketch
    // is linked first, because the linker keeps the first copy of an inline function.
    const auto compile_case = [&](const char* name, std::initializer_list<const char*> sketches) {
      ASSERT_TRUE(compile(fmt::format("-O1 -std=c++17 -c {0}/{1}.cpp -o {1}.o", core, name)));
      for (const char* sketch : sketches) {
        ASSERT_TRUE(compile(fmt::format("{0}-Og -std=c++17 -x c++ -c examples/{1}/{1}.ino -o {1}.o",
                                        sanitize, sketch)));
        ASSERT_TRUE(succeeded(run_process(
            fmt::format("{0}{1}{2}.o awmr.o {3}.o -o {2}", kGxx, sanitize, sketch, name),
            directory.path())));
      }
    };
    if (&directory == slow_) return compile_case("drive_case", {"HeadingHold"});
    compile_case("drive_case", {"HeadingHold", "WaypointFollowing"});
    // The program that records trials is built for one of the vehicles only.
    if (&directory == paper_) compile_case("record_case", {"RecordTrials"});
  }
  /// NAME=VALUE pairs printed by a run of the sketch.
  static std::map<std::string, double> drive(const TemporaryDirectory& directory,
                                             const std::string& line) {
    const ProcessResult run = run_process("./" + line, directory.path());
    EXPECT_TRUE(succeeded(run)) << line;
    std::map<std::string, double> values;
    std::istringstream words(run.out);
    for (std::string word; words >> word;) {
      const std::size_t at = word.find('=');
      values[word.substr(0, at)] = std::atof(word.c_str() + at + 1);
    }
    return values;
  }

  static TemporaryDirectory* paper_;
  static TemporaryDirectory* rolling_;
  static TemporaryDirectory* slow_;
};
TemporaryDirectory* SafeSketches::paper_ = nullptr;
TemporaryDirectory* SafeSketches::rolling_ = nullptr;
TemporaryDirectory* SafeSketches::slow_ = nullptr;

TEST_F(SafeSketches, DriveWithoutFaultsAcrossTheWrapOfTheClock) {
  for (const char* sketch : {"HeadingHold", "WaypointFollowing"}) {
    // millis() wraps 12 s after the start, during the drive.
    for (const char* start_ms : {"1000", "4294955000"}) {
      auto seen = drive(*paper_, fmt::format("{} none {}", sketch, start_ms));
      EXPECT_EQ(seen["drove"], 1) << sketch;
      EXPECT_EQ(seen["stopped_s"], -1) << sketch << start_ms;
      EXPECT_EQ(seen["cause"], 0) << sketch << start_ms;
      EXPECT_GT(seen["away_m"], 10.0) << sketch << start_ms;
    }
  }
}

TEST_F(SafeSketches, LoseNoCharacterOfTheirLinesHoweverLongAStepIs) {
  for (const TemporaryDirectory* directory : {paper_, slow_}) {
    for (const char* phase_ms : {"0", "7", "13", "19", "26", "34", "41", "49"}) {
      auto seen = drive(*directory, fmt::format("HeadingHold lines {}", phase_ms));
      EXPECT_EQ(seen["armed"], 1) << phase_ms;
      EXPECT_EQ(seen["drove"], 1) << phase_ms;
      EXPECT_EQ(seen["off"], 1) << phase_ms;
      EXPECT_EQ(seen["lost"], 0) << phase_ms;
    }
  }
}

TEST_F(SafeSketches, StopAtEveryHazardStayStoppedAndDriveAgainOnceArmed) {
  for (const Hazard& hazard : kHazards) {
    for (const char* sketch : {"HeadingHold", "WaypointFollowing"}) {
      if (!hazard.on_route && sketch != std::string("HeadingHold")) continue;
      SCOPED_TRACE(fmt::format("{} {}", sketch, hazard.name));
      auto seen = drive(*paper_, fmt::format("{} {}", sketch, hazard.name));
      EXPECT_EQ(seen["drove"], 1);
      EXPECT_GE(seen["stopped_s"], 0.0);
      EXPECT_LE(seen["stopped_s"], hazard.within_s);
      EXPECT_EQ(seen["off"], 1);
      EXPECT_EQ(seen["drives_again"], 0) << "without ARM";
      EXPECT_EQ(seen["cause"], hazard.cause);
      EXPECT_EQ(seen["rearmed"], 1) << "after the fault was removed";
    }
  }
}

TEST_F(SafeSketches, TheTableOfHazardsIsWhatIsTested) {
  std::string table;
  for (const Hazard& hazard : kHazards) table += table_row(hazard);
  EXPECT_THAT(read_all(paper_->path() / "SAFETY.md"), HasSubstr(table));
  std::string cases = run_process("./HeadingHold list", paper_->path()).out;
  std::string names;
  for (const Hazard& hazard : kHazards) names += std::string(hazard.name) + "\n";
  EXPECT_EQ(cases, names);
}

TEST_F(SafeSketches, AtSpeedZeroNoForceAcceleratesARollingVehicle) {
  for (const auto* directory : {paper_, rolling_}) {
    for (const double push : {0.0, -0.3, -0.87, -2.0, 0.87}) {
      for (const double noise : {0.05, 0.3}) {
        SCOPED_TRACE(fmt::format("{} {}", push, noise));
        auto seen = drive(*directory, fmt::format("HeadingHold hold {} {}", push, noise));
        EXPECT_EQ(seen["armed"], 1);
        EXPECT_LE(seen["fastest_mps"], std::abs(push) + 0.01);
        EXPECT_LE(std::abs(seen["end_mps"]), 0.05);
        EXPECT_LE(seen["moved_m"], 12.0);
        if (push == 0.0) {
          EXPECT_EQ(seen["driven_s"], 0.0);
        }
      }
    }
  }
}

TEST_F(SafeSketches, AreNeverDrivenDownASlopeAtSpeedZero) {
  for (const auto* directory : {paper_, rolling_}) {
    // Downhill force over F_max: from above the resistance at rest to more than the brakes can
    // hold.
    for (const double pull : {0.3, 0.9, 1.5, -0.9, -1.5}) {
      for (const char* first : {"", " driven"}) {
        SCOPED_TRACE(fmt::format("{}{}", pull, first));
        auto seen = drive(*directory, fmt::format("HeadingHold slope {}{}", pull, first));
        EXPECT_EQ(seen["driven_on_s"], 0.0);
      }
    }
  }
}

TEST_F(SafeSketches, StopIfTheCompassIsMountedAtAnAngleOrTheServoIsReversed) {
  for (const double offset_deg : {57.0, 90.0, -90.0}) {
    auto seen = drive(*paper_, fmt::format("HeadingHold wrong {}", offset_deg));
    EXPECT_GE(seen["stopped_s"], 0.0) << offset_deg;
    EXPECT_LE(seen["stopped_s"], 25.0) << offset_deg;
    EXPECT_EQ(seen["cause"], 15) << offset_deg;
  }
  auto reversed = drive(*paper_, "HeadingHold wrong 0 -1");
  EXPECT_GE(reversed["stopped_s"], 0.0);
  EXPECT_EQ(reversed["cause"], 16);
  // A compass mounted 10 deg off, which is below the detector's limit, is no fault.
  auto slight = drive(*paper_, "HeadingHold wrong 10");
  EXPECT_EQ(slight["stopped_s"], -1);
}

TEST_F(SafeSketches, StopForwardAndNeverDriveBackwardAfterADriveOrTheLastPoint) {
  for (const auto* directory : {paper_, rolling_}) {
    for (const char* conditions : {"", " 0.7", " 1.4 300"}) {
      auto held = drive(*directory, std::string("HeadingHold drive 20") + conditions);
      EXPECT_GE(held["slowest_mps"], -0.35) << conditions;
      EXPECT_LE(std::abs(held["end_mps"]), 0.05) << conditions;
      EXPECT_LE(held["rolled_m"], 5.0) << conditions;
      auto route = drive(*directory, std::string("WaypointFollowing drive 120") + conditions);
      EXPECT_EQ(route["reason"], 5) << "arrived" << conditions;
      EXPECT_EQ(route["driven"], 0) << conditions;
      EXPECT_GE(route["slowest_mps"], -0.35) << conditions;
      EXPECT_LE(std::abs(route["end_mps"]), 0.05) << conditions;
    }
  }
}

TEST_F(SafeSketches, AreNotArmedWhileTheVehicleTurnsAtTheStart) {
  for (const double rate : {0.5, -0.5, 0.1}) {
    auto seen = drive(*paper_, fmt::format("HeadingHold turning {}", rate));
    EXPECT_EQ(seen["armed_turning"], 0) << rate;
    EXPECT_EQ(seen["armed_still"], 1) << rate;
    EXPECT_LE(std::abs(seen["heading_error_deg"]), 2.0) << rate;
  }
}

TEST_F(SafeSketches, HoldTheHeadingAfterSevenHundredTurns) {
  auto seen = drive(*paper_, "HeadingHold turns 700");
  EXPECT_LE(seen["largest_rad"], 3.14160);
  EXPECT_EQ(seen["armed"], 1);
  EXPECT_EQ(seen["fault"], 0);
}

TEST_F(SafeSketches, ChangeTheDirectionOfAMotorOnlyWithThePwmAtZero) {
  auto seen = drive(*paper_, "HeadingHold reverse");
  EXPECT_GE(seen["reversals"], 2);
  EXPECT_EQ(seen["driven_reversals"], 0);
}

TEST_F(SafeSketches, RecordNoReadingsOfARejectedSensor) {
  auto good = drive(*paper_, "RecordTrials none");
  EXPECT_EQ(good["rows_broken"], 1);
  for (const char* broken :
       {"gps-silent", "gps-repeated", "gyro-silent", "gyro-frozen", "silence"}) {
    auto seen = drive(*paper_, std::string("RecordTrials ") + broken);
    EXPECT_EQ(seen["drove"], 1) << broken;
    EXPECT_EQ(seen["driven"], 0) << broken;
    EXPECT_EQ(seen["rows_broken"], 0) << broken;
    EXPECT_EQ(seen["drives_unarmed"], 0) << broken;
    EXPECT_EQ(seen["rows_mended"], 1) << broken;
  }
}

}  // namespace
}  // namespace awmr::testing
