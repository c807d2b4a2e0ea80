#include "awmr/compare/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "awmr/compare/compare_findings.h"
#include "awmr/core/json/json.h"
#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/simulate.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const Provenance kProvenance{"compare", {{"samples", "4"}}, {{"model.json", "abc"}}};

Comparison compared(const CompareOptions& options,
                    std::vector<Scenario> scenarios = {short_heading()}) {
  const auto c = compare(uncertain_model(), kPaperGains, scenarios, options);
  EXPECT_TRUE(c) << (c ? "" : to_text(c.error()));
  return c.value_or(Comparison{});
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

TEST(Compare, UsesTheGainsOfEachMode) {
  const Gains<double> slow{{1.5, 20.0, 8.0}, {2.0, 1.0}};
  ModeGains by_mode(kPaperGains);
  by_mode.set(YawMode::kSteering, slow);
  const auto rows = [](const ModeGains& gains) {
    return compare(uncertain_model(), gains, {short_heading()}, {.samples = 2, .seed = 11})->rows;
  };
  const auto own = rows(by_mode), common = rows(kPaperGains), all_slow = rows(slow);
  ASSERT_EQ(own.size(), common.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto& expected = own[i].mode == YawMode::kSteering ? all_slow[i] : common[i];
    EXPECT_EQ(own[i].metrics.heading_iae_degs, expected.metrics.heading_iae_degs);
  }
  EXPECT_NE(all_slow[3].metrics.heading_iae_degs, common[3].metrics.heading_iae_degs);
}

TEST(Compare, TheSameBytesWhateverTheNumberOfThreads) {
  const std::vector<Scenario> scenarios = {short_heading(), short_open_loop()};
  const CompareOptions one{.samples = 4, .seed = 11, .threads = 1};
  const Comparison reference = compared(one, scenarios);
  for (const int threads : {0, 2, 7, 64}) {
    CompareOptions options = one;
    options.threads = threads;
    const Comparison other = compared(options, scenarios);
    EXPECT_EQ(comparison_csv(reference), comparison_csv(other)) << threads;
    EXPECT_EQ(comparison_text(reference, one, kProvenance),
              comparison_text(other, options, kProvenance))
        << threads;
  }
}

TEST(Compare, RowsGoByScenarioModeAndSample) {
  const Comparison c =
      compared({.samples = 2, .seed = 1, .threads = 2}, {short_heading("a"), short_heading("b")});
  ASSERT_EQ(c.rows.size(), 2U * 3U * 3U);
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    EXPECT_EQ(c.rows[i].scenario, i < 9 ? "a" : "b");
    EXPECT_EQ(c.rows[i].mode, kYawModes[(i / 3) % 3]);
    EXPECT_EQ(c.rows[i].sample, static_cast<int>(i % 3));
  }
}

TEST(Compare, SampleZeroIsTheModelItself) {
  const Model model = uncertain_model();
  const Comparison c = compared({.samples = 3, .seed = 1, .threads = 1});
  const Comparison nominal = compared({.samples = 0, .seed = 99, .threads = 1});
  const Plant<double> plant = *model.plant();
  const Controller<double> controller = make_controller(plant, model.vehicle, kPaperGains);
  for (std::size_t i = 0; i < 3; ++i) {
    const Scenario scenario = short_heading();
    const Metrics direct =
        metrics_of(simulate(plant, controller, scenario, kYawModes[i],
                            {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}}),
                   scenario, controller);
    // Batches round differently from simulate(), by about 1e-13 (tests/simulate/batch_test.cpp).
    const double expected = *direct.heading_iae_degs;
    EXPECT_NEAR(*c.rows[4 * i].metrics.heading_iae_degs, expected, 1e-9 * expected);
    EXPECT_EQ(nominal.rows[i].metrics.heading_iae_degs, c.rows[4 * i].metrics.heading_iae_degs);
  }
}

TEST(Compare, NoiseOfSampleZeroDoesNotDependOnTheSeed) {
  Scenario noisy = short_heading();
  noisy.sensors.emplace();
  noisy.sensors->heading.noise = radians(1.0);
  const Comparison one = compared({.samples = 1, .seed = 1, .threads = 1}, {noisy});
  const Comparison two = compared({.samples = 1, .seed = 2, .threads = 1}, {noisy});
  EXPECT_EQ(one.rows[0].metrics.heading_iae_degs, two.rows[0].metrics.heading_iae_degs);
  EXPECT_NE(one.rows[1].metrics.heading_iae_degs, two.rows[1].metrics.heading_iae_degs);
}

TEST(Compare, SimulatesTheSensorsAndMotorsOfTheVehicle) {
  Model model = uncertain_model();
  model.vehicle.sensors = {.heading_deg = 2.0, .yaw_rate_latency_s = 0.03};
  model.vehicle.motor_time_constant_s = 0.05;
  Scenario given = short_heading();
  given.sensors.emplace();
  given.sensors->heading.noise = radians(2.0);
  given.sensors->yaw_rate.latency_s = 0.03;
  given.actuators.emplace().motor_time_constant_s = 0.05;
  Scenario exact = short_heading();
  exact.sensors.emplace();
  exact.actuators.emplace();
  const CompareOptions options{.samples = 1, .seed = 1, .threads = 1};
  const auto iae_of = [&](const Model& of, const Scenario& scenario) {
    std::vector<double> iae;
    const Comparison comparison = compare(of, kPaperGains, {scenario}, options).value();
    for (const ComparisonRow& row : comparison.rows) {
      iae.push_back(row.metrics.heading_iae_degs.value());
    }
    return iae;
  };
  const Model plain = uncertain_model();
  EXPECT_EQ(iae_of(model, short_heading()), iae_of(plain, given));
  // The sensors and actuators of a scenario replace those of the vehicle.
  EXPECT_EQ(iae_of(model, exact), iae_of(plain, short_heading()));
  EXPECT_NE(iae_of(model, short_heading()), iae_of(plain, short_heading()));
  // simulate() drives the vehicle in the same way.
  const auto run = simulate(model, kPaperGains, short_heading(), YawMode::kCombined).value();
  const auto same = simulate(plain, kPaperGains, given, YawMode::kCombined).value();
  EXPECT_EQ(run.rows.back().state.psi_rad, same.rows.back().state.psi_rad);
  EXPECT_EQ(run.rows.back().measured.psi_rad, same.rows.back().measured.psi_rad);
}

TEST(Compare, ReportsAModeThatCompletesNoRunUnderAChange) {
  const auto row = [](YawMode mode, bool completed) {
    ComparisonRow one{.scenario = "path", .mode = mode, .metrics = {}};
    one.metrics.completed = completed;
    return one;
  };
  Comparison comparison{.rows = {row(YawMode::kDifferential, true), row(YawMode::kSteering, false),
                                 row(YawMode::kCombined, true)}};
  const auto change = [](ChangeKind kind, const char* setting) {
    return Change{.scenario = "path",
                  .kind = kind,
                  .setting = setting,
                  .first = {},
                  .completed = {{{YawMode::kDifferential, ""}, 0, 1},
                                {{YawMode::kSteering, ""}, 0, 1},
                                {{YawMode::kCombined, ""}, 1, 1}}};
  };
  EXPECT_TRUE(completion_findings(comparison).empty());
  comparison.changes = {change(ChangeKind::kPlant, "four-wheel"),
                        change(ChangeKind::kGains, "faster")};
  const std::vector<Finding> findings = completion_findings(comparison);
  ASSERT_EQ(findings.size(), 2U);
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.code, "incomplete-if-changed");
    EXPECT_EQ(finding.severity, Severity::kWarning);
    // Steering completes no run without the change either.
    EXPECT_THAT(finding.message, HasSubstr("0 of 1 runs are completed by differential, so"));
  }
  EXPECT_THAT(findings.front().message, HasSubstr("path: on the four-wheel plant, "));
}

TEST(Compare, ASampleIsTheSameVehicleInEveryScenarioAndMode) {
  // In open loop straight ahead all modes give the same motion, so equal results show that the
  // sampled vehicles are the same.
  Scenario straight = short_open_loop();
  straight.guidance = OpenLoop{2.0, 0.0};
  Scenario again = straight;
  again.name = "again";
  const Comparison c = compared({.samples = 3, .seed = 5, .threads = 2}, {straight, again});
  for (std::size_t sample = 0; sample < 4; ++sample) {
    for (std::size_t other = 1; other < 6; ++other) {
      // Tolerance: the formulas of the modes for F' round differently, by a few 1e-16 in each of
      // about 100 steps of a path of 1 m.
      EXPECT_NEAR(c.rows[sample].metrics.path_length_m,
                  c.rows[4 * other + sample].metrics.path_length_m, 1e-12);
    }
  }
  EXPECT_NE(c.rows[1].metrics.path_length_m, c.rows[2].metrics.path_length_m);
}

TEST(Compare, MoreSamplesKeepTheFirstOnes) {
  const Comparison few = compared({.samples = 2, .seed = 1, .threads = 2});
  const Comparison more = compared({.samples = 5, .seed = 1, .threads = 2});
  for (std::size_t mode = 0; mode < 3; ++mode) {
    for (std::size_t sample = 0; sample <= 2; ++sample) {
      EXPECT_EQ(few.rows[3 * mode + sample].metrics.heading_iae_degs,
                more.rows[6 * mode + sample].metrics.heading_iae_degs);
    }
  }
}

TEST(Compare, RefusesBadOptionsAllAtOnce) {
  const auto c =
      compare(uncertain_model(), kPaperGains, {}, {.samples = -1, .seed = 1, .threads = -1});
  ASSERT_FALSE(c);
  EXPECT_EQ(c.error().kind, ErrorKind::kInput);
  EXPECT_EQ(c.error().faults.size(), 3U);
}

/// Entries of comparison.json by scenario name.
std::map<std::string, Json> by_scenario(const Comparison& comparison,
                                        const CompareOptions& options) {
  std::map<std::string, Json> all;
  const Json json = Json::parse(comparison_text(comparison, options, kProvenance));
  for (const Json& one : json["scenarios"]) all[one["name"].get<std::string>()] = one;
  return all;
}

TEST(Compare, NothingDependsOnTheOrderOfScenarios) {
  const CompareOptions options{.samples = 6, .seed = 3};
  Scenario faster = short_heading();
  faster.name = "faster";
  faster.speed_mps *= 1.5;
  const std::vector<Scenario> scenarios{short_heading(), faster, short_open_loop()};
  const auto reference = by_scenario(compared(options, scenarios), options);
  ASSERT_EQ(reference.size(), 3U);
  const auto turned =
      by_scenario(compared(options, {scenarios[2], scenarios[1], scenarios[0]}), options);
  EXPECT_EQ(reference, turned);
  for (const Scenario& scenario : scenarios) {
    EXPECT_EQ(by_scenario(compared(options, {scenario}), options).at(scenario.name),
              reference.at(scenario.name));
  }
}

TEST(Compare, RankingDoesNotDependOnTheOrderOfGains) {
  const CompareOptions options{.samples = 6, .seed = 3};
  Gains<double> faster = kPaperGains;
  faster.heading.lambda *= 1.5;
  // The second and third sets of gains are equal except for their names.
  std::vector<NamedGains> gains{{"a.json", kPaperGains}, {"c.json", faster}, {"b.json", faster}};
  const auto ranking = [&] {
    const auto c = compare(uncertain_model(), gains, {short_heading()}, options);
    EXPECT_TRUE(c);
    return Json::parse(comparison_text(*c, options, kProvenance))["scenarios"][0]["ranking"];
  };
  const Json reference = ranking();
  ASSERT_EQ(reference.size(), 9U);
  std::reverse(gains.begin(), gains.end());
  EXPECT_EQ(ranking(), reference);
}

TEST(Compare, ChecksTheControllerOfEveryScenario) {
  Scenario observed = short_heading();
  observed.name = "observed";
  observed.control.observer =
      ObserverGains<double>{.bandwidth_radps = 2.0 / uncertain_model().vehicle.sample_time_s,
                            .yaw_max_m = 0.04,
                            .surge_max = 1.0};
  Scenario unstable = short_heading();
  unstable.name = "unstable";
  unstable.control.lqi = LqiWeights<double>{
      .heading_rad = 1e-6, .yaw_rate_radps = 1e-6, .integral_rad_s = 1e-6, .tau_turn_m = 1e6};
  Scenario endless = short_heading();
  endless.name = "endless";
  endless.duration_s = 1e6;
  for (const Scenario& bad : {observed, unstable, endless}) {
    for (const int samples : {0, 2}) {
      std::vector<Scenario> scenarios{short_heading(), short_open_loop(), bad};
      for (int turn = 0; turn < 3; ++turn) {
        std::rotate(scenarios.begin(), scenarios.begin() + 1, scenarios.end());
        const auto refused =
            compare(uncertain_model(), kPaperGains, scenarios, {.samples = samples});
        ASSERT_FALSE(refused) << bad.name << " " << turn;
        EXPECT_EQ(exit_code(refused.error()), 2);
        EXPECT_THAT(to_text(refused.error()), HasSubstr("scenario '" + bad.name + "'"));
      }
    }
  }
}

TEST(Compare, RefusesMoreRunsThanMemoryHolds) {
  const auto refused =
      compare(uncertain_model(), kPaperGains, {short_heading()}, {.samples = 1'000'000});
  ASSERT_FALSE(refused);
  EXPECT_EQ(exit_code(refused.error()), 2);
  EXPECT_THAT(to_text(refused.error()), HasSubstr("give at most 333332 samples"));
}

TEST(Compare, RefusesTwoScenariosOfOneName) {
  const auto c =
      compare(uncertain_model(), kPaperGains, {short_heading("a"), short_heading("a")}, {});
  ASSERT_FALSE(c);
  EXPECT_THAT(to_text(c.error()), HasSubstr("two scenarios are named 'a'"));
}

TEST(Compare, NamesTheMissingParameter) {
  Model model = uncertain_model();
  model[ParameterId::kInertiaNorm].value.reset();
  for (const int samples : {0, 2}) {
    const auto c = compare(model, kPaperGains, {short_heading()},
                           {.samples = samples, .seed = 1, .threads = 1});
    ASSERT_FALSE(c);
    EXPECT_EQ(c.error().kind, ErrorKind::kInput);
    EXPECT_THAT(to_text(c.error()), HasSubstr("model.json:/inertia_norm"));
  }
}

TEST(Compare, NeedsACovarianceOnlyForSamples) {
  const Model model = fitted_paper_model();
  const auto run = [&](int samples) {
    return compare(model, kPaperGains, {short_heading()},
                   {.samples = samples, .seed = 1, .threads = 1});
  };
  EXPECT_TRUE(run(0));
  ASSERT_FALSE(run(1));
  EXPECT_THAT(to_text(run(1).error()), HasSubstr("model.json:/covariance"));
}

TEST(ComparisonCsv, HasTheContractsColumns) {
  const auto lines = lines_of(comparison_csv(compared({.samples = 1, .seed = 1, .threads = 1})));
  ASSERT_EQ(lines.size(), 1U + 3U * 2U);
  EXPECT_EQ(lines[0],
            "scenario,mode,sample,completed,settling_time_s,overshoot_deg,heading_iae_degs,"
            "cross_track_rms_m,path_length_m,speed_drop_mps,sideslip_max_deg,yaw_rate_max_degps,"
            "control_variation,clearance_min_m,finish_time_s,energy_mech,energy_electric,"
            "saturation_s,steering_travel_deg,tyre_work,electric_work_j");
  for (const std::string& line : lines) EXPECT_EQ(cells_of(line).size(), 21U);
  const auto first = cells_of(lines[1]);
  EXPECT_EQ(first[0], "step");
  EXPECT_EQ(first[1], "differential");
  EXPECT_EQ(first[2], "0");
  EXPECT_EQ(first[3], "1");
  EXPECT_EQ(first[7], "");   // no line for a cross-track error
  EXPECT_EQ(first[13], "");  // empty, because there is no obstacle
}

TEST(ComparisonCsv, LeavesHeadingMetricsEmptyInOpenLoop) {
  const auto lines = lines_of(
      comparison_csv(compared({.samples = 0, .seed = 1, .threads = 1}, {short_open_loop()})));
  const auto cells = cells_of(lines.at(1));
  for (const std::size_t empty : {4U, 5U, 6U, 7U, 9U}) EXPECT_EQ(cells[empty], "") << empty;
  EXPECT_NE(cells[8], "");
}

TEST(ComparisonCsv, QuotesNamesThatNeedIt) {
  const auto lines = lines_of(comparison_csv(
      compared({.samples = 0, .seed = 1, .threads = 1}, {short_heading("turn, \"fast\"")})));
  EXPECT_EQ(lines.at(1).rfind("\"turn, \"\"fast\"\"\",differential,0,1,", 0), 0U) << lines[1];
}

TEST(ComparisonJson, WithoutSamplesSaysWhyThereAreNoIntervals) {
  const CompareOptions options{.samples = 0, .seed = 1, .threads = 1};
  const Json json = Json::parse(comparison_text(compared(options), options, kProvenance));
  EXPECT_EQ(json["schema"], "awmr.comparison/1");
  EXPECT_EQ(json["command"], "compare");
  EXPECT_EQ(json["inputs"].size(), 1U);
  EXPECT_THAT(json["statistics"]["ci95"].get<std::string>(), HasSubstr("at least 2 samples"));
  const Json& scenario = json["scenarios"][0];
  const Json& iae = scenario["modes"]["steering"]["metrics"]["heading_iae_degs"];
  EXPECT_EQ(iae["mean"], iae["nominal"]);
  EXPECT_TRUE(iae["q05"].is_null());
  for (const Json& d : scenario["paired_differences"]) EXPECT_TRUE(d["ci95"].is_null());
  EXPECT_EQ(scenario["ranking"].size(), 3U);
  EXPECT_TRUE(json["statistics"]["resamples"].is_null());
  EXPECT_THAT(json["statistics"]["quantiles"].get<std::string>(), HasSubstr("at least 2 samples"));
}

TEST(ComparisonJson, FromTwoSamplesOnSaysHowItsIntervalsAreMade) {
  const CompareOptions options{.samples = 2, .seed = 1, .threads = 1};
  const Json json = Json::parse(comparison_text(compared(options), options, kProvenance));
  const Json& how = json["statistics"];
  EXPECT_TRUE(how["resamples"].is_number());
  for (const char* key : {"ci95", "conclusion", "completed_ci95", "quantiles"}) {
    EXPECT_THAT(how[key].get<std::string>(), ::testing::Not(HasSubstr("at least 2"))) << key;
  }
  EXPECT_THAT(how["quantiles"].get<std::string>(), HasSubstr("5, 50 and 95 %"));
}

TEST(ComparisonJson, ScenariosWithTheSameRunsAreCountedOnce) {
  const CompareOptions options{.samples = 0, .seed = 1, .threads = 1};
  Scenario other = short_heading("other");
  other.speed_mps *= 0.5;
  const Comparison c = compared(options, {short_heading("one"), other, short_heading("again")});
  const std::string table = comparison_table(c, options);
  EXPECT_THAT(table, HasSubstr("counted once: 'again' has the same runs as 'one'"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("as 'other'")));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("as 'again'")));
  const std::string text = comparison_text(c, options, kProvenance);
  EXPECT_THAT(text, HasSubstr("\"same_runs_as\": \"one\""));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("\"same_runs_as\": \"other\"")));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("\"same_runs_as\": \"again\"")));
}

TEST(ComparisonJson, WithSamplesHasIntervalsAroundTheMeans) {
  const CompareOptions options{.samples = 6, .seed = 1, .threads = 2};
  const Json json = Json::parse(comparison_text(compared(options), options, kProvenance));
  const Json& scenario = json["scenarios"][0];
  int seen = 0;
  for (const Json& d : scenario["paired_differences"]) {
    if (d["metric"] != "heading_iae_degs") continue;
    ++seen;
    ASSERT_TRUE(d["ci95"].is_array());
    EXPECT_LE(d["ci95"][0].get<double>(), d["mean"].get<double>());
    EXPECT_GE(d["ci95"][1].get<double>(), d["mean"].get<double>());
  }
  EXPECT_EQ(seen, 3);
  const Json& iae = scenario["modes"]["differential"]["metrics"]["heading_iae_degs"];
  EXPECT_EQ(iae["count"], 6);
  EXPECT_LE(iae["q05"].get<double>(), iae["q95"].get<double>());
}

TEST(ComparisonJson, RanksNoOpenLoopScenario) {
  const CompareOptions options{.samples = 0, .seed = 1, .threads = 1};
  const Json json =
      Json::parse(comparison_text(compared(options, {short_open_loop()}), options, kProvenance));
  EXPECT_TRUE(json["scenarios"][0]["ranking"].empty());
  EXPECT_TRUE(json["scenarios"][0]["ranking_note"].is_string());
}

TEST(ComparisonTable, HasUnitsAndAlignedRows) {
  const std::string table = comparison_table(compared({.samples = 0, .seed = 1, .threads = 1}));
  const auto lines = lines_of(table);
  ASSERT_GT(lines.size(), 6U);
  EXPECT_THAT(lines[0], HasSubstr("step"));
  EXPECT_THAT(lines[2], HasSubstr("deg/s"));
  EXPECT_THAT(lines[1], ::testing::Not(HasSubstr("x-track")));  // no line for a cross-track error
  EXPECT_EQ(lines[3].size(), lines[1].size());
  EXPECT_EQ(lines[4].size(), lines[5].size());
  EXPECT_THAT(lines[6], HasSubstr("tie"));  // the verdict
  for (const std::string& line : lines) EXPECT_LE(line.size(), 100U);
  for (std::size_t i = 6; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].find_first_not_of(' '), 2U) << lines[i];
  }
  EXPECT_THAT(lines[0], HasSubstr("the model's own values"));
  EXPECT_THAT(comparison_table(compared({.samples = 2, .seed = 1, .threads = 1})),
              HasSubstr("mean of 2 sample(s)"));
}

}  // namespace
}  // namespace awmr::testing
