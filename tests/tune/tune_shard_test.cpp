/// Validation in shards: the merged runs have the bytes of a single run, and anything that is not
/// one of its shards is named.
#include "awmr/tune/tune_shard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "support/process.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const Provenance kProvenance{"tune", {{"draws", "1"}}, {{"model.json", std::string(64, 'a')}}};

/// Options for an evaluation on 7 new draws in two scenarios, with a hard and a soft goal and an
/// observer.
TuneOptions options_of(std::optional<Shard> shard) {
  TuneOptions options;
  options.draws = 1;
  options.evaluation_draws = 7;
  options.global_evaluations = 45;
  options.local_evaluations = 5;
  options.observer.emplace();
  Scenario calm = short_heading("calm");
  Scenario pushed = short_heading("pushed");
  pushed.disturbance.yaw = {DisturbanceTerm()};
  pushed.disturbance.yaw.front().value = 0.005;
  options.scenarios = {calm, pushed};
  options.goals = {{.at_most = {{"settling_time_s", 9.0}}, .share = 0.6, .mode = {}},
                   {.at_most = {{"overshoot_deg", 0.3}, {"control_variation", 4.0}},
                    .share = 0.9,
                    .mode = YawMode::kSteering,
                    .is_soft = true}};
  options.shard = shard;
  return options;
}

class TuneShard : public ::testing::Test {
 protected:
  std::filesystem::path write(const Shard& shard) const {
    const TuneOptions options = options_of(shard);
    const Result<Tuning> tuning = tune(uncertain_model(), options);
    EXPECT_TRUE(tuning) << to_text(tuning.error());
    const auto path = directory_.path() / fmt::format("{}_{}", shard.index, shard.count);
    EXPECT_TRUE(write_part(tune_shards(), path, tune_part(*tuning, options, kProvenance)));
    return path;
  }
  static std::string fault(const std::vector<std::filesystem::path>& parts) {
    const auto merged = merge_tune_shards(parts);
    return merged ? "merged" : to_text(merged.error());
  }
  /// Replaces `from` in the text by `to`.
  static void edit(const std::filesystem::path& path, const std::string& from,
                   const std::string& to) {
    std::string text = read_all(path);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << path << " has no " << from;
    write_all(path, text.replace(at, from.size(), to));
  }

  TemporaryDirectory directory_;
};

TEST_F(TuneShard, PartsAreTheBytesOfASingleRunInAnyOrder) {
  const TuneOptions options = options_of({});
  const Result<Tuning> whole = tune(uncertain_model(), options);
  ASSERT_TRUE(whole) << to_text(whole.error());
  const std::string expected = gains_text(*whole, options, kProvenance);
  const auto first = write({1, 3}), second = write({2, 3}), third = write({3, 3});
  const auto merged = merge_tune_shards({third, first, second});
  ASSERT_TRUE(merged) << to_text(merged.error());
  EXPECT_EQ(merged->gains_text, expected);
  EXPECT_EQ(merged->goals.size(), whole->robust->goals.size());
  EXPECT_EQ(merge_tune_shards({write({1, 1})})->gains_text, expected);
  EXPECT_THAT(fault({first, third}), HasSubstr("2"));
  EXPECT_THAT(fault({first, first, second, third}), HasSubstr("and so is"));
}

TEST_F(TuneShard, NamesFilesThatAreNotOfThePart) {
  const auto first = write({1, 2}), second = write({2, 2});
  EXPECT_TRUE(is_finished_part(tune_shards(), first, {1, 2}, kProvenance));
  EXPECT_FALSE(is_finished_part(tune_shards(), first, {2, 2}, kProvenance));
  const std::string table = read_all(first / "judged.csv");
  edit(first / "judged.csv", "robust,1,", "robust,2,");
  EXPECT_THAT(fault({first, second}), HasSubstr("judged.csv"));
  EXPECT_FALSE(is_finished_part(tune_shards(), first, {1, 2}, kProvenance));
  write_all(first / "judged.csv", table);
  edit(first / "gains.json", "\"lambda\"", "\"lambda_\"");
  EXPECT_THAT(fault({first, second}), HasSubstr("gains.json"));
  EXPECT_FALSE(is_finished_part(tune_shards(), first, {1, 2}, kProvenance));
  edit(first / "gains.json", "\"lambda_\"", "\"lambda\"");
  EXPECT_EQ(fault({first, second}), "merged");
  edit(second / kShardFile, "\"tail_share\": 0.2", "\"tail_share\": 2");
  EXPECT_THAT(fault({first, second}), HasSubstr("/tail_share"));
  edit(second / kShardFile, "\"tail_share\": 2", "\"tail_share\": 0.2");
  edit(second / kShardFile, "\"judged_draws\": 7", "\"judged_draws\": 8");
  EXPECT_THAT(fault({first, second}), HasSubstr("other options"));
}

/// Tables with lost, duplicated or moved rows whose hash was adapted are refused.
TEST_F(TuneShard, NamesTheFirstWrongLineOfATable) {
  const auto only = write({1, 1});
  const std::string table = read_all(only / "judged.csv");
  const std::string shard = read_all(only / kShardFile);
  const auto fault_of = [&](const std::string& text) {
    write_all(only / "judged.csv", text);
    write_all(only / kShardFile, shard);
    edit(only / kShardFile, sha256_hex(table), sha256_hex(text));
    return fault({only});
  };
  EXPECT_EQ(fault_of(table), "merged");
  const std::size_t second = table.find('\n') + 1;
  const std::size_t third = table.find('\n', second) + 1;
  EXPECT_THAT(fault_of(table.substr(0, second) + table.substr(third)), HasSubstr("judged.csv:2:1"));
  EXPECT_THAT(fault_of(table.substr(0, third) + table.substr(second)), HasSubstr("judged.csv:3:1"));
  EXPECT_THAT(fault_of(table + "x\n"), HasSubstr("is not a run of this part"));
  EXPECT_THAT(fault_of(table.substr(0, table.size() - 20)), HasSubstr("run the part again"));
  EXPECT_THAT(fault_of("a" + table), HasSubstr("judged.csv:1:1"));
}

TEST_F(TuneShard, RefusesNominalGainsAndEmptyParts) {
  TuneOptions options = options_of(Shard{1, 8});
  EXPECT_THAT(to_text(tune(uncertain_model(), options).error()), HasSubstr("at most the 7"));
  options.shard = Shard{1, 2};
  options.goals.clear();
  options.nominal = true;
  EXPECT_THAT(to_text(tune(uncertain_model(), options).error()), HasSubstr("nominal"));
}

}  // namespace
}  // namespace awmr::testing
