#include "awmr/model/gains_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "json_edit.h"

namespace awmr::testing {
namespace {

using ::testing::IsEmpty;

const char* const kText = R"({
  "schema": "awmr.gains/1",
  "heading": {"lambda": 3, "mu": 50, "epsilon": 12},
  "speed": {"mu": 5, "epsilon": 1.2}
})";

TEST(GainsFile, ReadsTheGains) {
  const ScratchFile file("gains.json", kText);
  const auto gains = read_gains(file.path());
  ASSERT_TRUE(gains) << to_text(gains.error());
  EXPECT_EQ(gains->heading.lambda, 3.0);
  EXPECT_EQ(gains->heading.mu, 50.0);
  EXPECT_EQ(gains->heading.epsilon, 12.0);
  EXPECT_EQ(gains->speed.mu, 5.0);
  EXPECT_EQ(gains->speed.epsilon, 1.2);
}

TEST(GainsFile, OfAnotherKindIsOneFault) {
  EXPECT_THAT(faults_of(read_gains, R"({"schema": "awmr.model/1", "vehicle": {}, "surge": {}})"),
              ::testing::ElementsAre(::testing::StartsWith("/schema: ")));
}

TEST(GainsFile, WritesWhatItReads) {
  const ScratchFile file("gains.json", "");
  const Gains<double> gains{{2.5, 40.0, 8.0}, {4.0, 1.5}};
  ASSERT_TRUE(write_gains(gains, file.path()));
  const auto read = read_gains(file.path());
  ASSERT_TRUE(read) << to_text(read.error());
  EXPECT_EQ(read->heading.lambda, 2.5);
  EXPECT_EQ(read->heading.mu, 40.0);
  EXPECT_EQ(read->heading.epsilon, 8.0);
  EXPECT_EQ(read->speed.mu, 4.0);
  EXPECT_EQ(read->speed.epsilon, 1.5);
  EXPECT_FALSE(write_gains(gains, "/no/such/directory/gains.json"));
}

TEST(GainsFile, WritesAndReadsAnObserverWhereThereIsOne) {
  const ScratchFile file("gains.json", kText);
  EXPECT_FALSE(read_gains(file.path())->observer.is_on());
  ASSERT_TRUE(write_gains({{3.0, 50.0, 12.0}, {5.0, 1.2}}, file.path()));
  EXPECT_EQ(read_json_file(file.path())->contains("observer"), false);
  ASSERT_TRUE(write_gains({{3.0, 50.0, 12.0}, {5.0, 1.2}, {2.5, 0.04, 1.3}}, file.path()));
  const auto read = read_gains(file.path());
  ASSERT_TRUE(read) << to_text(read.error());
  EXPECT_EQ(read->observer.bandwidth_radps, 2.5);
  EXPECT_EQ(read->observer.yaw_max_m, 0.04);
  EXPECT_EQ(read->observer.surge_max, 1.3);
  EXPECT_TRUE(read_gains_for(file.path(), 0.3));
  const auto too_fast = read_gains_for(file.path(), 0.4);
  ASSERT_FALSE(too_fast);
  EXPECT_THAT(to_text(too_fast.error()), ::testing::HasSubstr("/observer/bandwidth_radps"));
}

TEST(GainsFile, WritesAndReadsAFrictionWidthWhereItIsNotTheDefault) {
  const ScratchFile file("gains.json", kText);
  EXPECT_EQ(read_gains(file.path())->heading.friction_width_radps, 0.02);
  ASSERT_TRUE(write_gains({{3.0, 50.0, 12.0}, {5.0, 1.2}}, file.path()));
  EXPECT_FALSE(read_json_file(file.path())->at("heading").contains("friction_width_radps"));
  ASSERT_TRUE(write_gains({{3.0, 50.0, 12.0, 0.15}, {5.0, 1.2}}, file.path()));
  EXPECT_EQ(read_gains(file.path())->heading.friction_width_radps, 0.15);
  // Without the key, the friction width of the combined mode is half of that of the steering mode.
  EXPECT_FALSE(
      read_json_file(file.path())->at("heading").contains("combined_friction_width_radps"));
  EXPECT_EQ(read_gains(file.path())->friction_width_at(0.5), 0.075);
  ASSERT_TRUE(write_gains({{3.0, 50.0, 12.0, 0.15, 0.04}, {5.0, 1.2}}, file.path()));
  EXPECT_EQ(read_gains(file.path())->friction_width_at(0.5), 0.04);
}

TEST(GainsFile, ReadsTheGainsOfSingleModes) {
  Json json = Json::parse(kText);
  json["observer"] = {{"bandwidth_radps", 2.5}, {"yaw_max_m", 0.04}, {"surge_max", 1.3}};
  json["modes"]["steering"] = {{"heading", {{"lambda", 1}, {"mu", 20}, {"epsilon", 8}}},
                               {"speed", {{"mu", 2}, {"epsilon", 1}}},
                               {"objective", {{"value", 0.9}}}};
  const ScratchFile file("gains.json", json.dump());
  const auto gains = read_mode_gains(file.path());
  ASSERT_TRUE(gains) << to_text(gains.error());
  EXPECT_EQ(gains->in(YawMode::kSteering).heading.lambda, 1.0);
  EXPECT_EQ(gains->in(YawMode::kSteering).speed.mu, 2.0);
  EXPECT_FALSE(gains->in(YawMode::kSteering).observer.is_on());
  EXPECT_EQ(gains->in(YawMode::kCombined).observer.bandwidth_radps, 2.5);
  EXPECT_TRUE(gains->has_observer());
  EXPECT_TRUE(gains->has_own(YawMode::kSteering));
  EXPECT_FALSE(gains->has_own(YawMode::kDifferential));
  EXPECT_EQ(gains->in(YawMode::kDifferential).heading.lambda, 3.0);
  EXPECT_EQ(read_gains(file.path())->heading.lambda, 3.0);
  json["mode"] = "combined";
  const ScratchFile both("both.json", json.dump());
  EXPECT_EQ(read_mode_gains(both.path()).error().faults.front().code, ErrorCode::kConflict);
}

TEST(GainsFile, IgnoresTheContentOfTheOtherKeysOfTheFormat) {
  Json json = Json::parse(kText);
  for (const char* key : {"command", "version", "options", "inputs", "time_constants", "objective",
                          "metrics", "search", "baseline"}) {
    json[key] = Json::object({{"anything", 1}});
  }
  json["constraints"] = Json::array({Json::object({{"anything", 1}})});
  EXPECT_THAT(faults_of(read_gains, json.dump()), IsEmpty());
}

TEST(GainsFile, RefusesResultsOfAnotherType) {
  for (const char* key : {"limits", "certificate", "metrics", "robust", "constraints"}) {
    Json json = Json::parse(kText);
    json[key] = 3;
    EXPECT_EQ(faults_of(read_gains, json.dump()).size(), 1U) << key;
  }
}

TEST(GainsFile, HasThePapersGainsWithTheirTimeConstants) {
  // T1 = 1/3 s, T2 = 12/(2 x 50) = 0.12 s                                     [paper (91), (95)]
  EXPECT_DOUBLE_EQ(kPaperGains.heading.sliding_time_constant_s(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(kPaperGains.heading.reaching_time_constant_s(), 0.12);
  EXPECT_DOUBLE_EQ(kPaperGains.speed.epsilon / kPaperGains.speed.mu,
                   kPaperGains.heading.epsilon / kPaperGains.heading.mu);
}

}  // namespace
}  // namespace awmr::testing
