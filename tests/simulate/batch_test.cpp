/// Batches of runs in vector registers, compared with simulate() for each run.
#include "awmr/simulate/batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/core/random.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/scenario_file.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

constexpr double kSampleTime_s = 0.01;

/// Every scenario of configs/, cut to this duration: the Lissajous paths last 628 s.
std::vector<Scenario> shipped_scenarios(double longest_s = 200.0) {
  std::vector<Scenario> scenarios;
  for (const char* folder :
       {"/configs/paper/scenarios", "/configs/scenarios", "/configs/baselines"}) {
    for (const auto& file :
         std::filesystem::directory_iterator(std::string(AWMR_SOURCE_DIR) + folder)) {
      scenarios.push_back(*read_scenario(file.path()));
      scenarios.back().duration_s = std::min(scenarios.back().duration_s, longest_s);
    }
  }
  return scenarios;
}

Controller<double> paper_controller() {
  return make_controller(paper_plant(), paper_vehicle(), kPaperGains);
}

/// The paper's plant with every number multiplied by exp(x), x uniform in [-spread, spread].
Plant<double> drawn_plant(std::uint64_t sample, double spread) {
  Random random(7, sample);
  const auto draw = [&](double value) {
    return value * std::exp(spread * (2.0 * random.uniform() - 1.0));
  };
  Plant<double> plant = paper_plant();
  for (double* number :
       {&plant.surge.alpha, &plant.surge.beta, &plant.yaw.alpha, &plant.yaw.beta, &plant.sway_alpha,
        &plant.mass_norm, &plant.inertia_norm, &plant.steering_time_constant_s}) {
    *number = draw(*number);
  }
  return plant;
}

/// batch_arithmetic() with AWMR_INSTRUCTIONS set to `name`. Afterwards, the variable is as before.
Result<BatchArithmetic> arithmetic_named(const std::string& name) {
  constexpr const char* kVariable = "AWMR_INSTRUCTIONS";
  const char* const value = std::getenv(kVariable);
  const auto before = value != nullptr ? std::optional<std::string>(value) : std::nullopt;
  ::setenv(kVariable, name.c_str(), 1);
  const auto arithmetic = batch_arithmetic();
  if (before) {
    ::setenv(kVariable, before->c_str(), 1);
  } else {
    ::unsetenv(kVariable);
  }
  return arithmetic;
}

/// Returns all vector instruction sets of this processor.
std::vector<BatchArithmetic> all_arithmetics() {
  std::vector<BatchArithmetic> all;
  for (const char* name : {"avx2", "avx512", "neon"}) {
    if (const auto arithmetic = arithmetic_named(name)) all.push_back(*arithmetic);
  }
  return all;
}

std::vector<BatchRun> drawn_runs(std::size_t count, double spread,
                                 YawMode mode = YawMode::kCombined) {
  std::vector<BatchRun> runs;
  for (std::size_t i = 0; i < count; ++i) {
    const Plant<double> plant = i == 0 ? paper_plant() : drawn_plant(i, spread);
    runs.push_back({plant, paper_controller(), mode, i == 0 ? 0U : 5U, i});
  }
  return runs;
}

std::vector<std::optional<double>> numbers_of(const Metrics& m) {
  return {m.completed ? 1.0 : 0.0,  m.settling_time_s,     m.overshoot_deg,     m.heading_iae_degs,
          m.heading_itae_degs2,     m.cross_track_rms_m,   m.path_length_m,     m.speed_drop_mps,
          m.sideslip_max_deg,       m.yaw_rate_max_degps,  m.control_variation, m.control_effort,
          m.clearance_min_m,        m.finish_time_s,       m.energy_mech,       m.energy_electric,
          m.saturation_s,           m.steering_travel_deg, m.tyre_work,         m.speed_itae_m_s,
          m.steering_rate_rms_degps};
}

Metrics evaluate(const BatchRun& run, const Scenario& scenario) {
  return metrics_of(
      simulate(run.plant, run.controller, scenario, run.mode,
               {.sample_time_s = kSampleTime_s, .seed = run.seed, .sample = run.sample}),
      scenario, run.controller);
}

/// The metrics that simulate() gives for a run.
struct Reference {
  BatchRun run;
  Scenario scenario;
  Metrics metrics;
};
Reference reference_of(const BatchRun& run, const Scenario& scenario) {
  return {run, scenario, evaluate(run, scenario)};
}
std::vector<Reference> references_of(const std::vector<BatchRun>& runs, const Scenario& scenario) {
  std::vector<Reference> references;
  for (const BatchRun& run : runs) references.push_back(reference_of(run, scenario));
  return references;
}

/// Difference that counts as rounding: relative, or absolute for numbers below 1.
constexpr double kRounding = 1e-9;

bool is_near(const Metrics& batch, const Metrics& scalar) {
  const auto a = numbers_of(batch);
  const auto b = numbers_of(scalar);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].has_value() != b[i].has_value()) return false;
    if (a[i] && !(std::abs(*a[i] - *b[i]) <= kRounding * std::max(1.0, std::abs(*b[i]))))
      return false;
  }
  return true;
}

/// Sensitivity of a run to small changes: the largest effect on a metric if the mass or the inertia
/// increases or decreases by the fraction 1e-12. Four changes are tried, because it is a matter of
/// chance whether one of them changes the time at a limit by a sample.
struct Amplification {
  double largest = 0.0;            ///< relative change of a metric
  std::set<std::size_t> is_there;  ///< metrics that exist only with or only without such a change
};
Amplification amplification_of(const Reference& reference) {
  const auto scalar = numbers_of(reference.metrics);
  Amplification amplified;
  for (double Plant<double>::*const parameter :
       {&Plant<double>::mass_norm, &Plant<double>::inertia_norm}) {
    for (const double change : {-1e-12, 1e-12}) {
      BatchRun moved = reference.run;
      moved.plant.*parameter *= 1.0 + change;
      const auto other = numbers_of(evaluate(moved, reference.scenario));
      for (std::size_t i = 0; i < other.size(); ++i) {
        if (scalar[i].has_value() != other[i].has_value()) amplified.is_there.insert(i);
        if (!scalar[i] || !other[i]) continue;
        const double change_of_metric = std::abs(*other[i] - *scalar[i]);
        amplified.largest =
            std::max(amplified.largest, change_of_metric / std::max(1.0, std::abs(*scalar[i])));
      }
    }
  }
  return amplified;
}

/// Rounding changes the metrics by about 1e-13, unless the run amplifies it: some of the vehicles
/// are unstable with these gains. If a metric differs by more than kRounding, the amplification of
/// the run is measured. The largest amplification applies to all metrics, because a single metric
/// can be unaffected by chance: a time at a limit changes by whole samples or not at all.
void expect_near(const Metrics& batch, const Reference& reference, const std::string& where) {
  if (is_near(batch, reference.metrics)) return;
  const Amplification amplified = amplification_of(reference);
  const auto a = numbers_of(batch);
  const auto scalar = numbers_of(reference.metrics);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (amplified.is_there.contains(i)) continue;
    ASSERT_EQ(a[i].has_value(), scalar[i].has_value()) << where << ", number " << i;
    if (!a[i]) continue;
    const double bound =
        std::max(1.0, std::abs(*scalar[i])) * (kRounding + 100.0 * amplified.largest);
    EXPECT_NEAR(*a[i], *scalar[i], bound) << where << ", number " << i;
  }
}

void expect_same(const Metrics& a, const Metrics& b, const std::string& where) {
  EXPECT_EQ(numbers_of(a), numbers_of(b)) << where;
}

/// Metrics of the runs in a batch. No run may fail.
std::vector<Metrics> batch_metrics(std::span<const BatchRun> runs, const Scenario& scenario,
                                   const BatchArithmetic& arithmetic) {
  std::vector<Metrics> metrics;
  for (const DrivenRun& one : simulate_batch(runs, scenario, kSampleTime_s, arithmetic)) {
    EXPECT_NE(one.run.end, RunEnd::kFailed) << scenario.name;
    metrics.push_back(one.metrics);
  }
  return metrics;
}

/// Skips the tests if this processor does not support batches, because simulate() then replaces
/// them.
class Batch : public ::testing::Test {
 protected:
  void SetUp() override {
    if (all_arithmetics().empty()) {
      GTEST_SKIP() << "this program has no kernel that this processor runs (AWMR_KERNELS)";
    }
  }
};

TEST_F(Batch, IsTheRunOfSimulateInEveryShippedScenarioAndMode) {
  const BatchArithmetic arithmetic = batch_arithmetic().value();
  for (const Scenario& scenario : shipped_scenarios(60.0)) {
    for (const YawMode mode : kYawModes) {
      const std::vector<BatchRun> runs = drawn_runs(2, 0.2, mode);
      const auto batch = batch_metrics(runs, scenario, arithmetic);
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_near(
            batch[i], reference_of(runs[i], scenario),
            scenario.name + ", " + std::string(name_of(mode)) + ", run " + std::to_string(i));
      }
    }
  }
}

TEST_F(Batch, IsTheRunOfSimulateOnFourTyres) {
  const BatchArithmetic arithmetic = batch_arithmetic().value();
  for (Scenario& scenario : shipped_scenarios()) {
    if (!tyre_conflicts(scenario).empty()) continue;
    scenario.tyres.emplace();
    scenario.duration_s = std::min(scenario.duration_s, 20.0);
    for (const YawMode mode : kYawModes) {
      const std::vector<BatchRun> runs = drawn_runs(2, 0.2, mode);
      const auto batch = batch_metrics(runs, scenario, arithmetic);
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_near(batch[i], reference_of(runs[i], scenario),
                    "four tyres: " + scenario.name + ", " + std::string(name_of(mode)) + ", run " +
                        std::to_string(i));
      }
    }
  }
}

/// The run is a minute in open loop; metrics of a path are not compared.
TEST_F(Batch, IsTheRunOfSimulateOnFourTyresAfterAMinute) {
  Scenario scenario{.name = "a minute on tyres",
                    .duration_s = 60.0,
                    .initial = {},
                    .speed_mps = 0.0,
                    .guidance = OpenLoop{1.4, 0.08}};
  for (const double friction : {0.3, 0.8, 1.1}) {
    scenario.tyres = Tyres<double>{.friction = friction};
    for (const YawMode mode : kYawModes) {
      const std::vector<BatchRun> runs = drawn_runs(8, 0.2, mode);
      const auto batch = batch_metrics(runs, scenario, batch_arithmetic().value());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto a = numbers_of(batch[i]);
        const auto b = numbers_of(evaluate(runs[i], scenario));
        for (std::size_t n = 0; n < a.size(); ++n) {
          ASSERT_EQ(a[n].has_value(), b[n].has_value());
          if (!a[n]) continue;
          EXPECT_NEAR(*a[n], *b[n], 1e-9 * std::max(1.0, std::abs(*b[n])));
        }
      }
    }
  }
}

/// One batch has runs with gains without an observer and with two different observers.
TEST_F(Batch, IsTheRunOfSimulateWhateverObserverItsGainsHave) {
  const ObserverGains<double> observers[] = {{}, {5.0, 0.1, 0.5}, {1.0, 0.02, 0.3}};
  for (const Scenario& scenario : shipped_scenarios(30.0)) {
    std::vector<BatchRun> runs = drawn_runs(3, 0.2);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      runs[i].controller.gains.observer = observers[i];
    }
    const BatchArithmetic arithmetic = batch_arithmetic().value();
    const auto batch = batch_metrics(runs, scenario, arithmetic);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::string where = scenario.name + ", run " + std::to_string(i);
      expect_near(batch[i], reference_of(runs[i], scenario), where);
      const auto alone = batch_metrics(std::span(&runs[i], 1), scenario, arithmetic);
      expect_same(alone.front(), batch[i], where);
    }
  }
}

TEST_F(Batch, IsTheRunOfSimulateUnderABatteryThatSags) {
  for (Scenario& scenario : shipped_scenarios()) {
    scenario.duration_s = std::min(scenario.duration_s, 20.0);
    if (!scenario.battery) scenario.battery.emplace();
    scenario.battery->sag = 0.3;
    std::vector<BatchRun> runs = drawn_runs(2, 0.2);
    runs[1].plant.back_emf_s_per_m = 0.3;
    const auto batch = batch_metrics(runs, scenario, batch_arithmetic().value());
    for (std::size_t i = 0; i < runs.size(); ++i) {
      expect_near(batch[i], reference_of(runs[i], scenario),
                  "sagging: " + scenario.name + ", run " + std::to_string(i));
    }
  }
}

TEST_F(Batch, EventsHappenAtTheSampleOfSimulate) {
  const std::vector<BatchRun> runs = drawn_runs(1, 0.0);
  for (const Scenario& scenario : shipped_scenarios()) {
    if (scenario.duration_s > 200.0) continue;
    const Metrics scalar = evaluate(runs[0], scenario);
    for (const BatchArithmetic& arithmetic : all_arithmetics()) {
      const auto batch = batch_metrics(runs, scenario, arithmetic);
      EXPECT_EQ(batch[0].settling_time_s, scalar.settling_time_s) << scenario.name;
      EXPECT_EQ(batch[0].finish_time_s, scalar.finish_time_s) << scenario.name;
    }
  }
}

/// Parameters from a tenth to ten times the paper's. Exponents far above 1 need halved steps.
TEST_F(Batch, IsTheRunOfSimulateFarBeyondThePapersVehicle) {
  const std::vector<BatchRun> runs = drawn_runs(16, std::log(10.0));
  const Scenario open{"open", 1.5, {}, 0.0, OpenLoop{1.0, 0.05}};
  const Scenario heading{"heading", 1.0, {}, 1.0, HeadingSteps{{{0.0, 0.5}, {0.5, -0.5}}}};
  Scenario lqi = heading;
  lqi.name = "LQI";
  lqi.control.lqi = {0.1, 0.3, 0.3, 0.02};
  for (const Scenario& scenario : {open, heading, lqi}) {
    const std::vector<Reference> references = references_of(runs, scenario);
    for (const BatchArithmetic& arithmetic : all_arithmetics()) {
      const auto batch = batch_metrics(runs, scenario, arithmetic);
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_near(batch[i], references[i], scenario.name + ", run " + std::to_string(i));
      }
    }
  }
}

/// Each vehicle of the batch has a different back-EMF; one has none.
TEST_F(Batch, IsTheRunOfSimulateWithBackEmf) {
  std::vector<BatchRun> runs = drawn_runs(3, 0.2);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    runs[i].plant.back_emf_s_per_m = 0.2 * static_cast<double>(i);
    runs[i].controller = make_controller(runs[i].plant, paper_vehicle(), kPaperGains);
  }
  for (const Scenario& scenario : shipped_scenarios()) {
    if (scenario.duration_s > 40.0) continue;
    const std::vector<Reference> references = references_of(runs, scenario);
    for (const BatchArithmetic& arithmetic : all_arithmetics()) {
      const auto batch = batch_metrics(runs, scenario, arithmetic);
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_near(batch[i], references[i], scenario.name + ", run " + std::to_string(i));
      }
    }
  }
}

TEST_F(Batch, IsTheRunOfSimulateWithFrontWheelDrive) {
  for (const Scenario& scenario : shipped_scenarios()) {
    if (scenario.duration_s > 40.0) continue;
    for (const YawMode mode : kYawModes) {
      std::vector<BatchRun> runs = drawn_runs(2, 0.2, mode);
      for (BatchRun& run : runs) {
        run.plant.rear_driven = 0.0;
        run.controller = make_controller(run.plant, paper_vehicle(), kPaperGains);
      }
      const std::vector<Reference> references = references_of(runs, scenario);
      for (const BatchArithmetic& arithmetic : all_arithmetics()) {
        const auto batch = batch_metrics(runs, scenario, arithmetic);
        for (std::size_t i = 0; i < runs.size(); ++i) {
          expect_near(
              batch[i], references[i],
              scenario.name + ", " + std::string(name_of(mode)) + ", run " + std::to_string(i));
        }
      }
    }
  }
}

/// Coulomb friction in yaw with tuned friction widths, which differ between the modes. Tyre work is
/// against the friction itself: the width changes the commands only.
TEST_F(Batch, IsTheRunOfSimulateWithTunedFrictionWidths) {
  for (const YawMode mode : kYawModes) {
    std::vector<BatchRun> runs = drawn_runs(2, 0.2, mode);
    Gains<double> gains = kPaperGains;
    gains.heading.friction_width_radps = 0.3;
    gains.heading.combined_friction_width_radps = 0.1;
    for (BatchRun& run : runs) {
      run.plant.yaw.coulomb = 0.01;
      run.controller = make_controller(run.plant, paper_vehicle(), gains);
    }
    for (const Scenario& scenario : shipped_scenarios(15.0)) {
      const auto batch = batch_metrics(runs, scenario, batch_arithmetic().value());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_near(
            batch[i], reference_of(runs[i], scenario),
            scenario.name + ", " + std::string(name_of(mode)) + ", run " + std::to_string(i));
      }
    }
  }
}

TEST_F(Batch, DoesNotDependOnOtherRunsAndPosition) {
  std::vector<BatchRun> runs = drawn_runs(37, 0.2);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].mode = kYawModes[i % std::size(kYawModes)];
  const Scenario scenario =
      *read_scenario(std::string(AWMR_SOURCE_DIR) + "/configs/scenarios/noisy_sensors.json");
  std::vector<BatchRun> reversed(runs.rbegin(), runs.rend());
  for (const BatchArithmetic& arithmetic : all_arithmetics()) {
    const auto whole = batch_metrics(runs, scenario, arithmetic);
    const auto backwards = batch_metrics(reversed, scenario, arithmetic);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      expect_same(whole[i], backwards[runs.size() - 1 - i], "run " + std::to_string(i));
    }
    const auto alone = batch_metrics(std::span(runs).subspan(20, 1), scenario, arithmetic);
    expect_same(whole[20], alone[0], "alone");
  }
}

TEST_F(Batch, HasTheSameBitsOnAllInstructions) {
  const auto arithmetics = all_arithmetics();
  if (arithmetics.size() < 2) {
    GTEST_SKIP() << "needs two kernels that this processor runs (AWMR_KERNELS)";
  }
  // With 4 or 8 runs in a register, the last register is not full.
  const std::vector<BatchRun> runs = drawn_runs(11, 0.2);
  for (const Scenario& scenario : shipped_scenarios(60.0)) {
    const auto first = batch_metrics(runs, scenario, arithmetics.front());
    for (std::size_t k = 1; k < arithmetics.size(); ++k) {
      const auto metrics = batch_metrics(runs, scenario, arithmetics[k]);
      for (std::size_t i = 0; i < runs.size(); ++i) {
        expect_same(first[i], metrics[i], scenario.name);
      }
    }
  }
}

/// Resistance too stiff at the initial speed for any step: simulate() reports it.
TEST_F(Batch, ReportsAFailedRunAndContinuesWithTheOthers) {
  std::vector<BatchRun> runs = drawn_runs(3, 0.2, YawMode::kDifferential);
  runs[1].plant.surge.beta = 20.0;
  Scenario scenario{"fast", 1.0, {}, 0.0, OpenLoop{1.0, 0.0}};
  scenario.initial.u_mps = 1000.0;
  for (const BatchArithmetic& arithmetic : all_arithmetics()) {
    const auto batch = simulate_batch(runs, scenario, kSampleTime_s, arithmetic);
    EXPECT_NE(batch[0].run.end, RunEnd::kFailed);
    EXPECT_FALSE(failure_of(batch[1].run, scenario));
    EXPECT_NE(batch[2].run.end, RunEnd::kFailed);
  }
}

std::vector<double> numbers_of(const RunRow& row) {
  return {row.t_s,
          row.state.x_m,
          row.state.y_m,
          row.state.psi_rad,
          row.state.u_mps,
          row.state.v_mps,
          row.state.r_radps,
          row.state.steering_rad,
          row.force.left,
          row.force.right,
          row.steering_command_rad,
          row.tau_speed,
          row.tau_turn_m,
          row.psi_ref_rad,
          row.u_ref_mps,
          row.path.psi_goal_rad,
          row.path.cross_track_m,
          row.path.target_m.x_m,
          row.path.target_m.y_m,
          static_cast<double>(row.path.leg),
          row.measured.psi_rad,
          row.measured.u_mps,
          row.measured_position_m.x_m,
          row.measured_position_m.y_m,
          row.disturbance.surge,
          row.disturbance.yaw_m,
          row.clearance_m,
          row.tyre_power_mps};
}

/// Compares the rows of the nominal vehicle, whose run does not amplify rounding. One batch has
/// this vehicle in all three modes.
TEST_F(Batch, RowsAreThoseOfSimulateInEveryShippedScenario) {
  const BatchArithmetic arithmetic = batch_arithmetic().value();
  for (const Scenario& scenario : shipped_scenarios()) {
    if (scenario.duration_s > 150.0) continue;
    std::vector<BatchRun> runs;
    for (const YawMode mode : kYawModes) runs.push_back(drawn_runs(1, 0.0, mode).front());
    const auto driven = simulate_batch(runs, scenario, kSampleTime_s, arithmetic, true);
    const auto alone = batch_metrics(runs, scenario, arithmetic);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const awmr::Run scalar = simulate(runs[i].plant, runs[i].controller, scenario, runs[i].mode,
                                        {.sample_time_s = kSampleTime_s});
      expect_same(driven[i].metrics, alone[i], scenario.name);
      const awmr::Run& run = driven[i].run;
      EXPECT_EQ(run.substeps, scalar.substeps);
      EXPECT_EQ(run.end, scalar.end) << scenario.name;
      EXPECT_EQ(run.missed_waypoints, scalar.missed_waypoints);
      ASSERT_EQ(run.rows.size(), scalar.rows.size()) << scenario.name;
      double most = 0.0;
      for (std::size_t k = 0; k < run.rows.size(); ++k) {
        const auto a = numbers_of(run.rows[k]);
        const auto b = numbers_of(scalar.rows[k]);
        for (std::size_t n = 0; n < a.size(); ++n) {
          most = std::max(most, std::abs(a[n] - b[n]) / std::max(1.0, std::abs(b[n])));
        }
      }
      EXPECT_LT(most, 1e-6) << scenario.name << ", " << name_of(runs[i].mode);
    }
  }
}

TEST(Instructions, RefusesUnsupportedOnesByName) {
  for (const std::string name : {"mmx", "sse2"}) {
    const auto arithmetic = arithmetic_named(name);
    ASSERT_FALSE(arithmetic) << name;
    EXPECT_NE(arithmetic.error().faults.front().message.find("unsupported instruction set '" +
                                                             name + "'"),
              std::string::npos);
  }
}

TEST(Instructions, NamedScalarAreSimulateItself) {
  const std::vector<BatchRun> runs = drawn_runs(2, 0.2, YawMode::kSteering);
  const Scenario scenario = heading_steps({30.0, -30.0});
  const auto metrics = batch_metrics(runs, scenario, {"scalar", "scalar"});
  for (std::size_t i = 0; i < runs.size(); ++i) {
    expect_same(metrics[i], evaluate(runs[i], scenario), "scalar");
  }
}

}  // namespace
}  // namespace awmr::testing
