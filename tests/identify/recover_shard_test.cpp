/// Merging all shards of a recovery gives the same bytes as a run on one machine.
#include "awmr/identify/planning/recover_shard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/option_text.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const Provenance kProvenance{
    "recover", {{"runs", "7"}, {"recover_seed", "1"}}, {{"model.json", "ab"}}};

/// A model and its runs, used by all tests.
const Model& model() {
  static const Model fitted = [] {
    Model made = identify(paper_vehicle(), synthetic(kTruths[0], 0.02, 1), {}, {})->model;
    made[ParameterId::kSwayAlpha].value = 3.0;
    return made;
  }();
  return fitted;
}

RecoverOptions seven_runs() {
  RecoverOptions options;
  options.runs = 7;
  options.threads = 1;
  return options;
}

std::string bytes_of(const Recovery& recovery) { return recovery_text(recovery, kProvenance); }

constexpr const char* kRecoverTable = "recovery.csv";

/// The model's mass is from coast-down curves, which leave no rows of `/trials`: tables simulated
/// from these rows do not determine it.
TEST(Recover, ReportsQuantitiesThatTheSimulatedTrialsDoNotDetermine) {
  Model curved = model();
  std::erase_if(curved.record.trials,
                [](const TrialPoint& trial) { return trial.kind == TrialKind::kCoastdown; });
  RecoverOptions options = seven_runs();
  const auto by_tables = recover(curved, options, {});
  ASSERT_TRUE(by_tables) << to_text(by_tables.error());
  ASSERT_EQ(by_tables->findings.size(), 1U);
  const Finding& note = by_tables->findings.front();
  EXPECT_EQ(note.code, "not-identifiable");
  EXPECT_EQ(note.severity, Severity::kNote);
  EXPECT_THAT(note.message, HasSubstr("mass_norm, inertia_norm"));
  EXPECT_THAT(note.message, HasSubstr(option_text("plan curve")));
  EXPECT_EQ(by_tables->parameters.size() + 2, recover(model(), options, {})->parameters.size());
  options.plan = RecoverPlan::kCurve;
  const auto by_curve = recover(curved, options, {});
  ASSERT_TRUE(by_curve) << to_text(by_curve.error());
  EXPECT_TRUE(by_curve->findings.empty());
}

class RecoverShards : public ::testing::Test {
 protected:
  static RecoverPart part(Shard shard) {
    return recover_part(model(), seven_runs(), shard, {}).value();
  }
  fs::path write(Shard shard, const RecoverPart& part, const Provenance& provenance = kProvenance) {
    const fs::path path = directory_.path() / ("part" + std::to_string(directories_++));
    EXPECT_TRUE(write_part(recover_shards(), path, recover_part_text(part, shard, provenance)));
    return path;
  }
  fs::path write(Shard shard) { return write(shard, part(shard)); }
  /// Replaces the table of the shard in the directory, and its hash.
  static void change(const fs::path& path, const std::string& table) {
    std::string shard = read_all(path / kShardFile);
    const std::string before = sha256_hex(read_all(path / kRecoverTable));
    shard.replace(shard.find(before), before.size(), sha256_hex(table));
    write_all(path / kShardFile, shard);
    write_all(path / kRecoverTable, table);
  }
  static std::string fault(const std::vector<fs::path>& parts) {
    const auto merged = merge_recover_shards(parts);
    EXPECT_FALSE(merged);
    return merged ? "" : to_text(merged.error());
  }

  TemporaryDirectory directory_;
  int directories_ = 0;
};

TEST_F(RecoverShards, MergeInAnyOrderToTheBytesOfASingleRun) {
  const std::string whole = bytes_of(recover(model(), seven_runs(), {}).value());
  for (const int count : {1, 2, 3, 7}) {
    std::vector<fs::path> parts;
    for (int i = count; i >= 1; --i) parts.push_back(write({i, count}));
    const auto merged = merge_recover_shards(parts);
    ASSERT_TRUE(merged) << to_text(merged.error());
    EXPECT_EQ(recovery_text(recovery_of(merged->whole).value(), merged->provenance), whole)
        << count;
  }
}

TEST_F(RecoverShards, OfLogsMergeToTheBytesOfASingleRun) {
  RecoverOptions options = seven_runs();
  options.runs = 3;
  options.plan = RecoverPlan::kLog;
  options.drive.duration_s = 10.0;
  const auto whole = recover(model(), options, {});
  ASSERT_TRUE(whole) << to_text(whole.error());
  std::vector<fs::path> parts;
  for (const int i : {1, 2}) {
    parts.push_back(write({i, 2}, recover_part(model(), options, {i, 2}, {}).value()));
  }
  const auto merged = merge_recover_shards(parts);
  ASSERT_TRUE(merged) << to_text(merged.error());
  EXPECT_EQ(bytes_of(recovery_of(merged->whole).value()), bytes_of(*whole));
}

TEST_F(RecoverShards, RefusesInPartsWhatItRefusesAsAWhole) {
  // The model's tables do not identify the servo: no run gives its time constant.
  RecoverOptions options = seven_runs();
  options.identify.requested = {ParameterId::kSteeringTimeConstant};
  const auto whole = recover(model(), options, {});
  ASSERT_FALSE(whole);
  std::vector<fs::path> parts;
  for (const int i : {1, 2, 3}) {
    const auto part = recover_part(model(), options, {i, 3}, {});
    ASSERT_TRUE(part) << "a single part cannot know that all runs fail";
    parts.push_back(write({i, 3}, *part));
  }
  const auto merged = merge_recover_shards(parts);
  ASSERT_TRUE(merged) << to_text(merged.error());
  const auto recovery = recovery_of(merged->whole);
  ASSERT_FALSE(recovery);
  EXPECT_EQ(to_text(recovery.error()), to_text(whole.error()));
  EXPECT_EQ(exit_code(recovery.error()), 1);
}

TEST_F(RecoverShards, AnErrorOfAllRunsIsThatOfTheFirst) {
  RecoverPart one = part({1, 2});
  RecoverPart two = part({2, 2});
  for (RecoverPart* failed : {&one, &two}) {
    for (RecoverRun& run : failed->runs)
      run = {run.index, true, std::vector(run.estimates.size(), std::optional<RecoverEstimate>())};
  }
  one.error = input_error(ErrorCode::kBrokenFile, "here", "the first\nrun").value();
  EXPECT_THAT(
      to_text(recovery_of(merge_recover_shards({write({1, 2}, one), write({2, 2}, two)})->whole)
                  .error()),
      HasSubstr("[not-recovered]"));
  two.error = refusal(ErrorCode::kNotRecovered, "another").value();
  const auto recovery =
      recovery_of(merge_recover_shards({write({2, 2}, two), write({1, 2}, one)})->whole);
  ASSERT_FALSE(recovery);
  EXPECT_EQ(to_text(recovery.error()), to_text(*one.error));
}

TEST_F(RecoverShards, ReportsTheRefusalOfTheSmallestRun) {
  RecoverPart one = part({1, 2});
  RecoverPart two = part({2, 2});
  one.refusal = {4, "later"};
  two.refusal = {1, "first"};
  EXPECT_EQ(merge_recover_shards({write({1, 2}, one), write({2, 2}, two)})->whole.refusal->message,
            "first");
}

TEST_F(RecoverShards, NamesMissingAndDuplicateParts) {
  const auto first = write({1, 4});
  const auto second = write({2, 4});
  EXPECT_THAT(fault({first, second}), HasSubstr("of 4 parts, these are missing: 3, 4"));
  EXPECT_THAT(fault({first, second, first}), HasSubstr("is part 1 of 4, and so is"));
  EXPECT_THAT(fault({}), HasSubstr("no directories"));
  EXPECT_THAT(fault({directory_.path()}), HasSubstr("shard.json"));
}

TEST_F(RecoverShards, RefusesEmptyAndInvalidParts) {
  for (const Shard shard : {Shard{0, 2}, Shard{3, 2}, Shard{1, 0}, Shard{-1, -1}, Shard{1, 8}}) {
    const auto part = recover_part(model(), seven_runs(), shard, {});
    ASSERT_FALSE(part);
    EXPECT_THAT(to_text(part.error()), HasSubstr("at most the 7 runs"));
  }
}

TEST_F(RecoverShards, PartsOfDifferentRecoveriesAreRefused) {
  const auto first = write({1, 2});
  Provenance other = kProvenance;
  other.inputs[0].sha256 = "cd";
  EXPECT_THAT(fault({first, write({2, 2}, part({2, 2}), other)}),
              HasSubstr("the inputs of this part (model.json)"));
  other = kProvenance;
  other.options[1].second = "4";
  EXPECT_THAT(fault({first, write({2, 2}, part({2, 2}), other)}),
              HasSubstr("options of this part (recover_seed)"));
  EXPECT_THAT(fault({first, write({2, 3})}), HasSubstr("one of 3 parts"));
  RecoverPart second = part({2, 2});
  second.truths[0].value *= 2.0;
  EXPECT_THAT(fault({first, write({2, 2}, second)}), HasSubstr("options of this part differ"));
}

TEST_F(RecoverShards, OfMachinesThatRoundDifferentlyAreNotMixed) {
  const auto first = write({1, 2});
  const auto second = write({2, 2});
  std::string shard = read_all(second / kShardFile);
  const std::string key = "\"arithmetic\": \"";
  shard.replace(shard.find(key) + key.size(), 4, "none");
  write_all(second / kShardFile, shard);
  EXPECT_THAT(fault({first, second}), HasSubstr("their numbers are rounded differently"));
}

TEST_F(RecoverShards, DamagedTablesAreNamed) {
  const auto first = write({1, 2});
  const auto second = write({2, 2});
  const std::string table = read_all(second / kRecoverTable);
  const std::string last = table.substr(0, table.rfind('\n', table.size() - 2) + 1);
  write_all(second / kRecoverTable, last);
  EXPECT_THAT(fault({first, second}), HasSubstr("is not as it was written with shard.json"));
  write_all(second / kRecoverTable, table);
  const auto expect = [&](const std::string& changed, const std::string& words) {
    change(second, changed);
    EXPECT_THAT(fault({first, second}), HasSubstr(words)) << changed.substr(0, 200);
  };
  const std::size_t row = table.find('\n') + 1;  // "1,0,VALUE,..."
  const std::size_t value = row + 4;
  const auto with = [&](const std::string& cell) {
    return table.substr(0, value) + cell + table.substr(table.find(',', value));
  };
  expect(last, "has 2 runs, but part 2 of 2 (of 7 runs in all) needs 3");
  expect(table + table.substr(row, table.find('\n', row) + 1 - row),
         "has 4 runs, but part 2 of 2 (of 7 runs in all) needs 3");
  expect(table + table.substr(row), "has 6 runs, but part 2 of 2 (of 7 runs in all) needs 3");
  const auto first_run = [&](const std::string& run) {
    return table.substr(0, row) + run + table.substr(row + 1);
  };
  for (const char* run : {"2", "3", "7", "-1"}) {
    expect(first_run(run), std::string("row 1 has run ") + run + ",");
  }
  for (const char* cell : {"nan", "inf", "1e308", "", "x", "0x1"}) {
    expect(with(cell), "recovery.csv:2:1: is not a valid row for these columns");
  }
  expect(table.substr(0, row + 2) + "2" + table.substr(row + 3),
         "recovery.csv:2:1: is not a valid row");
  expect("sum" + table.substr(3), "recovery.csv:1:1: these are not the columns");
  expect("", "recovery.csv:1:1: these are not the columns");
  change(second, table);
  EXPECT_TRUE(merge_recover_shards({first, second}));
}

}  // namespace
}  // namespace awmr::testing
