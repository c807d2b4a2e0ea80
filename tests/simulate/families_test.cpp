/// Every resistance family in simulator and controller.
#include <gtest/gtest.h>

#include "awmr/model/gains_file.h"
#include "awmr/model/steady.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

Plant<double> plant_of(const Resistance<double>& surge, double dead_zone) {
  Plant<double> plant = paper_plant();
  plant.surge = surge;
  plant.wheel_dead_zone = dead_zone;
  return plant;
}

const struct {
  const char* name;
  Resistance<double> surge;
  double dead_zone;
} kCases[] = {
    {"power", {.alpha = 1.3157, .beta = 0.8841}, 0.0},
    {"Coulomb + linear", {.alpha = 1.0, .beta = 1.0, .coulomb = 0.3}, 0.0},
    {"Coulomb + linear + quadratic",
     {.alpha = 0.6, .beta = 1.0, .coulomb = 0.3, .quadratic = 0.4},
     0.0},
    {"Coulomb + power", {.alpha = 1.0, .beta = 0.6, .coulomb = 0.2}, 0.0},
    {"dead zone", {.alpha = 1.3157, .beta = 0.8841}, 0.06},
};

TEST(Families, SettleAtTheSteadySpeedOfTheLawWithDeadZone) {
  for (const auto& c : kCases) {
    Plant<double> plant = plant_of(c.surge, c.dead_zone);
    const Vehicle vehicle = paper_vehicle();
    Controller<double> controller = make_controller(plant, vehicle, {});
    // Switches off the compensation of the dead zone, because the test commands fixed motor forces
    // in open loop.
    controller.limits.dead_zone = 0.0;
    const Scenario scenario{"open loop", 5.0, {}, 0.0, OpenLoop{1.2, 0.0}};
    const awmr::Run run =
        simulate(plant, controller, scenario, YawMode::kDifferential, {.sample_time_s = 0.01});
    // The slowest time constant m'/g' is below 0.1 s, so the speed is steady after 5 s.
    EXPECT_NEAR(run.rows.back().state.u_mps, *steady_rate(c.surge, 1.2 - 4.0 * c.dead_zone), 1e-9)
        << c.name;
  }
}

Plant<double> geared(double back_emf_s_per_m, const Resistance<double>& surge) {
  Plant<double> plant = plant_of(surge, 0.0);
  plant.back_emf_s_per_m = back_emf_s_per_m;
  return plant;
}

TEST(BackEmf, SettlesAtTheSpeedThatItLeaves) {
  for (const auto& c : kCases) {
    if (c.dead_zone > 0.0) continue;
    const Plant<double> plant = geared(0.25, c.surge);
    const awmr::Run run = run_open_loop(plant, {}, 5.0, {1.2, 0.0});
    EXPECT_NEAR(run.rows.back().state.u_mps, *steady_rate(c.surge, 1.2, 4.0 * 0.25), 1e-9)
        << c.name;
  }
}

TEST(BackEmf, IsMadeUpForByTheController) {
  const Plant<double> plant = geared(0.25, {.alpha = 1.3157, .beta = 0.8841});
  const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const Scenario scenario{"heading", 8.0, {}, 0.8, HeadingSteps{{{0.0, 0.5}}}};
  for (const YawMode mode : kYawModes) {
    const awmr::Run run = simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01});
    const RunRow& last = run.rows.back();
    // The tolerances are those of TheControllerHoldsSpeedAndHeadingWithEveryOne, where motors are
    // ideal.
    EXPECT_NEAR(last.state.u_mps, 0.8, 1e-3);
    EXPECT_NEAR(last.state.psi_rad, 0.5, 1e-3);
    EXPECT_NEAR(last.force.left, plant.surge(0.8) / 4.0 + 0.25 * 0.8, 1e-3);
    for (const RunRow& row : run.rows) {
      EXPECT_LE(std::abs(row.force.left), 1.0);
      EXPECT_LE(std::abs(row.force.right), 1.0);
    }
  }
}

/// If the commanded speed needs more than full voltage, the vehicle drives at the speed of full
/// voltage.
TEST(BackEmf, FullVoltageGivesTheNoLoadSpeedReducedByResistance) {
  const Resistance<double> surge{.alpha = 1.3157, .beta = 0.8841};
  const Plant<double> plant = geared(0.8, surge);
  const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
  const Scenario scenario{"fast", 8.0, {}, 1.5, HeadingSteps{{{0.0, 0.0}}}};
  const awmr::Run run =
      simulate(plant, controller, scenario, YawMode::kCombined, {.sample_time_s = 0.01});
  EXPECT_NEAR(run.rows.back().state.u_mps, *steady_rate(surge, 4.0, 4.0 * 0.8), 1e-6);
  EXPECT_EQ(run.rows.back().force.left, 1.0);
}

/// Motors that are off do not brake: the stop time is that of the law, also with a lag.
TEST(BackEmf, IsZeroWithTheMotorsOff) {
  const Plant<double> ideal = geared(0.0, {.alpha = 1.3157, .beta = 0.8841});
  const Plant<double> plant = geared(0.5, {.alpha = 1.3157, .beta = 0.8841});
  State<double> start{};
  start.u_mps = 1.5;
  Scenario scenario{"coast", 1.0, start, 0.0, OpenLoop{0.0, 0.0}};
  scenario.actuators = Actuators{.motor_time_constant_s = 0.1};
  const auto end_of = [&](const Plant<double>& p) {
    return simulate(p, make_controller(p, paper_vehicle(), kPaperGains), scenario,
                    YawMode::kDifferential, {.sample_time_s = 0.01, .substeps = 20})
        .rows.back()
        .state.u_mps;
  };
  EXPECT_EQ(end_of(plant), end_of(ideal));
}

/// The compensation of back-EMF would otherwise drive such a vehicle at full force.
TEST(BackEmf, IsNotMadeUpForASpeedFarAboveTheCommand) {
  constexpr double kCommanded_mps = 0.5;
  const Plant<double> plant = geared(0.3, {.alpha = 1.3157, .beta = 0.8841});
  const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
  Scenario scenario{"wrong speed", 6.0, {}, kCommanded_mps, HeadingSteps{{{0.0, 0.0}}}};
  scenario.sensors.emplace().speed.bias = 4.0;
  const awmr::Run run =
      simulate(plant, controller, scenario, YawMode::kDifferential, {.sample_time_s = 0.01});
  const double fastest_mps = kCommanded_mps + kPaperGains.speed.epsilon;
  for (const RunRow& row : run.rows) EXPECT_LE(row.state.u_mps, fastest_mps) << row.t_s;
}

TEST(FrontWheelDrive, HoldsSpeedAndHeadingInEveryModeWithAndWithoutBackEmf) {
  for (const double back_emf : {0.0, 0.25}) {
    Plant<double> plant = geared(back_emf, {.alpha = 1.3157, .beta = 0.8841});
    plant.rear_driven = 0.0;
    const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
    const Scenario scenario{"heading", 8.0, {}, 0.6, HeadingSteps{{{0.0, 0.5}}}};
    for (const YawMode mode : kYawModes) {
      const RunRow last =
          simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01}).rows.back();
      // The tolerances are those of TheControllerHoldsSpeedAndHeadingWithEveryOne, where all four
      // wheels are driven.
      EXPECT_NEAR(last.state.u_mps, 0.6, 1e-3) << name_of(mode) << back_emf;
      EXPECT_NEAR(last.state.psi_rad, 0.5, 1e-3) << name_of(mode) << back_emf;
      EXPECT_NEAR(last.force.left, plant.surge(0.6) / 2.0 + back_emf * 0.6, 1e-3);
    }
  }
}

TEST(Families, AForceBelowCoulombFrictionDoesNotMoveAVehicleAtRest) {
  const Plant<double> plant = plant_of({.alpha = 1.0, .beta = 1.0, .coulomb = 0.3}, 0.0);
  const awmr::Run run = run_open_loop(plant, {}, 5.0, {0.25, 0.0});
  EXPECT_EQ(run.rows.back().state.u_mps, 0.0);
  EXPECT_EQ(run.rows.back().state.x_m, 0.0);
}

TEST(Families, CoulombFrictionStopsAVehicleAtTheStopTime) {
  const Plant<double> plant = plant_of({.alpha = 1.0, .beta = 1.0, .coulomb = 0.3}, 0.0);
  State<double> start{};
  start.u_mps = 1.5;
  const double stop_s = *stop_time_s(plant.surge, plant.mass_norm, start.u_mps);
  const awmr::Run run = run_open_loop(plant, start, 2.0 * stop_s, {0.0, 0.0});
  for (const RunRow& row : run.rows) {
    if (row.t_s < stop_s - 0.01) {
      EXPECT_GT(row.state.u_mps, 0.0) << row.t_s;
    } else if (row.t_s > stop_s + 0.01) {
      EXPECT_EQ(row.state.u_mps, 0.0) << row.t_s;
    }
  }
}

TEST(Families, TheControllerHoldsSpeedAndHeadingWithEveryOne) {
  for (const auto& c : kCases) {
    const Plant<double> plant = plant_of(c.surge, c.dead_zone);
    const Controller<double> controller = make_controller(plant, paper_vehicle(), kPaperGains);
    const Scenario scenario{"heading", 8.0, {}, 0.8, HeadingSteps{{{0.0, 0.5}}}};
    for (const YawMode mode : kYawModes) {
      const awmr::Run run = simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01});
      const RunRow& last = run.rows.back();
      // The feed-forward is the plant's own law, so no steady error remains. The transient decays
      // with 1/lambda = 0.33 s; 8 s are 24 of them.
      EXPECT_NEAR(last.state.u_mps, 0.8, 1e-3) << c.name;
      EXPECT_NEAR(last.state.psi_rad, 0.5, 1e-3) << c.name;
    }
  }
}

TEST(Families, TheTimeToSlowDownIsTheSimulatorsToo) {
  for (const auto& c : kCases) {
    const Plant<double> plant = plant_of(c.surge, c.dead_zone);
    State<double> start{};
    start.u_mps = 1.5;
    const awmr::Run run = run_open_loop(plant, start, 3.0, {0.0, 0.0});
    // The time from 1.5 to 0.5 m/s is the difference of the two stop times.
    const double slowed_s = *stop_time_s(plant.surge, plant.mass_norm, 1.5) -
                            *stop_time_s(plant.surge, plant.mass_norm, 0.5);
    double at_half_s = 0.0;
    for (const RunRow& row : run.rows) {
      if (row.state.u_mps > 0.5) at_half_s = row.t_s;
    }
    EXPECT_NEAR(at_half_s, slowed_s, 0.01) << c.name;  // one sample
  }
}

}  // namespace
}  // namespace awmr::testing
