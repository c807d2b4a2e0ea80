/// Comparisons in float32: what is told of their effect is what a comparison in double differs by.
#include "awmr/compare/float32_effect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "awmr/compare/resume.h"
#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/core/json.h"
#include "awmr/core/option_text.h"
#include "awmr/model/paper_gains.h"
#include "support/process.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const Provenance kInFloat32{"compare", {{"float32", "true"}}, {{"model.json", "ab"}}};
const Provenance kInDouble{"compare", {}, {{"model.json", "ab"}}};

CompareOptions options_for(bool float32, int samples = 40) {
  CompareOptions options;
  options.samples = samples;
  options.seed = 3;
  options.float32 = float32;
  return options;
}

std::vector<Scenario> courses() { return {short_heading("one"), short_heading("another")}; }

Result<Comparison> run(const CompareOptions& options,
                       const std::vector<Scenario>& scenarios = courses()) {
  return compare(uncertain_model(), kPaperGains, scenarios, options);
}

std::string fault(const CompareOptions& options, const std::vector<Scenario>& scenarios,
                  const Model& model = uncertain_model()) {
  const auto refused = compare(model, kPaperGains, scenarios, options);
  EXPECT_FALSE(refused);
  return refused ? "" : to_text(refused.error(), "--");
}

TEST(Float32, TheSameBytesWhateverTheNumberOfThreads) {
  CompareOptions options = options_for(true);
  options.threads = 1;
  const Comparison one = run(options).value();
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const Comparison other = run(options).value();
    EXPECT_EQ(comparison_csv(one), comparison_csv(other)) << threads;
    EXPECT_EQ(in_double_csv(one), in_double_csv(other)) << threads;
    EXPECT_EQ(comparison_text(one, options, kInFloat32),
              comparison_text(other, options, kInFloat32));
  }
}

/// The runs that check a comparison in float32 are those of the same comparison without the option.
TEST(Float32, ItsChecksAreTheFirstSamplesOfAComparisonInDouble) {
  const Comparison in_float32 = run(options_for(true)).value();
  Comparison in_double = run(options_for(false)).value();
  EXPECT_TRUE(in_float32.is_float32());
  EXPECT_FALSE(in_double.is_float32());
  EXPECT_THAT(in_double.in_double, IsEmpty());
  EXPECT_NE(comparison_csv(in_float32), comparison_csv(in_double));
  std::erase_if(in_double.rows,
                [](const ComparisonRow& row) { return row.sample >= kCheckedSamples; });
  EXPECT_EQ(in_float32.in_double.size(), 2U * 3U * 32U);
  EXPECT_EQ(in_double_csv(in_float32), comparison_csv(in_double));
}

/// Every figure of the effect, worked out again from two comparisons.
TEST(Float32, ItsEffectIsWhatTwoComparisonsDifferBy) {
  const CompareOptions options = options_for(true);
  const Comparison in_float32 = run(options).value();
  const Comparison in_double = run(options_for(false)).value();
  const Float32Check check = check_of(in_float32, options);
  EXPECT_EQ(check.samples, kCheckedSamples);
  EXPECT_EQ(check.in_double, 0U);
  ASSERT_FALSE(check.effects.empty());
  double largest_of_all = 0.0;
  for (const Float32Effect& effect : check.effects) {
    const MetricColumn& metric = column_of(effect.metric);
    std::vector<double> differences, drawn;
    for (std::size_t i = 0; i < in_double.rows.size(); ++i) {
      const ComparisonRow& row = in_double.rows[i];
      if (row.scenario != effect.scenario || row.mode != effect.contender.mode ||
          row.sample >= kCheckedSamples) {
        continue;
      }
      const auto value = metric.value(row.metrics);
      if (!value) continue;
      differences.push_back(std::abs(*metric.value(in_float32.rows[i].metrics) - *value));
      if (row.sample > 0) drawn.push_back(*value);
    }
    ASSERT_EQ(effect.count, differences.size());
    EXPECT_EQ(effect.lost, 0U);
    EXPECT_DOUBLE_EQ(effect.largest, *std::max_element(differences.begin(), differences.end()));
    double squares = 0.0, deviation = 0.0;
    for (const double one : differences) squares += one * one;
    EXPECT_NEAR(effect.rms, std::sqrt(squares / static_cast<double>(differences.size())),
                1e-12 * effect.rms);
    const double mean =
        std::accumulate(drawn.begin(), drawn.end(), 0.0) / static_cast<double>(drawn.size());
    for (const double value : drawn) deviation += (value - mean) * (value - mean);
    EXPECT_NEAR(effect.spread.value(), std::sqrt(deviation / static_cast<double>(drawn.size() - 1)),
                1e-9 * mean);
    largest_of_all = std::max(largest_of_all, effect.largest);
  }
  EXPECT_GT(largest_of_all, 0.0);
}

TEST(Float32, ItsEffectStandsInTheFileAndInTheTable) {
  const CompareOptions options = options_for(true);
  const Comparison c = run(options).value();
  const Json json = Json::parse(comparison_text(c, options, kInFloat32));
  EXPECT_THAT(json["arithmetic"].get<std::string>(), HasSubstr(" float32"));
  EXPECT_EQ(json["float32"]["samples"], 32);
  EXPECT_EQ(json["float32"]["effects"].size(), check_of(c, options).effects.size());
  EXPECT_THAT(comparison_table(c, options), HasSubstr("float32 against double, over 32 sample(s)"));
  for (const MetricColumn& metric : kMetricColumns) {
    if (!metric.value(c.rows.front().metrics)) continue;
    EXPECT_THAT(float32_details(c, options), HasSubstr(metric.name));
  }
  EXPECT_THAT(float32_findings(c, options), IsEmpty()) << "small on a short heading step";
  const Comparison in_double = run(options_for(false)).value();
  EXPECT_THAT(comparison_text(in_double, options_for(false), kInDouble), Not(HasSubstr("float32")));
  EXPECT_THAT(comparison_table(in_double, options_for(false)), Not(HasSubstr("float32")));
  EXPECT_EQ(float32_details(in_double, options_for(false)), "");
}

/// A made-up effect: a metric of one mode is off by a spread, another is lost, one run was in
/// double.
TEST(Float32, AnEffectThatIsNotSmallIsAFinding) {
  const CompareOptions options = options_for(true);
  Comparison c = run(options).value();
  const auto codes_of = [&](const Comparison& comparison) {
    std::vector<std::string> codes;
    for (const Finding& finding : float32_findings(comparison, options)) {
      codes.push_back(finding.code);
    }
    return codes;
  };
  Comparison lost = c;
  lost.in_double.front().metrics.settling_time_s.reset();
  EXPECT_THAT(codes_of(lost), ::testing::Contains("float32-effect"));
  Comparison off = c;
  for (ComparisonRow& row : off.in_double) {
    if (row.mode == YawMode::kSteering) *row.metrics.heading_iae_degs *= 1.5;
  }
  const std::vector<Finding> findings = float32_findings(off, options);
  ASSERT_FALSE(findings.empty());
  EXPECT_THAT(findings.front().message, HasSubstr("heading_iae_degs"));
  // Half as much again changes what is concluded of steering and another mode, too.
  EXPECT_THAT(findings.back().message, HasSubstr("float32 concludes"));
  c.rows[5].took_float32 = false;
  EXPECT_THAT(codes_of(c), ::testing::ElementsAre("float32-in-double"));
  EXPECT_THAT(comparison_table(c, options), HasSubstr("1 run(s) in double"));
}

/// No float holds a resistance of 1e39 u^130: the controller's own vehicle is driven in double.
TEST(Float32, RunsThatItCannotFollowAreSaidToBeInDouble) {
  Model model = uncertain_model();
  model[ParameterId::kSurgeAlpha].value = 1e39;
  model[ParameterId::kSurgeBeta].value = 130.0;
  const CompareOptions options = options_for(true, 0);
  const Scenario thrust{"thrust", 1.0, {}, 0.0, OpenLoop{1.0, 0.0}};
  const auto c = compare(model, kPaperGains, {thrust}, options);
  ASSERT_TRUE(c) << to_text(c.error());
  for (const ComparisonRow& row : c->rows) EXPECT_FALSE(row.took_float32);
  EXPECT_EQ(check_of(*c, options).in_double, 3U);
  EXPECT_EQ(float32_findings(*c, options).front().code, "float32-in-double");
}

/// Of drawn samples that are all the same vehicle there is no spread, though their mean is rounded.
TEST(Float32, AMetricThatIsTheSameInAllSamplesHasNoShareOfItsSpread) {
  const CompareOptions options = options_for(true, 3);
  Comparison c = run(options).value();
  for (std::vector<ComparisonRow>* rows : {&c.rows, &c.in_double}) {
    for (ComparisonRow& row : *rows) row.metrics.path_length_m = 0.1;
  }
  for (ComparisonRow& row : c.rows) row.metrics.path_length_m += 1e-9;
  for (const Float32Effect& effect : check_of(c, options).effects) {
    if (effect.metric != MetricId::kPathLength) continue;
    EXPECT_EQ(effect.spread, 0.0);
    EXPECT_FALSE(effect.of_spread(effect.rms).has_value());
    EXPECT_FALSE(effect.matters());
  }
}

TEST(Float32, WhatItDoesNotDoIsRefusedByName) {
  Scenario on_tyres = short_heading();
  on_tyres.tyres.emplace();
  EXPECT_THAT(fault(options_for(true), {on_tyres}), HasSubstr("--float32: knows no tyres"));
  CompareOptions options = options_for(true);
  options.break_even = true;
  EXPECT_THAT(fault(options, courses()), HasSubstr("--break-even: "));
  Model front = uncertain_model();
  front.vehicle.drive = Drive::kFrontWheel;
  EXPECT_THAT(fault(options_for(true), courses(), front), HasSubstr("front-wheel drive"));
  ::setenv("AWMR_INSTRUCTIONS", "scalar", 1);
  const std::string scalar = fault(options_for(true), courses());
  ::unsetenv("AWMR_INSTRUCTIONS");
  EXPECT_THAT(scalar, HasSubstr("--float32: needs vector instructions"));
}

class Float32Parts : public ::testing::Test {
 protected:
  std::filesystem::path write(Shard shard, bool float32) {
    CompareOptions options = options_for(float32);
    options.shard = shard;
    const Comparison part = run(options).value();
    const auto path = directory_.path() / ("part" + std::to_string(directories_++));
    std::filesystem::create_directories(path);
    EXPECT_TRUE(write_file(path / "comparison.csv", comparison_csv(part)));
    if (float32) {
      EXPECT_TRUE(write_file(path / kInDoubleTable, in_double_csv(part)));
    }
    // The same options: what keeps the parts apart is to be the arithmetic itself.
    EXPECT_TRUE(write_file(path / "shard.json", shard_text(part, options, kInFloat32)));
    return path;
  }

  TemporaryDirectory directory_;
  int directories_ = 0;
};

TEST_F(Float32Parts, MergeToTheBytesOfASingleRun) {
  const Comparison whole = run(options_for(true)).value();
  const auto merged = merge_shards({write({2, 3}, true), write({3, 3}, true), write({1, 3}, true)});
  ASSERT_TRUE(merged) << to_text(merged.error());
  EXPECT_EQ(comparison_csv(merged->comparison), comparison_csv(whole));
  EXPECT_EQ(in_double_csv(merged->comparison), in_double_csv(whole));
  EXPECT_EQ(comparison_text(merged->comparison, merged->options, merged->provenance),
            comparison_text(whole, options_for(true), kInFloat32));
}

TEST_F(Float32Parts, AreNotMixedWithPartsInDouble) {
  const auto merged = merge_shards({write({1, 2}, true), write({2, 2}, false)});
  ASSERT_FALSE(merged);
  EXPECT_THAT(to_text(merged.error()), HasSubstr("arithmetic"));
  EXPECT_THAT(to_text(merged.error()), HasSubstr("float32"));
}

TEST_F(Float32Parts, LackNoneOfTheirChecks) {
  const auto first = write({1, 2}, true);
  const auto second = write({2, 2}, true);
  CompareOptions options = options_for(true);
  options.shard = {2, 2};
  EXPECT_TRUE(is_finished_shard(second, options, kInFloat32));
  std::string csv = read_file(second / kInDoubleTable).value();
  csv[csv.find_last_of("0123456789")] ^= 1;
  ASSERT_TRUE(write_file(second / kInDoubleTable, csv));
  EXPECT_FALSE(is_finished_shard(second, options, kInFloat32));
  EXPECT_THAT(to_text(merge_shards({first, second}).error()), HasSubstr("in_double.csv"));
  std::filesystem::remove(second / kInDoubleTable);
  EXPECT_FALSE(is_finished_shard(second, options, kInFloat32));
  EXPECT_THAT(to_text(merge_shards({first, second}).error()), HasSubstr("in_double.csv"));
}

/// Rows of float32 and of double in one comparison: neither continues the other.
TEST_F(Float32Parts, IsNotResumedInDoubleNorDoubleInFloat32) {
  const auto written = [&](bool float32) {
    const CompareOptions options = options_for(float32, 2);
    const Comparison c = run(options).value();
    const auto path = directory_.path() / (float32 ? "float32" : "double");
    std::filesystem::create_directories(path);
    EXPECT_TRUE(write_file(path / "comparison.csv", comparison_csv(c)));
    EXPECT_TRUE(write_file(path / "comparison.json", comparison_text(c, options, kInFloat32)));
    return path;
  };
  const auto in_float32 = written(true);
  const auto in_double = written(false);
  const auto resumed = read_finished(in_float32, kInFloat32, StepFormat::kFloat32);
  ASSERT_TRUE(resumed) << to_text(resumed.error());
  EXPECT_TRUE(resumed->front().took_float32);
  EXPECT_THAT(to_text(read_finished(in_float32, kInFloat32).error()), HasSubstr("arithmetic"));
  EXPECT_THAT(to_text(read_finished(in_double, kInFloat32, StepFormat::kFloat32).error()),
              HasSubstr("arithmetic"));
}

/// A comparison that goes on from its first samples ends in the bytes of one that never stopped.
TEST(Float32, ResumedItEndsInTheSameBytes) {
  const Comparison whole = run(options_for(true)).value();
  CompareOptions options = options_for(true);
  options.finished = run(options_for(true, 10)).value().rows;
  const Comparison resumed = run(options).value();
  EXPECT_EQ(comparison_csv(resumed), comparison_csv(whole));
  EXPECT_EQ(in_double_csv(resumed), in_double_csv(whole));
}

}  // namespace
}  // namespace awmr::testing
