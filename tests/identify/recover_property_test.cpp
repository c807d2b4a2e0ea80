/// For any robot, the results of `recover` from simulated tables are finite, or refused.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/identify/planning/recover.h"
#include "awmr/model/steady.h"
#include "support/any_robot.h"

namespace awmr::testing {
namespace {

/// Adds rows to the model's record that a robot with these parameters would have measured.
void add_trials(Model& model) {
  const Plant<double> plant = model.plant().value();
  const auto add = [&](TrialKind kind, const Resistance<double>& law, double input) {
    const auto rate = steady_rate(law, input);
    if (rate) model.record.trials.push_back({kind, "any.csv", 2, input, *rate, {}});
  };
  for (const double share : {0.1, 0.3, 0.5, 0.8}) {
    add(TrialKind::kSurge, plant.surge, 4.0 * share);
    add(TrialKind::kTurning, plant.yaw, 0.2 * share);
  }
}

void is_finite_or_refused(double beyond) {
  Model model = any_model(beyond);
  add_trials(model);
  RecoverOptions options;
  options.runs = 3;
  options.threads = 1;
  const auto recovery = recover(model, options, [](int) {});
  if (!recovery) {
    RC_ASSERT(recovery.error().kind != ErrorKind::kFault && !recovery.error().faults.empty());
    return;
  }
  RC_ASSERT(recovery->runs == 3 && recovery->failed >= 0 && recovery->failed <= 3);
  for (const RecoveredParameter& p : recovery->parameters) {
    RC_ASSERT(p.runs >= 0 && p.runs <= 3);
    if (p.runs == 0) continue;
    RC_ASSERT(std::isfinite(p.truth) && std::isfinite(p.bias) && std::isfinite(p.rmse));
    RC_ASSERT(p.rmse >= 0.0 && p.rmse >= std::abs(p.bias) * (1.0 - 1e-9));
    RC_ASSERT(p.coverage95 >= 0.0 && p.coverage95 <= 1.0);
  }
  RC_ASSERT(!recovery_text(*recovery, {}).empty());  // throws for a number that is not finite
}

TEST(RecoverProperty, InTheBoxEveryFigureIsFinite) {
  EXPECT_TRUE(rc::check([] { is_finite_or_refused(1.0); }));
}

TEST(RecoverProperty, TenTimesOutsideTheBoxTheSameHolds) {
  EXPECT_TRUE(rc::check([] { is_finite_or_refused(10.0); }));
}

}  // namespace
}  // namespace awmr::testing
