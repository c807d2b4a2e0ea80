/// For each of nine vehicles, tune() finds gains that meet every constraint and are better than
/// pole placement.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/simulate.h"
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
  put(tuning.baseline.gains.common());
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
  TuneOptions options;
  options.one_set = true;
  const Result<Tuning> tuning = tune(model, options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  EXPECT_EQ(tuning->baseline.source, kPolePlacement);
  EXPECT_EQ(tuning->baseline_objective, 1.0);
  EXPECT_LT(tuning->objective, 1.0);
  for (const ConstraintReport& c : tuning->constraints) {
    EXPECT_TRUE(!c.required || c.margin >= 0.0) << c.name;
  }
  // The search has changed the gains of pole placement: at least one differs by 1 %.
  const Gains<double>& tuned = tuning->gains;
  const Gains<double>& poles = tuning->baseline.gains.common();
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

/// Results of the tuned gains in a mode over the new draws, in all scenarios together.
const EvaluatedGains& evaluated_in(const Tuning& tuning, YawMode mode) {
  return *std::ranges::find_if(tuning.robust->evaluated, [&](const EvaluatedGains& one) {
    return one.gains == kRobustGains && one.mode == mode;
  });
}

/// Prints a row of the table in studies/vehicles.md: gains, and for each mode the share of settled
/// runs without and with an observer.
void print_row(const TestVehicle& vehicle, const Tuning& without, const Tuning& with) {
  const Gains<double>& gains = with.gains;
  fmt::print("| {} | {:.3g}, {:.3g}, {:.3g} |", vehicle.name, gains.heading.lambda,
             gains.heading.mu / gains.heading.epsilon, gains.observer.bandwidth_radps);
  for (const YawMode mode : kYawModes) {
    fmt::print(" {:.0f} / {:.0f} |", 100.0 * evaluated_in(without, mode).completed_share,
               100.0 * evaluated_in(with, mode).completed_share);
  }
  fmt::print("\n");
}

/// The default scenario with sensor noise, latency and motor lag, and with the yaw moment `push_m`
/// from `from_s` on.
Scenario pushed(const Model& model, double push_m, double from_s) {
  Scenario scenario = under(conditions_of(model.vehicle), default_tuning_scenario(model).value());
  DisturbanceTerm term;
  term.value = push_m;
  term.window.from_s = from_s;
  scenario.disturbance.yaw = {term};
  return scenario;
}

/// Number of runs with different noise, of kPushedRuns, that settle after every step.
constexpr int kPushedRuns = 8;
int settled_runs(const Model& model, const Gains<double>& gains, Scenario scenario, YawMode mode) {
  int settled = 0;
  for (int seed = 1; seed <= kPushedRuns; ++seed) {
    scenario.seed = static_cast<std::uint64_t>(seed);
    const Run run = simulate(model, gains, scenario, mode).value();
    settled += metrics_of(run, scenario, controller_for(model, gains).value()).completed ? 1 : 0;
  }
  return settled;
}

/// With the yaw moment of the default disturbance (kPush) to either side, from the start or from
/// the middle of each heading, the gains `with` the added observer settle in at least as many runs
/// of a mode as the gains without one. The runs of all pushes count together (48 in a mode),
/// because the noise decides which of a few runs settle.
void expect_settled_when_pushed(const Model& model, const Tuning& without, const Tuning& with) {
  TuneOptions options;
  options.observer.emplace();
  const std::vector<Scenario> scenarios = default_tuning_scenarios(model, options).value();
  const double push_m = scenarios.back().disturbance.yaw.front().value;
  const double duration_s = scenarios.front().duration_s;
  for (const YawMode mode : kYawModes) {
    int before = 0;
    int after = 0;
    for (const double from_s : {0.0, 0.25 * duration_s, 0.75 * duration_s}) {
      for (const double side : {-1.0, 1.0}) {
        const Scenario scenario = pushed(model, side * push_m, from_s);
        before += settled_runs(model, without.gains, scenario, mode);
        after += settled_runs(model, with.gains, scenario, mode);
      }
    }
    EXPECT_GE(after, before) << name_of(mode);
    fmt::print("pushed, {}: {} / {}\n", name_of(mode), before, after);
  }
}

TEST_P(DryFriction, GetsAnObserverWithWhichSteeringRunsSettle) {
  const Model model = model_of(GetParam());
  TuneOptions options;
  options.one_set = true;
  const Result<Tuning> with = tune(model, options);
  ASSERT_TRUE(with) << to_text(with.error());
  EXPECT_TRUE(with->observer_added);
  options.adds_observer = false;
  EXPECT_FALSE(tune(model, options)) << "gains with which no steering run settles";
  options.allows_unsettled = true;
  const Result<Tuning> without = tune(model, options);
  ASSERT_TRUE(without) << to_text(without.error());
  EXPECT_LT(evaluated_in(*without, YawMode::kSteering).completed_share, 0.1);
  for (const YawMode mode : kYawModes) {
    EXPECT_GT(evaluated_in(*with, mode).completed_share, 0.7) << name_of(mode);
  }
  print_row(GetParam(), *without, *with);
  expect_settled_when_pushed(model, *without, *with);
}

INSTANTIATE_TEST_SUITE_P(Steered, DryFriction, ::testing::ValuesIn(vehicles_with_dry_friction()));

INSTANTIATE_TEST_SUITE_P(FromToyToTractor, Vehicles, ::testing::ValuesIn(test_vehicles()));

}  // namespace
}  // namespace awmr::testing
