#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "awmr/core/json/json.h"
#include "awmr/model/gains_file.h"
#include "awmr/tune/tune_file.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

/// Test fixture with its own directory.
class TuneFile : public ::testing::Test {
 protected:
  TuneFile()
      : directory_(std::filesystem::path(::testing::TempDir()) /
                   (std::string("awmr_tune_") +
                    ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  ~TuneFile() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name) << text;
    return directory_ / name;
  }
  Result<TuneConfig> read(const std::string& text) const {
    return read_tune_config(write("tune.json", text));
  }
  std::string fault(const std::string& text) const {
    const Result<TuneConfig> config = read(text);
    return config ? "accepted" : to_text(config.error());
  }

  std::filesystem::path directory_;
};

TEST_F(TuneFile, ReadsAnObserver) {
  EXPECT_FALSE(read("{}")->options.observer);
  EXPECT_TRUE(read("{}")->options.adds_observer);
  EXPECT_FALSE(read(R"({"no_observer": true})")->options.adds_observer);
  EXPECT_FALSE(read("{}")->options.allows_unsettled);
  EXPECT_TRUE(read(R"({"allow_unsettled": true})")->options.allows_unsettled);
  EXPECT_EQ(read(R"({"observer": {}, "no_observer": true})").error().faults.front().code,
            ErrorCode::kConflict);
  const auto code = [&](const char* text, bool observer) {
    const Status status = check_observer_choice(observer, read(text)->options, "--observer");
    return status ? std::nullopt : std::optional(status.error().faults.front().code);
  };
  EXPECT_EQ(code(R"({"no_observer": true})", true), ErrorCode::kConflict);
  EXPECT_EQ(code(R"({"observer": {}})", false), ErrorCode::kConflict);
  EXPECT_EQ(code(R"({"no_observer": true})", false), std::nullopt);
  EXPECT_EQ(code(R"({"observer": {}})", true), std::nullopt);
  EXPECT_EQ(code("{}", true), std::nullopt);
  const auto plain = read(R"({"observer": {}})");
  ASSERT_TRUE(plain) << to_text(plain.error());
  EXPECT_EQ(plain->options.observer->bandwidth_radps.lo, ObserverSearch{}.bandwidth_radps.lo);
  EXPECT_FALSE(plain->options.observer->yaw_max_m);
  const auto given =
      read(R"({"observer": {"bandwidth_radps": [1, 4], "yaw_max_m": 0.02, "surge_max": 0.5}})");
  ASSERT_TRUE(given) << to_text(given.error());
  EXPECT_EQ(given->options.observer->bandwidth_radps.hi, 4.0);
  EXPECT_EQ(given->options.observer->yaw_max_m, 0.02);
  EXPECT_EQ(given->options.observer->surge_max, 0.5);
}

TEST_F(TuneFile, RefusesOneSetTogetherWithAMode) {
  EXPECT_TRUE(read(R"({"mode": "steering", "one_set": false})"));
  EXPECT_EQ(read(R"({"mode": "steering", "one_set": true})").error().faults.front().code,
            ErrorCode::kConflict);
  const auto code = [&](const char* text, std::optional<YawMode> mode, bool one_set) {
    const Status status = check_mode_choice(mode, one_set, read(text)->options);
    return status ? std::nullopt : std::optional(status.error().faults.front().code);
  };
  EXPECT_EQ(code(R"({"one_set": true})", YawMode::kSteering, false), ErrorCode::kConflict);
  EXPECT_EQ(code(R"({"mode": "steering"})", std::nullopt, true), ErrorCode::kConflict);
  EXPECT_EQ(code(R"({"one_set": true})", std::nullopt, true), std::nullopt);
  EXPECT_EQ(code(R"({"mode": "steering"})", YawMode::kCombined, false), std::nullopt);
  EXPECT_EQ(code("{}", YawMode::kSteering, false), std::nullopt);
}

TEST_F(TuneFile, RefusesDrawsTogetherWithNominal) {
  for (const char* more : {R"("draws": 16)", R"("judged_draws": 10)", R"("tail_share": 0.5)"}) {
    const auto config = read(std::string(R"({"nominal": true, )") + more + "}");
    ASSERT_FALSE(config) << more;
    EXPECT_EQ(config.error().faults.front().code, ErrorCode::kConflict) << more;
    EXPECT_TRUE(read(std::string(R"({"nominal": false, )") + more + "}")) << more;
  }
  const auto config = read(R"({"nominal": true, "draws": 0, "judged_draws": 0})");
  ASSERT_TRUE(config) << to_text(config.error());
  EXPECT_EQ(config->options.draws, 0);
}

TEST_F(TuneFile, ReadsGoals) {
  const auto config = read(
      R"({"goals": [{"at_most": {"settling_time_s": 2, "overshoot_deg": 1}, "share": 0.9},
                    {"at_most": {"control_variation": 3}, "mode": "steering", "soft": true}]})");
  ASSERT_TRUE(config) << to_text(config.error());
  const TuneOptions& options = config->options;
  ASSERT_EQ(options.goals.size(), 2U);
  EXPECT_EQ(options.goals[0].at_most.size(), 2U);
  EXPECT_EQ(options.goals[0].share, 0.9);
  EXPECT_FALSE(options.goals[0].mode);
  EXPECT_EQ(options.goals[1].at_most[0].figure, "control_variation");
  EXPECT_EQ(options.goals[1].at_most[0].most, 3.0);
  EXPECT_EQ(options.goals[1].mode, YawMode::kSteering);
  EXPECT_TRUE(options.goals[1].is_soft);
  EXPECT_EQ(options.evaluation_draws, kGoalDraws);
  EXPECT_EQ(read(R"({"goals": [{"at_most": {"overshoot_deg": 1}}], "judged_draws": 60})")
                ->options.evaluation_draws,
            60);
}

TEST_F(TuneFile, GivesTheDefaultsForAnEmptyObject) {
  const Result<TuneConfig> config = read("{}");
  ASSERT_TRUE(config) << to_text(config.error());
  EXPECT_EQ(config->options.form, ReachingForm::kStrict);
  EXPECT_EQ(config->options.margin, TuneOptions{}.margin);
  EXPECT_EQ(config->options.weights.itae, ObjectiveWeights{}.itae);
  EXPECT_EQ(config->options.global_evaluations, TuneOptions{}.global_evaluations);
  EXPECT_TRUE(config->options.scenarios.empty());
}

TEST_F(TuneFile, TakesEveryDocumentedKey) {
  write("turn.json",
        R"({"name": "turn", "duration_s": 5, "initial": {"x_m": 0, "y_m": 0, "psi_deg": 0,
            "u_mps": 0, "v_mps": 0, "r_degps": 0}, "speed_mps": 1,
            "guidance": {"type": "heading", "steps": [{"t_s": 0, "psi_deg": 20}]}})");
  const Result<TuneConfig> config = read(
      R"({"schema": "awmr.tune/1", "mode": "steering", "form": "paper", "margin": 0.5,
          "weights": {"itae": 2, "overshoot": 0, "control_variation": 1, "effort": 3,
                      "speed_itae": 4},
          "bounds": {"lambda": [1, 2], "mu": [3, 4], "epsilon": [5, 6], "speed_mu": [7, 8],
                     "speed_epsilon": [9, 10]},
          "draws": 14, "judged_draws": 15, "tail_share": 0.3,
          "activity_max": 1.7, "global_evaluations": 11, "local_evaluations": 12, "seed": 13,
          "scenarios": ["turn.json"]})");
  ASSERT_TRUE(config) << to_text(config.error());
  EXPECT_EQ(config->options.mode, YawMode::kSteering);
  EXPECT_EQ(config->options.form, ReachingForm::kPaper);
  EXPECT_EQ(config->options.margin, 0.5);
  EXPECT_EQ(config->options.weights.effort, 3.0);
  EXPECT_EQ(config->options.weights.speed_itae, 4.0);
  EXPECT_EQ(config->options.bounds.speed_epsilon->hi, 10.0);
  EXPECT_EQ(config->options.global_evaluations, 11);
  EXPECT_EQ(config->options.local_evaluations, 12);
  EXPECT_EQ(config->options.seed, 13U);
  EXPECT_FALSE(config->options.nominal);
  EXPECT_EQ(config->options.draws, 14);
  EXPECT_EQ(config->options.evaluation_draws, 15);
  EXPECT_EQ(config->options.tail_share, 0.3);
  EXPECT_EQ(config->options.activity_max, 1.7);
  ASSERT_EQ(config->options.scenarios.size(), 1U);
  EXPECT_EQ(config->options.scenarios.front().name, "turn");
  ASSERT_EQ(config->scenario_files.size(), 1U);
  EXPECT_EQ(config->scenario_files.front(), directory_ / "turn.json");
}

TEST_F(TuneFile, IgnoresTheSensitivityOfOlderFiles) {
  EXPECT_TRUE(read(R"({"sensitivity": 64})"));
  EXPECT_TRUE(read_gains(
      write("gains.json", R"({"schema": "awmr.gains/1", "heading": {"lambda": 3, "mu": 50,
                              "epsilon": 12}, "speed": {"mu": 5, "epsilon": 1.2},
                              "sensitivity": {"samples": 64, "figures": []}})")));
}

TEST_F(TuneFile, ReadsLimits) {
  const TuningLimits defaults;
  EXPECT_FALSE(read("{}")->options.limits.steering_rate_rms_degps);
  const auto one = read(R"({"limits": {"damping": 0.8}})");
  ASSERT_TRUE(one) << to_text(one.error());
  EXPECT_EQ(one->options.limits.damping, 0.8);
  EXPECT_EQ(one->options.limits.late_damping, defaults.late_damping);
  const auto all = read(
      R"({"limits": {"steering_rate_rms_degps": 120, "damping": 1, "late_damping": 0.3,
                     "delayed_damping": 0.1, "noise_share": 0.5}})");
  ASSERT_TRUE(all) << to_text(all.error());
  EXPECT_EQ(all->options.limits.steering_rate_rms_degps, 120.0);
  EXPECT_EQ(all->options.limits.damping, 1.0);
  EXPECT_EQ(all->options.limits.late_damping, 0.3);
  EXPECT_EQ(all->options.limits.delayed_damping, 0.1);
  EXPECT_EQ(all->options.limits.noise_share, 0.5);
}

TEST_F(TuneFile, RefusesLimitsOutOfRange) {
  for (const char* text :
       {R"({"limits": {"damping": 0}})", R"({"limits": {"damping": 1.01}})",
        R"({"limits": {"late_damping": -0.1}})", R"({"limits": {"delayed_damping": "0.1"}})",
        R"({"limits": {"noise_share": 1.5}})", R"({"limits": {"steering_rate_rms_degps": 0}})",
        R"({"limits": {"steering_rate_rms_degps": null}})", R"({"limits": {"dampng": 0.7}})",
        R"({"limits": []})"}) {
    const Result<TuneConfig> config = read(text);
    ASSERT_FALSE(config) << text;
    EXPECT_EQ(config.error().kind, ErrorKind::kInput) << text;
  }
}

TEST_F(TuneFile, NamesAnUnknownKeyAndItsNearest) {
  EXPECT_THAT(fault(R"({"margn": 0.5})"), HasSubstr("margin"));
  EXPECT_THAT(fault(R"({"weights": {"overshot": 1}})"), HasSubstr("overshoot"));
  EXPECT_THAT(fault(R"({"bounds": {"lamda": [1, 2]}})"), HasSubstr("lambda"));
}

TEST_F(TuneFile, RefusesValuesOutOfRange) {
  for (const char* text :
       {R"({"margin": 0})",
        R"({"margin": 1})",
        R"({"margin": "0.5"})",
        R"({"form": "strickt"})",
        R"({"mode": "sideways"})",
        R"({"mode": null})",
        R"({"global_evaluations": 0})",
        R"({"local_evaluations": -1})",
        R"({"nominal": 1})",
        R"({"draws": -1})",
        R"({"draws": 1001})",
        R"({"judged_draws": 1e9})",
        R"({"tail_share": 0})",
        R"({"tail_share": 1.1})",
        R"({"activity_max": 0})",
        R"({"global_evaluations": 2.5})",
        R"({"seed": -1})",
        R"({"weights": {"itae": -1}})",
        R"({"weights": {"settling": 0, "itae": 0, "overshoot": 0, "control_variation": 0,
            "effort": 0, "speed_itae": 0}})",
        R"({"bounds": {"mu": [0, 1]}})",
        R"({"bounds": {"mu": [2, 1]}})",
        R"({"bounds": {"mu": 3}})",
        R"({"schema": "awmr.gains/1"})",
        R"({"scenarios": []})",
        R"({"scenarios": ["absent.json"]})",
        R"([])",
        "{",
        ""}) {
    const Result<TuneConfig> config = read(text);
    ASSERT_FALSE(config) << text;
    EXPECT_EQ(config.error().kind, ErrorKind::kInput) << text;
  }
}

TEST_F(TuneFile, ReportsEveryFaultAtOnce) {
  const Result<TuneConfig> config =
      read(R"({"margin": 2, "seed": -1, "unknown": 1, "scenarios": ["absent.json"]})");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().faults.size(), 4U) << to_text(config.error());
}

TEST_F(TuneFile, ReportsAnInvalidElementOfAListOnce) {
  for (const char* text : {R"({"open": {"mass_factors": [0]}})", R"({"open": {"mass_factors": 3}})",
                           R"({"open": {"wheel_forces": 3}})", R"({"scenarios": [3]})",
                           R"({"goals": [{"at_most": {"overshoot_deg": 0}}]})",
                           R"({"goals": [{"at_most": {"settling_s": 1}}]})"}) {
    const auto config = read(text);
    ASSERT_FALSE(config) << text;
    EXPECT_EQ(config.error().faults.size(), 1U) << text << to_text(config.error());
    EXPECT_NE(config.error().faults.front().code, ErrorCode::kMissing) << text;
  }
  EXPECT_EQ(read(R"({"open": {"mass_factors": []}})").error().faults.front().code,
            ErrorCode::kMissing);
}

TEST_F(TuneFile, WritesGainsThatReadBackBitForBit) {
  Tuning tuning;
  tuning.gains = {{3.1, 50.0 / 3.0, 0.1 + 0.2}, {1.0 / 7.0, 1e-3}};
  tuning.baseline = {kPaperGains, kPaperSource};
  tuning.scores = {{.scenario = "a", .mode = YawMode::kSteering, .objective = 0.9}};
  tuning.constraints = {{.name = "T2 < T1 (strict)", .value = 1.0, .limit = 2.0, .margin = 1.0}};
  const std::string text =
      gains_text(tuning, {}, {.command = "tune", .options = {{"seed", "1"}}, .inputs = {}});
  const Result<Gains<double>> gains = read_gains(write("gains.json", text));
  ASSERT_TRUE(gains) << to_text(gains.error());
  EXPECT_EQ(gains->heading.lambda, tuning.gains.heading.lambda);
  EXPECT_EQ(gains->heading.mu, tuning.gains.heading.mu);
  EXPECT_EQ(gains->heading.epsilon, tuning.gains.heading.epsilon);
  EXPECT_EQ(gains->speed.mu, tuning.gains.speed.mu);
  EXPECT_EQ(gains->speed.epsilon, tuning.gains.speed.epsilon);
}

TEST_F(TuneFile, WritesTheContractsKeys) {
  Tuning tuning;
  tuning.history = {.best = {{3, 0.9}, {7, 0.8}}, .global_evaluations = 5, .evaluations = 9};
  tuning.gains = kPaperGains;
  tuning.scores = {{.scenario = "a", .mode = YawMode::kSteering, .objective = 0.9}};
  const Json json =
      Json::parse(gains_text(tuning, {}, {.command = "tune", .options = {}, .inputs = {}}));
  EXPECT_EQ(json.at("schema"), "awmr.gains/1");
  EXPECT_EQ(json.at("heading").at("mu"), 50.0);
  EXPECT_EQ(json.at("time_constants").at("T1_s"), 1.0 / 3.0);
  EXPECT_EQ(json.at("time_constants").at("T2_s"), 0.12);
  EXPECT_EQ(json.at("metrics").at("steering").at("a").at("objective"), 0.9);
  const Json& history = json.at("search").at("history");
  EXPECT_EQ(history.at("global_evaluations"), 5);
  EXPECT_EQ(history.at("best").at(1), Json({{"evaluation", 7}, {"objective", 0.8}}));
  // A metric that is undefined in a run is written as null, not as 0.
  EXPECT_TRUE(json.at("metrics").at("steering").at("a").at("overshoot_deg").is_null());
  for (const char* key : {"constraints", "objective", "search", "baseline", "version"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

}  // namespace
}  // namespace awmr::testing
