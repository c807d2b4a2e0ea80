/// The emitted library in compilers: for the chip as C and C++, on the host with sanitizers;
/// reproducible bytes. Sketches and other chips: boards_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "awmr/simulate/scenario.h"
#include "emit/paper_robot.h"
#include "support/toolchain.h"

namespace awmr::testing::library_test {
namespace {

using ::testing::HasSubstr;

std::vector<EmittedFile> library() {
  return firmware_library(paper_robot(), kPaperGains, paper_inputs(), {}).value();
}

class Library : public ::testing::TestWithParam<ResistanceForm> {
 protected:
  void SetUp() override { write_library(directory_.path(), {.resistance = GetParam()}); }
  ProcessResult run(const std::string& line) const { return run_process(line, directory_.path()); }

  TemporaryDirectory directory_;
};

constexpr const char* kUse = R"(#include "awmr.h"
#include <stdio.h>
int main(void) {
  const awmr_point points[2] = {{5.0f, 5.0f}, {10.0f, 0.0f}};
  awmr_input in = {0};
  awmr_output out;
  int step;
  if (awmr_init() != AWMR_FAULT_NONE) return 1;
  awmr_follow(points, 2, 1.0f);
  in.mode = AWMR_COMBINED;
  in.u_ref_mps = 1.0f;
  for (step = 0; step < 1000; ++step) {
    in.u_mps = 0.001f * (float)step;
    in.psi_rad = 0.01f * (float)step;
    in.x_m = 0.01f * (float)step;
    in.now_ms = in.heading_ms = in.speed_ms = in.command_ms = 10UL * (unsigned long)step;
    awmr_step(&in, &out);
    if (out.fault != AWMR_FAULT_NONE || out.force_left > AWMR_WHEEL_FORCE_MAX) return 2;
  }
  in.speed_ms -= 5000;
  awmr_step(&in, &out);
  if (out.fault != AWMR_FAULT_SPEED_STALE || out.force_left != 0.0f) return 3;
  return 0;
}
)";

TEST_P(Library, CompilesForTheChipAsCAndAsCxx) {
  write_all(directory_.path() / "use.c", kUse);
  const std::string flags =
      " -mmcu=atmega2560 -Os -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion "
      "-Werror -Isrc ";
  EXPECT_TRUE(succeeded(run(cached(kAvrGcc) + flags + "-std=c99 -c use.c -o use.o")));
  EXPECT_TRUE(succeeded(run(cached(kAvrGxx) + flags + "-std=c++14 -c src/awmr.cpp -o awmr.o")));
  EXPECT_TRUE(succeeded(run(cached(kAvrGxx) + flags + "-std=c++11 -c src/awmr.cpp -o awmr11.o")));
  EXPECT_TRUE(succeeded(run(std::string(kAvrGxx) + " -mmcu=atmega2560 use.o awmr.o -o use.elf")));
}

TEST_P(Library, RunsOnTheHostUnderSanitizers) {
  write_all(directory_.path() / "use.c", kUse);
  const std::string flags =
      " -O1 -g -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -fsanitize=address,undefined "
      "-fno-sanitize-recover=all -Isrc ";
  ASSERT_TRUE(succeeded(run(kGcc + flags + "-std=c99 -c use.c -o use.o")));
  ASSERT_TRUE(succeeded(run(kGxx + flags + "-std=c++14 use.o src/awmr.cpp -o use")));
  EXPECT_TRUE(succeeded(run("./use")));
}

TEST_P(Library, AnEditByHandIsFoundAtStartUp) {
  write_all(directory_.path() / "use.c", kUse);
  const std::string header = read_all(directory_.path() / "awmr_params.h");
  write_all(directory_.path() / "awmr_params.h", with_macro(header, "AWMR_HEADING_LAMBDA", "2.0f"));
  ASSERT_TRUE(succeeded(run(std::string(kGcc) + " -std=c99 -Isrc -c use.c -o use.o")));
  ASSERT_TRUE(succeeded(run(std::string(kGxx) + " -std=c++14 -Isrc use.o src/awmr.cpp -o use")));
  EXPECT_EQ(run("./use").exit_code, 1);
}

/// Sketch that uses every optional part.
constexpr const char* kUseAll = R"(#include "awmr.h"
static const awmr_point corners[3] = {{0.0f, 0.0f}, {10.0f, 0.0f}, {20.0f, 5.0f}};
static const awmr_obstacle obstacle[1] = {{10.0f, 0.0f, 1.0f}};
static awmr_sector room[1];
int main(void) {
  const awmr_line_law law = {1.0f, 3.0f, 1.0f, 1};
  const awmr_path path = {10.0f, 10.0f, 0.01f, 0.03f, 0.5f};
  const awmr_avoidance avoidance = {6.0f, 1.0f, 0.2f, 0.8f, 0.5f, 0.5f, 1.5f, 1.5f};
  const awmr_shaping shaping = {4.0f, 1.0f, 5.0f};
  const awmr_observer observer = {5.0f, 0.1f, 0.5f, 1};
  awmr_input in = {0};
  awmr_output out;
  int step;
  if (awmr_init() != AWMR_FAULT_NONE) return 1;
  in.mode = AWMR_COMBINED;
  in.u_ref_mps = 1.0f;
  awmr_slow_down(5.0f);
  awmr_avoid(&avoidance, obstacle, room, 1);
  awmr_shape(&shaping);
  awmr_observe(&observer);
  for (step = 0; step < 2000; ++step) {
    if (step == 0) awmr_follow_line(corners, 3, &law);
    if (step == 600) awmr_follow_path(&path);
    if (step == 1200) awmr_follow_skipping(corners, 3, 1.0f);
    if (step == 1500) awmr_avoid(&avoidance, obstacle, room, 0);
    if (step == 1600) awmr_shape(0);
    if (step == 1700) awmr_observe(0);
    in.u_mps = 1.0f;
    in.x_m = 0.01f * (float)step;
    in.now_ms = in.heading_ms = in.speed_ms = in.command_ms = 10UL * (unsigned long)step;
    awmr_step(&in, &out);
    if (out.fault != AWMR_FAULT_NONE || out.force_left > AWMR_WHEEL_FORCE_MAX) return 2;
    if (step == 900 && out.psi_ref_rad == 0.0f) return 3;
    if (out.arrived && step < 1200) return 4;
  }
  in.x_m = 0.0f / in.u_ref_accel_mps2; /* not a number */
  in.now_ms += 10;
  awmr_step(&in, &out);
  return (out.fault & AWMR_FAULT_NOT_FINITE) != 0 && out.force_left == 0.0f ? 0 : 5;
}
)";

TEST(AllParts, CompileForTheChipAsCAndAsCxxAndRunUnderSanitizers) {
  TemporaryDirectory directory;
  EmitOptions options;
  for (const FirmwarePart part : values_in(kFirmwarePartNames)) options.parts.insert(part);
  options.split = CombinedSplit::kFixedHalf;
  write_library(directory.path(), options);
  write_all(directory.path() / "use.c", kUseAll);
  const auto run = [&](const std::string& line) { return run_process(line, directory.path()); };
  const std::string chip =
      " -mmcu=atmega2560 -Os -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion "
      "-Werror -Isrc ";
  EXPECT_TRUE(succeeded(run(cached(kAvrGcc) + chip + "-std=c99 -c use.c -o use.o")));
  EXPECT_TRUE(succeeded(run(cached(kAvrGxx) + chip + "-std=c++14 -c src/awmr.cpp -o awmr.o")));
  EXPECT_TRUE(succeeded(run(cached(kAvrGxx) + chip + "-std=c++11 -c src/awmr.cpp -o awmr11.o")));
  EXPECT_TRUE(succeeded(run(std::string(kAvrGxx) + " -mmcu=atmega2560 use.o awmr.o -o use.elf")));
  const std::string host =
      " -O1 -g -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -fsanitize=address,undefined "
      "-fno-sanitize=float-divide-by-zero -fno-sanitize-recover=all -Isrc ";
  ASSERT_TRUE(succeeded(run(kGcc + host + "-std=c99 -c use.c -o use.o")));
  ASSERT_TRUE(succeeded(run(kGxx + host + "-std=c++14 use.o src/awmr.cpp -o use")));
  EXPECT_EQ(run("./use").exit_code, 0);
}

/// Sketch that follows a line by a law with the parameters 0.5 and 0.3.
constexpr const char* kUseLine = R"(#include "awmr.h"
static const awmr_point corners[2] = {{0.0f, 0.0f}, {100.0f, 0.0f}};
static const float parameters[2] = {0.5f, 0.3f};
int main(void) {
  awmr_input in = {0};
  awmr_output out;
  if (awmr_init() != AWMR_FAULT_NONE) return 1;
  awmr_follow_line_by(corners, 2, parameters, 0.0f, 0);
  in.u_ref_mps = in.u_mps = 1.0f;
  in.y_m = 0.1f;
  awmr_step(&in, &out);
  /* to the line, from its left */
  return out.fault == AWMR_FAULT_NONE && out.psi_ref_rad < -0.01f && out.psi_ref_rad > -1.0f ? 0 : 2;
}
)";

TEST(LineLaws, EachCompilesForTheChipAndLeadsToTheLine) {
  for (std::size_t place = 0; place < line_laws().size(); ++place) {
    SCOPED_TRACE(name_of(line_laws()[place]));
    TemporaryDirectory directory;
    EmitOptions options;
    options.parts.insert(FirmwarePart::kLine);
    options.line_law = place;
    write_library(directory.path(), options);
    write_all(directory.path() / "use.c", kUseLine);
    const auto run = [&](const std::string& line) { return run_process(line, directory.path()); };
    EXPECT_TRUE(succeeded(run(cached(kAvrGxx) +
                              " -mmcu=atmega2560 -Os -Wall -Wextra -Werror -std=c++11 -Isrc -c "
                              "src/awmr.cpp -o awmr.o")));
    ASSERT_TRUE(succeeded(run(std::string(kGcc) + " -std=c99 -Isrc -c use.c -o use.o")));
    ASSERT_TRUE(succeeded(run(cached(kGxx) + " -std=c++14 -Isrc -c src/awmr.cpp -o awmr_host.o")));
    ASSERT_TRUE(succeeded(run(std::string(kGxx) + " use.o awmr_host.o -o use")));
    EXPECT_EQ(run("./use").exit_code, 0);
  }
}

constexpr auto kForm = [](const auto& test) {
  return std::string(test.param == ResistanceForm::kTable ? "Table" : "Powf");
};
INSTANTIATE_TEST_SUITE_P(, Library,
                         ::testing::Values(ResistanceForm::kTable, ResistanceForm::kPowf), kForm);

TEST(LibraryFiles, AreTheSameBytesWhenMadeAgainAndHoldTheControlSourcesAsTheyAre) {
  const auto once = library();
  const auto again = library();
  ASSERT_EQ(once.size(), again.size());
  std::set<std::string> paths;
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].path, again[i].path);
    EXPECT_EQ(once[i].bytes, again[i].bytes);
    EXPECT_TRUE(paths.insert(once[i].path).second) << once[i].path;
    if (once[i].path.starts_with("src/awmr/")) {
      EXPECT_EQ(once[i].bytes, read_all(AWMR_SOURCE_DIR "/lib/" + once[i].path.substr(4)));
    }
  }
  for (const char* path :
       {"awmr_params.h", "library.properties", "library.json", "keywords.txt", "src/awmr.h",
        "src/awmr.cpp", "src/awmr/control/controller.h", "LICENSE"}) {
    EXPECT_TRUE(paths.contains(path)) << path;
  }
}

TEST(ResistanceTables, StayWithinTheirBoundOfTheLawBetweenTheirMeasuredPlaces) {
  const Plant<double> plant = paper_robot().plant().value();
  for (const double bound : {1e-2, 1e-3, 1e-4}) {
    const auto p =
        autopilot_parameters(paper_robot(), kPaperGains, paper_inputs(), {.table_error = bound})
            .value();
    const ResistanceTable table = p.surge.view();
    // Checks speeds between those at which the search for the table has measured the error
    // (multiples of 1/64 of a cell). Between them, the error of a chord changes little.
    for (int i = 1; i < 40000; ++i) {
      const float speed = static_cast<float>(i * 1.99e-4);
      const double exact = plant.surge(static_cast<double>(speed));
      const double allowed = 1.01 * bound * std::max(exact, p.surge.split);
      ASSERT_NEAR(static_cast<double>(table(speed)), exact, allowed) << speed;
      ASSERT_EQ(table(-speed), -table(speed));
    }
    EXPECT_EQ(table(0.0F), 0.0F);
    EXPECT_TRUE(std::isnan(table(static_cast<float>(p.surge.top_speed))));
    EXPECT_TRUE(std::isnan(table(HUGE_VALF)));
    EXPECT_TRUE(std::isnan(table(std::nanf(""))));
  }
}

TEST(ResistanceTables, AreRefusedWhereNoTableIsGoodEnough) {
  const auto p =
      autopilot_parameters(paper_robot(), kPaperGains, paper_inputs(), {.table_error = 1e-7});
  ASSERT_FALSE(p);
  EXPECT_EQ(exit_code(p.error()), 1);
  EXPECT_THAT(to_text(p.error()), HasSubstr("table-error"));
}

/// Model of a robot whose resistances rise so steeply from rest that a chord has a large error at
/// any speed of a table.
Model steep_robot() {
  Model model = paper_robot();
  model[ParameterId::kSurgeBeta].value = 0.05;
  return model;
}

TEST(ResistanceTables, AreTheBestOnesWithoutABound) {
  const auto best = autopilot_parameters(steep_robot(), kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(best);
  const double reached = best->surge.largest_relative_error();
  EXPECT_GT(reached, kTableError);
  EXPECT_EQ(best->table_error, reached);
  EXPECT_LE(best->yaw.largest_relative_error(), kTableError) << "the yaw table keeps the bound";
  const auto requested = [&](double bound) {
    return autopilot_parameters(steep_robot(), kPaperGains, paper_inputs(), {.table_error = bound});
  };
  EXPECT_FALSE(requested(kTableError));
  EXPECT_FALSE(requested(0.99 * reached)) << "a table with a smaller error exists";
  EXPECT_TRUE(requested(reached));
}

}  // namespace
}  // namespace awmr::testing::library_test
