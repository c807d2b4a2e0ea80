/// For any robot, a validation has finite results or reports that there are none, and its file can
/// be written.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/core/provenance.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/simulate.h"
#include "awmr/validate/validate.h"
#include "support/any_robot.h"

namespace awmr::testing {
namespace {

TrialPoint any_trial(TrialKind kind) {
  TrialPoint trial;
  trial.kind = kind;
  trial.file = "any.csv";
  trial.line = 2;
  trial.input = ratio_between(1e-3, 4.0);
  trial.measured = ratio_between(1e-3, 100.0);
  return trial;
}

/// True for a plant whose runs would take minutes; simulate/bounds_test checks that each run is
/// bounded.
bool is_stiff(const Plant<double>& plant) {
  const auto decay_rate = [](const Resistance<double>& law, double inertia, double force) {
    const double w = steady_rate(law, force).value_or(0.0);
    return w > 0.0 ? law.alpha * law.beta * std::pow(w, law.beta - 1.0) / inertia : 0.0;
  };
  return substeps_for(plant, {}, 0.01) > 10 ||
         decay_rate(plant.surge, plant.mass_norm, 2.0) > 200.0 ||
         decay_rate(plant.yaw, plant.inertia_norm, 0.4) > 200.0;
}

void has_finite_figures(double beyond) {
  Model model = any_model(beyond);
  if (is_stiff(model.plant().value())) return;
  for (const TrialKind kind : {TrialKind::kSurge, TrialKind::kTurning, TrialKind::kCoastdown}) {
    model.record.trials.push_back(any_trial(kind));
    model.record.trials.push_back(any_trial(kind));
  }
  const auto validation = validate(model, std::nullopt, {});
  if (!validation) {
    RC_ASSERT(validation.error().kind != ErrorKind::kFault && !validation.error().faults.empty());
    return;
  }
  for (const TrialResidual& residual : validation->trials) {
    RC_ASSERT(!residual.predicted || std::isfinite(*residual.predicted));
    RC_ASSERT(!residual.relative_error || std::isfinite(*residual.relative_error));
  }
  for (const auto& figure :
       {validation->surge_rms_relative_error, validation->turning_rms_relative_error,
        validation->coastdown_rms_relative_error}) {
    RC_ASSERT(!figure || (std::isfinite(*figure) && *figure >= 0.0));
  }
  RC_ASSERT(!validation_text(*validation, {}).empty());  // throws for a number that is not finite
}

TEST(ValidateProperty, InTheBoxEveryFigureIsFinite) {
  EXPECT_TRUE(rc::check([] { has_finite_figures(1.0); }));
}

TEST(ValidateProperty, TenTimesOutsideTheBoxTheSameHolds) {
  EXPECT_TRUE(rc::check([] { has_finite_figures(10.0); }));
}

}  // namespace
}  // namespace awmr::testing
