/// For any robot and gains, every metric of every sample is finite, or the run is refused.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/compare/compare.h"
#include "support/any_robot.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

/// A model with standard errors of a few per cent.
Model any_uncertain_model(double beyond) {
  Model model = any_model(beyond);
  model.covariance.parameters = {ParameterId::kSurgeAlpha, ParameterId::kMassNorm};
  const double alpha = 0.03 * *model[ParameterId::kSurgeAlpha].value;
  const double mass = 0.05 * *model[ParameterId::kMassNorm].value;
  model.covariance.matrix = {{alpha * alpha, 0.5 * alpha * mass},
                             {0.5 * alpha * mass, mass * mass}};
  return model;
}

void is_finite_or_refused(double beyond) {
  const auto comparison =
      compare(any_uncertain_model(beyond), any_gains(beyond), {short_heading(), short_open_loop()},
              {.samples = 2, .threads = 1});
  if (!comparison) {
    RC_ASSERT(!comparison.error().faults.empty());
    RC_ASSERT(comparison.error().kind != ErrorKind::kFault);
    return;
  }
  RC_ASSERT(comparison->rows.size() == 18u);  // 2 scenarios, 3 modes, nominal and 2 draws
  for (const ComparisonRow& row : comparison->rows) {
    const Metrics& m = row.metrics;
    for (const double value : {m.path_length_m, m.sideslip_max_deg, m.yaw_rate_max_degps,
                               m.control_variation, m.control_effort}) {
      RC_ASSERT(std::isfinite(value) && value >= 0.0);
    }
    for (const auto& value : {m.settling_time_s, m.overshoot_deg, m.heading_iae_degs,
                              m.heading_itae_degs2, m.cross_track_rms_m, m.speed_drop_mps}) {
      RC_ASSERT(!value || (std::isfinite(*value) && *value >= 0.0));
    }
    // Commands are within their limits: F'L, F'R and d_r/d_max within [-1, 1].
    RC_ASSERT(m.control_effort <= 3.0 + 1e-9);
  }
  const std::string csv = comparison_csv(*comparison);
  RC_ASSERT(csv.find("nan") == std::string::npos && csv.find("inf") == std::string::npos);
}

TEST(CompareProperty, InTheBoxEveryMetricIsFinite) {
  EXPECT_TRUE(rc::check([] { is_finite_or_refused(1.0); }));
}

TEST(CompareProperty, TenTimesOutsideTheBoxTheSameHolds) {
  EXPECT_TRUE(rc::check([] { is_finite_or_refused(10.0); }));
}

}  // namespace
}  // namespace awmr::testing
