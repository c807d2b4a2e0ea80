/// Files of a comparison; comparisons that are stopped; several sets of gains; seeded noise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/compare/comparison_directory.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/model/gains_file.h"
#include "support/process.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const std::vector<Scenario> kScenarios = {short_heading("a"),
                                          short_heading("=b, \"quoted\"\nline")};
const Provenance kComparedProvenance{
    "compare", {{"samples", "39"}, {"seed", "3"}}, {{"model.json", "abc"}}};

Comparison compared_scenarios(const CompareOptions& options,
                              const std::vector<NamedGains>& gains = {{"", kPaperGains}}) {
  const auto c = compare(uncertain_model(), gains, kScenarios, options);
  EXPECT_TRUE(c) << (c ? "" : to_text(c.error()));
  return c.value_or(Comparison{});
}

/// Comparison stopped after `runs` runs.
Comparison stopped_after(std::size_t runs) {
  std::atomic<bool> stop = false;
  CompareOptions options{.samples = 39, .seed = 3, .threads = 1};
  options.stop = &stop;
  options.progress = [&](std::size_t done, std::size_t) { stop = done >= runs; };
  return compared_scenarios(options);
}

const CompareOptions kWhole{.samples = 39, .seed = 3, .threads = 2};

TEST(StoppedComparison, IsASmallerOne) {
  // A sample has 6 runs, and runs are made in batches of 16 samples. The comparison is stopped with
  // 16 complete samples and two of the six batches of the next 16 samples.
  const Comparison c = stopped_after(16 * 6 + 20);
  EXPECT_TRUE(c.stopped);
  EXPECT_EQ(c.rows.size(), 128U);
  EXPECT_EQ(c.whole_samples, 16);
  const Json json = Json::parse(comparison_text(c, kWhole, kComparedProvenance));
  EXPECT_EQ(json["stopped"]["finished_runs"], 128);
  EXPECT_EQ(json["stopped"]["judged_samples"], 15);
  EXPECT_EQ(json["scenarios"][0]["modes"]["steering"]["completed"]["of"], 15);
}

TEST(StoppedComparison, HasNoStatisticsWithoutAWholeSample) {
  const Comparison c = stopped_after(2);
  EXPECT_EQ(c.whole_samples, 0);
  EXPECT_TRUE(Json::parse(comparison_text(c, kWhole, kComparedProvenance))["scenarios"].empty());
  EXPECT_EQ(comparison_table(c), "");
}

TEST(ComparisonCsv, ReadsBackItsRowsAndRefusesOthers) {
  const std::string csv =
      comparison_csv(compared_scenarios({.samples = 1, .seed = 3, .threads = 1}));
  EXPECT_EQ(comparison_rows(csv, "comparison.csv")->size(), 12U);
  const auto fault = [](const std::string& text) {
    return to_text(comparison_rows(text, "comparison.csv").error());
  };
  EXPECT_THAT(fault("scenario,mode\nbroken\n"),
              HasSubstr("comparison.csv:1:1: the file does not have the columns"));
  EXPECT_THAT(fault(csv.substr(0, csv.find('\n') + 1) + "broken\n"),
              HasSubstr("comparison.csv:2:1"));
}

TEST(ComparisonCsv, EscapesNamesThatASpreadsheetWouldRun) {
  const std::string csv =
      comparison_csv(compared_scenarios({.samples = 0, .seed = 3, .threads = 1}));
  EXPECT_THAT(csv, HasSubstr("\n\"'=b, \"\"quoted\"\"\nline\",differential,"));
}

TEST(SeveralGains, AreComparedWithEachOtherAndByMode) {
  Gains<double> slow = kPaperGains;
  slow.heading.mu = 10.0;
  const CompareOptions options{.samples = 4, .seed = 1, .threads = 2};
  const Comparison c =
      compared_scenarios(options, {{"paper.json", kPaperGains}, {"slow.json", slow}});
  EXPECT_EQ(c.rows.size(), 2U * 6U * 5U);
  EXPECT_THAT(comparison_csv(c), HasSubstr(",tyre_work,electric_work_j,gains\n"));
  const Json json = Json::parse(comparison_text(c, options, kComparedProvenance));
  const Json& scenario = json["scenarios"][0];
  EXPECT_EQ(scenario["modes"].size(), 6U);
  EXPECT_TRUE(scenario["modes"].contains("combined with slow.json"));
  // Paired differences: 3 pairs of modes for each set of gains, and one pair of sets for each mode.
  std::set<std::string> pairs;
  for (const Json& d : scenario["paired_differences"]) {
    pairs.insert(d["first"].get<std::string>() + d["second"].get<std::string>());
  }
  EXPECT_EQ(pairs.size(), 9U);
  // Gains with a tenth of mu/eps settle ten times as slowly: the paper's gains are first.
  EXPECT_THAT(scenario["ranking"][0]["mode"].get<std::string>(), HasSubstr("paper.json"));
}

TEST(Noise, IsTheSameForAllModesAndOtherInEverySample) {
  Scenario noisy = short_heading("noisy");
  noisy.speed_mps = 0.0;
  noisy.initial.u_mps = 0.0;
  noisy.guidance = OpenLoop{0.0, 0.0};
  noisy.disturbance.surge = {{.kind = DisturbanceTerm::Kind::kNoise,
                              .value = 0.5,
                              .window = {},
                              .frequency_hz = 0.0,
                              .phase_rad = {},
                              .bandwidth_hz = 1.0}};
  const auto c =
      compare(uncertain_model(), kPaperGains, {noisy}, {.samples = 2, .seed = 1, .threads = 1});
  ASSERT_TRUE(c);
  for (std::size_t sample = 0; sample < 3; ++sample) {
    // No turn is commanded, so the modes are equal.
    EXPECT_EQ(c->rows[sample].metrics.path_length_m, c->rows[3 + sample].metrics.path_length_m);
    EXPECT_EQ(c->rows[sample].metrics.path_length_m, c->rows[6 + sample].metrics.path_length_m);
  }
  EXPECT_NE(c->rows[1].metrics.path_length_m, c->rows[2].metrics.path_length_m);
}

}  // namespace
}  // namespace awmr::testing
