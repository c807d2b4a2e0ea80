/// Terms of a log fit that are requested by name.
#include "awmr/identify/logs/choice/further_terms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "identify/log_answers.h"

namespace awmr::testing {
namespace {

TEST(RequestedTerms, AreKnownByEveryNameOnce) {
  const std::vector<std::string> names = requestable_terms();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    const std::vector<FreeTerm> terms = requested_terms(std::vector<std::string>{name});
    ASSERT_EQ(terms.size(), 1U) << name;
    EXPECT_EQ(terms.front().quantity.name(), name);
  }
  for (const char* name : {"input_delay_s", "motor.time_constant_s", "delay.x_m", "lag.speed_mps",
                           "slip_ratio.yaw_rate_radps", "slope.y_mps2"}) {
    EXPECT_THAT(names, ::testing::Contains(name));
  }
  EXPECT_THAT(automatic_terms(), ::testing::Contains("surge.stribeck"));
}

IdentifyOptions with_terms(std::vector<std::string> terms) {
  IdentifyOptions options = power_law();
  options.terms = std::move(terms);
  return options;
}

TEST(RequestedTerms, AreEstimated) {
  TrialData data;
  data.logs = {drive_with_lag(kTruths[1], 8, 0.08)};
  const auto result = identify(robot(), data, with_terms({"motor.time_constant_s"}), {});
  ASSERT_TRUE(result);
  const auto lag = estimated(*result, "motor.time_constant_s");
  ASSERT_TRUE(lag && lag->std_error);
  EXPECT_NEAR(lag->value, 0.08, 4.5 * *lag->std_error);
  EXPECT_FALSE(result->has_refused_terms);
  EXPECT_TRUE(has_finding(*result, "actuator-lag", "motors"));
}

/// Severity of the finding `not-identifiable` of a term; empty without one.
std::optional<Severity> refusal_of(const Identification& result, const std::string& term) {
  for (const Finding& finding : result.model.record.findings) {
    if (finding.code == "not-identifiable" && finding.message.starts_with(term)) {
      return finding.severity;
    }
  }
  return std::nullopt;
}

TEST(RequestedTerms, ThatTheLogsDoNotShowAreRefused) {
  TrialData data;
  data.logs = {drive(kTruths[1], 8)};
  data.logs.front()[LogChannel::kSway].reset();
  const auto result = identify(robot(), data, with_terms({"sway.offset_m"}), {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->has_refused_terms);
  EXPECT_EQ(refusal_of(*result, "sway.offset_m"), Severity::kError);
}

TEST(RequestedTerms, NeedALog) {
  EXPECT_FALSE(identify(robot(), {}, with_terms({"input_delay_s"}), {}));
}

}  // namespace
}  // namespace awmr::testing
