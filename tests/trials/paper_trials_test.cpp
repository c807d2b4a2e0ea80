/// The paper's own tables: the rows read, and each contradiction in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/core/units.h"
#include "trial_text.h"

namespace awmr::testing::paper_trials_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::filesystem::path kPaper = AWMR_SOURCE_DIR "/datasets/paper";

TEST(PaperSurgeTrial, HasTenUsableRowsAndOneAtRest) {
  std::vector<Finding> findings;
  const auto set = read_surge(kPaper / "surge.csv", {}, findings);
  ASSERT_TRUE(set) << to_text(set.error());
  EXPECT_EQ(set->set_aside, 1);
  ASSERT_EQ(set->rows.size(), 10u);
  EXPECT_EQ(set->file, "surge.csv");
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(set->rows[i].line, static_cast<int>(i) + 4);
    EXPECT_DOUBLE_EQ(set->rows[i].tau_speed, 0.2 * static_cast<double>(i + 1));
    EXPECT_EQ(set->rows[i].distance_m, 10.0);
  }
  EXPECT_EQ(set->rows[6].speed_mps, 1.03);
  EXPECT_EQ(set->rows[6].elapsed_s, 9.26);
}

TEST(PaperSurgeTrial, ReportsContradictoryRows) {
  std::vector<Finding> findings;
  ASSERT_TRUE(read_surge(kPaper / "surge.csv", {}, findings));
  // Line 4 is trial 2 (0.12 m/s printed, 0.1263 timed), line 10 is trial 8 (1.03 printed, 1.080
  // timed), line 3 is trial 1 (at rest).
  ASSERT_THAT(codes_of(findings),
              ElementsAre("speed-mismatch@4", "speed-mismatch@10", "rows-set-aside@3"));
  EXPECT_THAT(findings[0].message, AllOf(HasSubstr("0.12,"), HasSubstr("0.1263")));
  EXPECT_THAT(findings[1].message, AllOf(HasSubstr("1.03"), HasSubstr("9.26"), HasSubstr("1.08"),
                                         HasSubstr("the printed value 1.03 is used")));
  EXPECT_EQ(findings[1].severity, Severity::kWarning);
  EXPECT_EQ(findings[1].file, "surge.csv");
  EXPECT_THAT(findings[2].message, AllOf(HasSubstr("1 of 11 rows"), HasSubstr("(line 3)")));
  EXPECT_EQ(findings[2].severity, Severity::kNote);
}

TEST(PaperSurgeTrial, UsesTheTimesWhereTheyArePreferred) {
  std::vector<Finding> findings;
  const auto set =
      read_surge(kPaper / "surge.csv", {.columns = {}, .preference = Preference::kTimed}, findings);
  ASSERT_TRUE(set) << to_text(set.error());
  for (const SurgeRow& row : set->rows) EXPECT_EQ(row.speed_mps, 10.0 / *row.elapsed_s);
  ASSERT_GE(findings.size(), 2u);
  EXPECT_THAT(findings[1].message, AllOf(HasSubstr("1.03"), HasSubstr("the timed value 1.08 is")));
}

TEST(PaperTurningTrial, HasFiveRowsAsPrinted) {
  std::vector<Finding> findings;
  const auto set = read_turning(kPaper / "turning.csv", paper_vehicle(), {}, findings);
  ASSERT_TRUE(set) << to_text(set.error());
  EXPECT_EQ(set->set_aside, 0);
  ASSERT_EQ(set->rows.size(), 5u);
  const double rates_radps[] = {0.038, 0.088, 0.15, 0.22, 0.265};
  const double tau_turn_m[] = {0.02, 0.042, 0.064, 0.086, 0.1};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(set->rows[i].line, static_cast<int>(i) + 3);
    EXPECT_EQ(set->rows[i].yaw_rate_radps, rates_radps[i]);
    EXPECT_EQ(set->rows[i].tau_turn_m, tau_turn_m[i]);
    EXPECT_EQ(set->rows[i].wheel_force, 0.35);
    EXPECT_DOUBLE_EQ(set->rows[i].steering_rad, radians(5.0 * static_cast<double>(i + 1)));
  }
}

TEST(PaperTurningTrial, ReportsRowsThatContradictThemselvesOrTheVehicle) {
  std::vector<Finding> findings;
  ASSERT_TRUE(read_turning(kPaper / "turning.csv", paper_vehicle(), {}, findings));
  // Lines 3 to 7 are 5, 10, 15, 20, 25 degrees.
  ASSERT_THAT(codes_of(findings),
              ElementsAre("yaw-rate-mismatch@3", "tau-turn-mismatch@3", "yaw-rate-mismatch@6",
                          "tau-turn-mismatch@6", "steering-stop@7", "tau-turn-mismatch@7"));
  EXPECT_THAT(findings[0].message, AllOf(HasSubstr("0.038"), HasSubstr("83.34"),
                                         HasSubstr("0.07539"), HasSubstr("printed value 0.038")));
  EXPECT_THAT(findings[1].message,
              AllOf(HasSubstr("0.02,"), HasSubstr("0.02135"), HasSubstr("front_axle_m of 0.328")));
  EXPECT_THAT(findings[2].message, AllOf(HasSubstr("0.22"), HasSubstr("0.2139")));
  EXPECT_THAT(findings[3].message, HasSubstr("front_axle_m of 0.359"));
  EXPECT_THAT(findings[4].message, AllOf(HasSubstr("25"), HasSubstr("20")));
}

TEST(PaperCoastdown, HasTheStopTimeComputedBack) {
  std::vector<Finding> findings;
  const auto set = read_coastdown(kPaper / "coastdown.csv", {}, findings);
  ASSERT_TRUE(set) << to_text(set.error());
  const auto& rows = std::get<TrialSet<StopTimeRow>>(*set).rows;
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].initial_speed_mps, 1.66);
  // m' = (1-b1) a1 t_a/u_max^(1-b1)                                                 [paper (60)]
  // The paper prints 0.0768. Tolerance: t_a = 0.573 s is rounded to 0.5 ms, 0.09 %, which changes
  // m' by 7e-5; the rounding of the printed m' adds 5e-5.
  const double a1 = 1.3268;
  const double b1 = 0.8933;
  const double mass_norm = (1.0 - b1) * a1 * rows[0].stop_time_s / std::pow(1.66, 1.0 - b1);
  EXPECT_NEAR(mass_norm, 0.0768, 1.2e-4);
  EXPECT_TRUE(findings.empty());
}

}  // namespace
}  // namespace awmr::testing::paper_trials_test
