/// Shards of a comparison merge to the bytes of the whole.
#include "awmr/compare/shard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "awmr/compare/compare_findings.h"
#include "awmr/core/file.h"
#include "awmr/model/paper_gains.h"
#include "support/process.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const Provenance kShardProvenance{
    "compare", {{"samples", "6"}, {"seed", "3"}}, {{"model.json", "ab"}}};

class Shards : public ::testing::Test {
 protected:
  static CompareOptions options(Shard shard = {}) {
    CompareOptions options;
    options.samples = 6;
    options.seed = 3;
    options.preferences = {.weights = {{"tyre_work", 2.0}, {"finish_time_s", 0.0}},
                           .relevance = 0.02};
    options.shard = shard;
    return options;
  }
  static Comparison run(Shard shard = {}) {
    return compare(uncertain_model(), kPaperGains, {short_heading("one"), short_heading("another")},
                   options(shard))
        .value();
  }
  std::filesystem::path write(Shard shard, const Comparison& part,
                              const Provenance& provenance = kShardProvenance) {
    const auto path = directory_.path() / ("part" + std::to_string(directories_++));
    EXPECT_TRUE(
        write_part(comparison_shards(), path, comparison_part(part, options(shard), provenance)));
    return path;
  }
  std::filesystem::path write(Shard shard) { return write(shard, run(shard)); }
  static std::string fault(const std::vector<std::filesystem::path>& parts) {
    const auto merged = merge_shards(parts);
    EXPECT_FALSE(merged);
    return merged ? "" : to_text(merged.error());
  }

  TemporaryDirectory directory_;
  int directories_ = 0;
};

TEST_F(Shards, KeepTheCommandsOfTheScenarios) {
  Model model = uncertain_model();
  model.vehicle.yaw_rate_max_degps = 1e-3;  // so that every turn is beyond the trials
  std::vector<Scenario> scenarios{short_heading("one"), short_heading("another")};
  for (Scenario& scenario : scenarios) limit_heading_rate(12.0, 0.01, scenario);
  const auto part = [&](Shard shard) {
    return compare(model, kPaperGains, scenarios, options(shard)).value();
  };
  const std::vector<Finding> whole = extrapolation_findings(part({}), kShardProvenance);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_THAT(whole.front().message, HasSubstr("from 12 to 0.001 deg/s"));
  const auto merged =
      merge_shards({write({1, 2}, part({1, 2})), write({2, 2}, part({2, 2}))}).value();
  ASSERT_EQ(merged.findings.size(), 1U);
  EXPECT_EQ(merged.findings.front().message, whole.front().message);
}

TEST_F(Shards, OfDifferentArithmeticAreNotMixed) {
  Comparison second = run({2, 2});
  second.arithmetic = "other";
  EXPECT_THAT(fault({write({1, 2}), write({2, 2}, second)}),
              HasSubstr("was computed in other arithmetic"));
}

TEST_F(Shards, MergeInAnyOrderToTheBytesOfASingleRun) {
  const Comparison whole = run();
  for (const int count : {1, 2, 3, 7}) {
    std::vector<std::filesystem::path> parts;
    for (int i = count; i >= 1; --i) parts.push_back(write({i, count}));
    const auto merged = merge_shards(parts);
    ASSERT_TRUE(merged) << to_text(merged.error());
    EXPECT_EQ(comparison_csv(merged->comparison), comparison_csv(whole)) << count;
    EXPECT_EQ(comparison_text(merged->comparison, merged->options, merged->provenance),
              comparison_text(whole, options(), kShardProvenance))
        << count;
  }
}

TEST_F(Shards, NamesMissingAndDuplicateParts) {
  const auto first = write({1, 4});
  const auto second = write({2, 4});
  EXPECT_THAT(fault({first, second}), HasSubstr("of 4 parts, these are missing: 3, 4"));
  EXPECT_THAT(fault({second}), HasSubstr("these are missing: 1, 3, 4"));
  EXPECT_THAT(fault({first, second, first}), HasSubstr("is part 1 of 4, and so is"));
  EXPECT_THAT(fault({}), HasSubstr("no directories"));
  EXPECT_THAT(fault({directory_.path()}), HasSubstr("shard.json"));
}

TEST_F(Shards, PartsOfDifferentComparisonsAreRefused) {
  const auto first = write({1, 2});
  Provenance other = kShardProvenance;
  other.inputs[0].sha256 = "cd";
  EXPECT_THAT(fault({first, write({2, 2}, run({2, 2}), other)}),
              HasSubstr("the inputs of this part"));
  other = kShardProvenance;
  other.options[1].second = "4";
  EXPECT_THAT(fault({first, write({2, 2}, run({2, 2}), other)}),
              HasSubstr("the options of this part"));
  EXPECT_THAT(fault({first, write({2, 3})}), HasSubstr("one of 3 parts"));
}

TEST_F(Shards, DamagedPartsAreRefused) {
  const auto first = write({1, 2});
  const auto second = write({2, 2});
  const std::string csv = read_file(second / "comparison.csv").value();
  ASSERT_TRUE(
      write_file(second / "comparison.csv", csv.substr(0, csv.rfind('\n', csv.size() - 2) + 1)));
  EXPECT_THAT(fault({first, second}), HasSubstr("not as it was written"));
  Comparison shorter = run({2, 2});
  shorter.rows.pop_back();
  EXPECT_THAT(fault({first, write({2, 2}, shorter)}), HasSubstr("rows are missing"));
  Comparison twice = run({2, 2});
  twice.rows.push_back(twice.rows.back());
  EXPECT_THAT(
      fault({first, write({2, 2}, twice)}),
      HasSubstr("has sample 5, but 1 is expected: rows are missing, repeated or from another "
                "part; run part 2 of 2 again"));
  // Rows of a whole scenario are missing, or have the name of another scenario.
  Comparison half = run({2, 2});
  half.rows.resize(half.rows.size() / 2);
  EXPECT_THAT(fault({first, write({2, 2}, half)}), HasSubstr("part 2 of 2 has fewer rows"));
  std::copy_n(half.rows.begin(), half.rows.size(), std::back_inserter(half.rows));
  EXPECT_THAT(fault({first, write({2, 2}, half)}), HasSubstr("are missing or appear twice"));
  // The file of this shard contains rows of another one.
  EXPECT_THAT(fault({first, write({2, 2}, run({1, 2}))}), HasSubstr("row 1 has sample 0,"));
}

TEST_F(Shards, PartWithoutSamplesIsRefused) {
  const auto a = directory_.path() / "a";
  const auto b = directory_.path() / "b";
  CompareOptions nominal_only = options({1, 2});
  nominal_only.samples = 0;
  Comparison first = run({1, 2});
  std::erase_if(first.rows, [](const ComparisonRow& row) { return row.sample != 0; });
  ASSERT_TRUE(
      write_part(comparison_shards(), a, comparison_part(first, nominal_only, kShardProvenance)));
  nominal_only.shard = {2, 2};
  ASSERT_TRUE(write_part(comparison_shards(), b,
                         comparison_part(run({2, 2}), nominal_only, kShardProvenance)));
  EXPECT_THAT(fault({a, b}), HasSubstr("/2; expected I/N"));
}

}  // namespace
}  // namespace awmr::testing
