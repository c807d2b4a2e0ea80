/// SysId's JSON: runs, units and signs of a drive with known motion, and all kinds of incomplete
/// records.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "awmr/core/units.h"
#include "awmr/trials/column_guess.h"
#include "awmr/trials/formats/log_formats.h"
#include "trial_text.h"

namespace awmr::testing::sysid_test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kCircumference_m = 0.4788;
constexpr std::size_t kRows = 60;

/// A quasistatic run at 0.25 V/s: the left wheels turn at 0.5 rotations/s per volt, the right ones
/// 10 % faster.
json run_of(double direction, bool is_signed = true, double begin_s = 7.0) {
  json rows = json::array();
  double left = 0.0;
  double right = 0.0;
  double angle = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t_s = 0.02 * static_cast<double>(i);
    const double volts = direction * 0.25 * t_s;
    const double left_rate = 0.5 * volts;
    const double right_rate = 0.55 * volts;
    const double yaw_rate = 2.0 * (right_rate - left_rate);
    const double shown = is_signed ? volts : std::abs(volts);
    rows.push_back(
        {begin_s + t_s, shown, shown, left, right, left_rate, right_rate, angle, yaw_rate});
    left += 0.02 * left_rate;
    right += 0.02 * right_rate;
    angle += 0.02 * yaw_rate;
  }
  return rows;
}

json record(bool is_signed = true) {
  return {{"sysid", true},
          {"test", "Drivetrain"},
          {"units", "Meters"},
          {"unitsPerRotation", kCircumference_m},
          {"slow-forward", run_of(1.0)},
          {"slow-backward", run_of(-1.0, is_signed)},
          {"fast-forward", json::array()},
          {"fast-backward", json::array()}};
}

const std::vector<double>& column(const ColumnLog& log, std::string_view name) {
  const auto found = std::ranges::find(log.header, name);
  if (found == log.header.end()) throw std::runtime_error(std::string(name));
  return log.columns[static_cast<std::size_t>(found - log.header.begin())];
}

TEST(SysId, EachTestIsARunInMetresAndDegrees) {
  const json document = record();
  const auto log = read_sysid(document.dump(), "a.json");
  ASSERT_TRUE(log) << to_text(log.error());
  ASSERT_EQ(log->rows(), 2 * kRows);
  EXPECT_EQ(column(*log, "run")[kRows - 1], 1.0);
  EXPECT_EQ(column(*log, "run")[kRows], 2.0);
  EXPECT_EQ(column(*log, "t_s")[kRows], 0.0);
  for (const std::size_t i : {std::size_t{0}, kRows - 1, kRows + 7}) {
    const json& row = document[i < kRows ? "slow-forward" : "slow-backward"][i % kRows];
    EXPECT_NEAR(column(*log, "left_mps")[i], row[5].get<double>() * kCircumference_m, 1e-12);
    EXPECT_NEAR(column(*log, "right_m")[i], row[4].get<double>() * kCircumference_m, 1e-12);
    EXPECT_NEAR(column(*log, "heading_deg")[i], degrees(row[7].get<double>()), 1e-9);
    EXPECT_NEAR(column(*log, "speed_mps")[i],
                0.5 * (row[5].get<double>() + row[6].get<double>()) * kCircumference_m, 1e-12);
    EXPECT_EQ(column(*log, "left_volts")[i], row[1].get<double>());
  }
  ASSERT_EQ(log->notes.size(), 1U);
  EXPECT_EQ(log->notes.front().code, "sysid-log");
}

TEST(SysId, FeetAndInchesBecomeMetres) {
  for (const auto& [unit, metres] : {std::pair{"Feet", 0.3048}, std::pair{"Inches", 0.0254}}) {
    json document = record();
    document["units"] = unit;
    const auto log = read_sysid(document.dump(), "a.json");
    ASSERT_TRUE(log) << to_text(log.error());
    const double rotations = document["slow-forward"][10][3].get<double>();
    EXPECT_NEAR(column(*log, "left_m")[10], rotations * kCircumference_m * metres, 1e-12);
  }
}

TEST(SysId, VoltagesWithoutASignAreMirroredWhereTheWheelsTurnBackward) {
  const auto with_sign = read_sysid(record().dump(), "a.json");
  const auto without = read_sysid(record(false).dump(), "a.json");
  ASSERT_TRUE(with_sign && without);
  EXPECT_EQ(column(*with_sign, "left_volts"), column(*without, "left_volts"));
  EXPECT_THAT(without->notes.front().message, HasSubstr("slow-backward have no sign"));
  EXPECT_THAT(with_sign->notes.front().message, ::testing::Not(HasSubstr("no sign")));
}

TEST(SysId, ReadsASimpleMechanismAndTheRowsOfFrcCharacterization) {
  const json simple = {{"sysid", true},
                       {"test", "Simple"},
                       {"units", "Meters"},
                       {"unitsPerRotation", 2.0},
                       {"slow-forward", {{1.0, 0.5, 3.0, 4.0}, {1.02, 0.6, 3.1, 5.0}}}};
  const auto one = read_sysid(simple.dump(), "a.json");
  ASSERT_TRUE(one) << to_text(one.error());
  EXPECT_THAT(column(*one, "speed_mps"), ElementsAre(8.0, 10.0));
  const json old = {{"units", "Meters"},
                    {"unitsPerRotation", 2.0},
                    {"slow-forward", {{1.0, 12.0, 0.1, 0.5, 0.6, 3.0, 4.0, 5.0, 6.0, 0.1}}}};
  const auto log = read_sysid(old.dump(), "a.json");
  ASSERT_TRUE(log) << to_text(log.error());
  EXPECT_THAT(column(*log, "right_volts"), ElementsAre(0.6));
  EXPECT_THAT(column(*log, "right_mps"), ElementsAre(12.0));
}

TEST(SysId, IsRecognisedByItsFirstBytes) {
  EXPECT_TRUE(is_sysid(record().dump()));
  EXPECT_TRUE(is_sysid(record().dump(2)));
  EXPECT_FALSE(is_sysid(R"({"t_s": [0, 1]})"));
  EXPECT_FALSE(is_sysid("t_s,speed_mps\n"));
  EXPECT_FALSE(is_sysid(""));
}

TEST(SysId, ALogIsReadWithTheForcesMappedFromVolts) {
  TrialOptions options{.columns = {*parse_column("force_left=left_volts/12"),
                                   *parse_column("force_right=right_volts/12")},
                       .has_steering = false};
  const ScratchFile file("sysid.json", record().dump());
  std::vector<Finding> findings;
  const auto logs = read_logs(file.path(), options, findings);
  ASSERT_TRUE(logs) << to_text(logs.error());
  ASSERT_EQ(logs->size(), 2U);
  EXPECT_NEAR((*logs)[0].force_left[30], 0.25 * 0.6 / 12.0, 1e-12);
  EXPECT_LT((*logs)[1].force_left[30], 0.0);
  EXPECT_TRUE((*logs)[0][LogChannel::kYawRate]);
}

TEST(SysId, TheMapProposesItsForcesAsUnsureVolts) {
  const ScratchFile file("sysid.json", record().dump());
  const auto sample = sample_of(file.path());
  ASSERT_TRUE(sample) << to_text(sample.error());
  bool is_found = false;
  for (const ColumnGuess& guess : guess_columns(*sample, TrialKind::kLog)) {
    if (guess.column != "force_left") continue;
    is_found = true;
    EXPECT_EQ(guess.expression, "left_volts/12");
    EXPECT_EQ(guess.confidence, Confidence::kUnsure);
  }
  EXPECT_TRUE(is_found);
}

}  // namespace
}  // namespace awmr::testing::sysid_test
