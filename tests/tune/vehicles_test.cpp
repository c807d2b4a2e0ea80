/// Gains for nine vehicles: found for each, within every constraint, better than pole placement.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/tune/tune.h"
#include "tune/vehicles.h"

namespace awmr::testing {
namespace {

class Vehicles : public ::testing::TestWithParam<TestVehicle> {};

/// Gains and quantiles of the slowest mode, as a row of a table.
std::string row_of(const TestVehicle& vehicle, const Scenario& scenario, const Tuning& tuning) {
  std::string row =
      fmt::format("| {} | {:g} / {:g} | {:g} m/s, {:g} deg |", vehicle.name, vehicle.servo_s,
                  vehicle.sample_time_s, scenario.speed_mps,
                  degrees(std::get<HeadingSteps>(scenario.guidance).steps[0].psi_rad));
  const auto put = [&](const Gains<double>& g) {
    row += fmt::format(" {:.3g}, {:.3g}, {:.3g} |", g.heading.lambda,
                       g.heading.mu / g.heading.epsilon, g.speed.mu / g.speed.epsilon);
  };
  put(tuning.baseline.gains);
  put(tuning.gains);
  row += fmt::format(" {:.3f} |", tuning.objective);
  if (!tuning.robust) return row;
  for (const char* name : {"settling_time_s", "overshoot_deg", "steering_rate_rms_degps"}) {
    double tuned = 0.0;
    double baseline = 0.0;
    for (const EvaluatedGains& evaluated : tuning.robust->evaluated) {
      for (const EvaluatedFigure& figure : evaluated.figures) {
        if (figure.name != name) continue;
        if (evaluated.gains == "robust") tuned = std::max(tuned, figure.q95);
        if (evaluated.gains == "baseline") baseline = std::max(baseline, figure.q95);
      }
    }
    row += fmt::format(" {:.3g} / {:.3g} |", tuned, baseline);
  }
  return row;
}

TEST_P(Vehicles, HaveGainsThatKeepEveryConstraintAndScoreBetterThanPolePlacement) {
  const Model model = model_of(GetParam());
  const Result<Tuning> tuning = tune(model, TuneOptions{});
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_EQ(tuning->baseline.source, kPolePlacement);
  EXPECT_EQ(tuning->baseline_objective, 1.0);
  EXPECT_LT(tuning->objective, 1.0);
  for (const ConstraintReport& c : tuning->constraints) {
    EXPECT_TRUE(!c.required || c.margin >= 0.0) << c.name;
  }
  // The search has changed the gains of pole placement: at least one differs by 1 %.
  const Gains<double>& tuned = tuning->gains;
  const Gains<double>& poles = tuning->baseline.gains;
  double differs = 0.0;
  for (const double ratio :
       {tuned.heading.lambda / poles.heading.lambda, tuned.heading.mu / poles.heading.mu,
        tuned.heading.epsilon / poles.heading.epsilon, tuned.speed.mu / poles.speed.mu,
        tuned.speed.epsilon / poles.speed.epsilon}) {
    differs = std::max(differs, std::abs(std::log(ratio)));
  }
  EXPECT_GT(differs, 0.01);
  fmt::print("{}\n", row_of(GetParam(), default_tuning_scenario(model).value(), *tuning));
}

class DryFriction : public ::testing::TestWithParam<TestVehicle> {};

/// Rows of a table: for each mode, the share of settled runs, %, and the 95 % quantile of the
/// settling time, s, with the tuned gains and without an observer.
std::string settled_runs(const TestVehicle& vehicle, const Tuning& with,
                         const Result<Tuning>& out) {
  std::string row = fmt::format(
      "| {} | {:.3g}, {:.3g}, {:.3g} |", vehicle.name, with.gains.heading.lambda,
      with.gains.heading.mu / with.gains.heading.epsilon, with.gains.observer.bandwidth_radps);
  const auto put = [&](const Tuning& tuning, YawMode mode) {
    for (const EvaluatedGains& one : tuning.robust->evaluated) {
      if (one.gains != kRobustGains || one.mode != mode) continue;
      const auto settling =
          std::ranges::find(one.figures, "settling_time_s", &EvaluatedFigure::name);
      row += fmt::format(" {:.0f} %, {:.3g} s |", 100.0 * one.completed_share, settling->q95);
    }
  };
  for (const YawMode mode : kYawModes) {
    if (out) put(*out, mode);
    put(with, mode);
  }
  return row;
}

TEST_P(DryFriction, GetsAnObserverWithWhichTheRunsOfEveryModeSettle) {
  const Model model = model_of(GetParam());
  const Result<Tuning> tuning = tune(model, TuneOptions{});
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_TRUE(tuning->observer_added);
  EXPECT_TRUE(tuning->unsettled.empty());
  TuneOptions without;
  without.adds_observer = false;
  fmt::print("{}\n", settled_runs(GetParam(), *tuning, tune(model, without)));
}

INSTANTIATE_TEST_SUITE_P(Steered, DryFriction, ::testing::ValuesIn(vehicles_with_dry_friction()));

INSTANTIATE_TEST_SUITE_P(FromToyToTractor, Vehicles, ::testing::ValuesIn(test_vehicles()));

}  // namespace
}  // namespace awmr::testing
