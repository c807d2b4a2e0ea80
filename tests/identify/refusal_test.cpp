/// Data that do not determine a parameter: identify refuses it by name.
#include <gmock/gmock.h>

#include <algorithm>

#include "identify/synthetic.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

bool has_finding(const Model& model, const std::string& code) {
  return std::any_of(model.record.findings.begin(), model.record.findings.end(),
                     [&](const Finding& f) { return f.code == code; });
}

TEST(Refusal, EverySubsetOfTrialsIsRecoveredOrRefused) {
  const Truth& truth = kTruths[0];
  const TrialData all = synthetic(truth, 0.0, 1);
  for (int subset = 1; subset < 8; ++subset) {
    TrialData data;
    if (subset & 1) data.surge = all.surge;
    if (subset & 2) data.turning = all.turning;
    if (subset & 4) data.coastdown = all.coastdown;
    const auto result = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(result);
    const Model& m = result->model;
    EXPECT_EQ(m[ParameterId::kSurgeBeta].value.has_value(), data.surge.has_value());
    EXPECT_EQ(m[ParameterId::kYawBeta].value.has_value(), data.turning.has_value());
    const bool mass = data.surge && data.coastdown;
    EXPECT_EQ(m[ParameterId::kMassNorm].value.has_value(), mass);
    if (mass) {
      EXPECT_NEAR(*m[ParameterId::kMassNorm].value, truth.mass_norm, 1e-11);
    }
    // A coast-down without a surge trial cannot give m', which was requested, nor I'z, which
    // follows from m'.
    if (data.coastdown && !data.surge) {
      EXPECT_THAT(result->refused, ElementsAre(ParameterId::kMassNorm, ParameterId::kInertiaNorm));
    } else {
      EXPECT_THAT(result->refused, IsEmpty());
    }
  }
}

TEST(Refusal, EqualForcesShowNoExponent) {
  TrialData data = synthetic(kTruths[0], 0.0, 1);
  data.turning.reset();
  data.coastdown.reset();
  for (SurgeRow& row : data.surge->rows) row.tau_speed = 1.0;
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->refused, ElementsAre(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta));
  EXPECT_TRUE(has_finding(result->model, "not-identifiable"));
}

TEST(Refusal, TwoRowsGiveValuesWithoutAnError) {
  TrialData data = synthetic(kTruths[0], 0.0, 1);
  data.turning.reset();
  data.coastdown.reset();
  data.surge->rows.resize(2);
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_NEAR(*result->model[ParameterId::kSurgeBeta].value, kTruths[0].b1, 1e-12);
  EXPECT_FALSE(result->model[ParameterId::kSurgeBeta].std_error);
  EXPECT_TRUE(has_finding(result->model, "no-degrees-of-freedom"));
}

/// With three surge rows, the interval of b1 is -1 to 2.8, and that of m' spans sixteen orders of
/// magnitude.
TEST(Refusal, RefusesAMassUncertainByOrdersOfMagnitude) {
  TrialData data = synthetic(kTruths[0], 0.0, 1);
  data.surge->rows = {
      {2, 0.2, 0.095663, {}, {}}, {3, 1.2, 1.0453, {}, {}}, {4, 1.6, 1.3539, {}, {}}};
  data.coastdown->rows = {{2, 1.5307, 0.66077}, {3, 1.3973, 0.78886}, {4, 1.1912, 0.63442}};
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->refused, ElementsAre(ParameterId::kMassNorm, ParameterId::kInertiaNorm));
  EXPECT_TRUE(result->model[ParameterId::kSurgeAlpha].value);
  EXPECT_TRUE(has_finding(result->model, "not-identifiable"));
}

TEST(Refusal, RefusesAStopTimeForAnExponentOfOneOrMore) {
  TrialData data = synthetic({1.0, 1.3, 0.3, 0.8, 0.1}, 0.0, 1);
  data.coastdown->rows = {{2, 1.0, 0.5}};
  for (const double most : {1.0, 2.5}) {
    Vehicle bounded = vehicle();
    bounded.surge_beta_range.hi = most;
    const auto result = identify(bounded, data, {}, {});
    ASSERT_TRUE(result);
    EXPECT_THAT(result->refused, ElementsAre(ParameterId::kMassNorm, ParameterId::kInertiaNorm));
    EXPECT_EQ(has_finding(result->model, "exponent-at-bound"), most == 1.0);
  }
}

TEST(Refusal, TimeNoiseWithoutTimesIsRefused) {
  TrialData data = synthetic(kTruths[0], 0.0, 1);
  data.turning.reset();
  data.coastdown.reset();
  IdentifyOptions options;
  options.method = Method::kNonlinear;
  options.noise = ErrorModel::kTime;
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->refused, ElementsAre(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta));
  EXPECT_TRUE(has_finding(result->model, "not-timed"));
  // The message must not claim that the rows lack two different forces, because they have them.
  for (const Finding& f : result->model.record.findings) {
    if (f.code != "not-identifiable" || f.severity != Severity::kError) continue;
    EXPECT_THAT(f.message, HasSubstr("elapsed_s in every row"));
    EXPECT_THAT(f.message, Not(HasSubstr("do not contain two different")));
  }
}

TEST(Refusal, AFitThatDidNotConvergeIsTheReason) {
  TrialData data = synthetic(kTruths[0], 0.0, 1);
  data.turning.reset();
  data.coastdown.reset();
  data.surge->rows.resize(3);
  IdentifyOptions options;
  options.method = Method::kNonlinear;
  options.surge_family = {Family::kPower};
  data.surge->rows[2].speed_mps = 1e300;
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  ASSERT_FALSE(result->refused.empty());
  for (const Finding& f : result->model.record.findings) {
    if (f.code != "not-identifiable" || f.severity != Severity::kError) continue;
    EXPECT_THAT(f.message, Not(HasSubstr("do not contain two different"))) << f.message;
  }
}

}  // namespace
}  // namespace awmr::testing
