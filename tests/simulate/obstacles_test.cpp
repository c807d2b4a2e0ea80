/// Clearance in random layouts, and behaviour if there is no passage.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "awmr/model/gains_file.h"
#include "awmr/simulate/metrics.h"
#include "simulate/layouts.h"
#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

awmr::Run run_of(const Scenario& scenario, YawMode mode) {
  const Plant<double> plant = paper_plant();
  // One RK4 step per sample makes the test fast. Its error for the servo with the time constant T,
  // (h/T)^5/120, is 3e-4 of the excursion.
  return simulate(plant, make_controller(plant, paper_vehicle(), kPaperGains), scenario, mode,
                  {.sample_time_s = 0.01, .substeps = 1});
}

/// Test parameters: a mode and the number of layouts.
class Layouts : public ::testing::TestWithParam<std::tuple<YawMode, int>> {};

std::string name_of_layouts(const ::testing::TestParamInfo<std::tuple<YawMode, int>>& test) {
  return std::string(name_of(std::get<YawMode>(test.param)));
}

TEST_P(Layouts, WithAPassageAreNeverTouched) {
  const auto& [mode, count] = GetParam();
  int seen = 0;
  int completed = 0;
  for (std::uint64_t number = 0; seen < count; ++number) {
    const Scenario scenario = random_layout(number);
    if (!has_passage(scenario)) continue;
    ++seen;
    double least_m = 1e9;
    const awmr::Run run = run_of(scenario, mode);
    for (const RunRow& row : run.rows) least_m = std::min(least_m, row.clearance_m);
    ASSERT_GT(least_m, 0.0) << "layout " << number;
    EXPECT_NE(run.end, RunEnd::kNoPassage) << "layout " << number;
    completed += run.end == RunEnd::kFinished ? 1 : 0;
  }
  // Clearance is guaranteed, arrival is not: the rule is local, and a vehicle that cannot turn on
  // the spot may have to stop before it passes.
  EXPECT_GT(completed, (mode == YawMode::kSteering ? 0.7 : 0.95) * count);
}

INSTANTIATE_TEST_SUITE_P(Short, Layouts,
                         ::testing::Combine(::testing::ValuesIn(kYawModes), ::testing::Values(300)),
                         name_of_layouts);
INSTANTIATE_TEST_SUITE_P(Long, Layouts,
                         ::testing::Combine(::testing::ValuesIn(kYawModes),
                                            ::testing::Values(1000)),
                         name_of_layouts);

/// Discs on a circle of 8 m around the goal, which touch when inflated.
std::vector<Obstacle<double>> ring(const Position<double>& centre, int left_out) {
  std::vector<Obstacle<double>> discs;
  for (int i = 0; i < 20; ++i) {
    if (i == left_out) continue;
    const double angle = 2.0 * pi<double>() * i / 20.0;
    discs.push_back(
        {{centre.x_m + 8.0 * std::cos(angle), centre.y_m + 8.0 * std::sin(angle)}, 0.4});
  }
  return discs;
}

TEST(Passage, IsBlockedByAClosedRingAndNotByAGap) {
  // Centres of neighbouring discs are 2 * 8 sin(9 deg) = 2.50 m apart, and their radii, inflated by
  // 1.3 m, are 1.7 m: they overlap. Without one disc the distance across the gap is
  // 2 * 8 sin(18 deg) = 4.94 m, more than 2 * 1.7 = 3.4 m.
  EXPECT_FALSE(passage_exists(ring({30.0, 0.0}, -1), 1.3, {0.0, 0.0}, {30.0, 0.0}));
  for (int gap = 0; gap < 20; ++gap) {
    EXPECT_TRUE(passage_exists(ring({30.0, 0.0}, gap), 1.3, {0.0, 0.0}, {30.0, 0.0})) << gap;
  }
  // If both ends are inside the ring, or both outside, there is a passage.
  EXPECT_TRUE(passage_exists(ring({30.0, 0.0}, -1), 1.3, {28.0, 1.0}, {30.0, 0.0}));
  EXPECT_TRUE(passage_exists(ring({30.0, 0.0}, -1), 1.3, {0.0, 0.0}, {60.0, 0.0}));
}

/// True if a flood fill on a grid of 0.2 m from (0, 0) reaches (20, 0), m, around the discs
/// inflated by `grow_m`.
bool flooded(const std::vector<Obstacle<double>>& discs, double grow_m) {
  constexpr int kSize = 200;
  constexpr double kCell_m = 0.2;
  const auto at = [&](int i, int j) {
    return Position<double>{i * kCell_m - 5.0, j * kCell_m - 20.0};
  };
  std::vector<char> taken(kSize * kSize, 0);
  std::vector<char> reached(kSize * kSize, 0);
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      for (const Obstacle<double>& disc : discs) {
        if (distance_m(disc.centre_m, at(i, j)) < disc.radius_m + grow_m) taken[i * kSize + j] = 1;
      }
    }
  }
  std::vector<int> open{25 * kSize + 100};  // (0, 0)
  while (!open.empty()) {
    const int cell = open.back();
    open.pop_back();
    const int i = cell / kSize, j = cell % kSize;
    if (i == 0 || j == 0 || i == kSize - 1 || j == kSize - 1) continue;
    for (const int next : {cell - 1, cell + 1, cell - kSize, cell + kSize}) {
      if (taken[next] != 0 || reached[next] != 0) continue;
      reached[next] = 1;
      open.push_back(next);
    }
  }
  return reached[125 * kSize + 100] != 0;  // (20, 0)
}

TEST(Passage, AgreesWithFloodingAGrid) {
  // Many small discs around the goal, so that some layouts have no passage.
  int closed = 0;
  int decided = 0;
  for (std::uint64_t number = 0; number < 60; ++number) {
    Random random(7, number);
    std::vector<Obstacle<double>> discs;
    const int count = 20 + static_cast<int>(number) / 2;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * pi<double>() * random.uniform();
      const double from_goal_m = 4.0 + 2.0 * random.uniform();
      discs.push_back({{20.0 + from_goal_m * std::cos(angle), from_goal_m * std::sin(angle)}, 0.9});
    }
    // A path is at most half a cell's diagonal, 0.141 m, from the nearest cell centres. Flood fills
    // with discs 0.15 m smaller and larger therefore bound the answer; if both agree, it is known.
    const bool at_most = flooded(discs, 0.5 - 0.15);
    const bool at_least = flooded(discs, 0.5 + 0.15);
    const bool exists = passage_exists(discs, 0.5, {0.0, 0.0}, {20.0, 0.0});
    if (at_most != at_least) continue;
    ++decided;
    closed += exists ? 0 : 1;
    EXPECT_EQ(exists, at_most) << number;
  }
  EXPECT_GT(decided, 20);
  EXPECT_GT(closed, 5);
  EXPECT_LT(closed, decided);
}

TEST(NoPassage, TheVehicleStopsAndReportsIt) {
  Scenario scenario = random_layout(0);
  scenario.obstacles = ring(kGoal_m, -1);
  for (const YawMode mode : kYawModes) {
    const awmr::Run run = run_of(scenario, mode);
    EXPECT_EQ(run.end, RunEnd::kNoPassage);
    EXPECT_LT(std::abs(run.rows.back().state.u_mps), 1e-3);
    const Plant<double> plant = paper_plant();
    const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
    EXPECT_FALSE(metrics_of(run, scenario, controller).completed);
  }
}

TEST(NoPassage, AnObstacleOnTheWaypointMakesItMissed) {
  Scenario scenario = random_layout(0);
  scenario.obstacles = {{{15.0, 0.0}, 2.0}};
  std::get<WaypointPath>(scenario.guidance).points_m = {{15.0, 0.5}, kGoal_m};
  const awmr::Run run = run_of(scenario, YawMode::kCombined);
  EXPECT_EQ(run.end, RunEnd::kFinished);
  EXPECT_EQ(run.missed_waypoints, 1);
}

TEST(NoPassage, AStartInsideAnObstaclesMarginIsLeft) {
  Scenario scenario = random_layout(0);
  scenario.obstacles = {{{1.0, 0.6}, 0.2}};  // inflated by 1.3 m it covers the start
  EXPECT_EQ(run_of(scenario, YawMode::kDifferential).end, RunEnd::kFinished);
}

}  // namespace
}  // namespace awmr::testing
