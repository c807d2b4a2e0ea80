/// Obstacle avoidance, one step at a time.
#include "awmr/control/guidance/obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/strict_scalar.h"

namespace awmr::testing {
namespace {

using O = Obstacle<double>;

constexpr Avoidance<double> kAvoidance{.mmd_base_m = 4.0,
                                       .mmd_per_speed_s = 1.0,
                                       .sigma_rad = 0.2,
                                       .vehicle_radius_m = 0.5,
                                       .clearance_m = 0.5,
                                       .hysteresis_m = 0.5,
                                       .side_hysteresis_rad = 0.2,
                                       .brake_m = 2.0};
constexpr double kFar = 1e9;

Avoided<double> avoided(const std::vector<O>& obstacles, double guidance_rad = 0.0,
                        double target_m = kFar, AvoidanceState state = {}) {
  std::vector<Sector<double>> sectors(obstacles.size());
  return avoid(kAvoidance, obstacles.data(), sectors.data(), static_cast<int>(obstacles.size()),
               {0.0, 0.0}, 0.0, 1.0, guidance_rad, target_m, state);
}

TEST(Obstacles, BeyondTheManoeuvringDistanceNothingHappens) {
  // The distance to the inflated disc, D_obs = 7.1 - (1 + 1) = 5.1 m, is above the minimum
  // manoeuvring distance MMD = 4 + 1 m.
  const auto a = avoided({{{7.1, 0.0}, 1.0}});
  EXPECT_FALSE(a.active);
  EXPECT_EQ(a.psi_rad, 0.0);
  EXPECT_EQ(a.speed_share, 1.0);
}

TEST(Obstacles, TheTurnIsTheTangentPlusSigmasShare) {
  // Centre at D = 6 m, inflated radius R = 2 m, D_obs = 4 m, weight w = 1/5: the heading changes by
  // asin(1/3) + 0.2/5; with equal angles, to the left.
  const auto a = avoided({{{6.0, 0.0}, 1.0}});
  EXPECT_TRUE(a.active);
  EXPECT_NEAR(a.psi_rad, std::asin(1.0 / 3.0) + 0.04, 1e-12);
}

TEST(Obstacles, TheNearerSideIsTaken) {
  EXPECT_LT(avoided({{{5.0, 0.5}, 1.0}}).psi_rad, 0.0);
  EXPECT_GT(avoided({{{5.0, -0.5}, 1.0}}).psi_rad, 0.0);
}

TEST(Obstacles, TheSideOnceTakenIsKept) {
  const std::vector<O> slightly_left = {{{5.0, 0.1}, 1.0}};
  EXPECT_LT(avoided(slightly_left).psi_rad, 0.0);
  EXPECT_GT(avoided(slightly_left, 0.0, kFar, {AvoidanceSide::kLeft}).psi_rad, 0.0);
}

TEST(Obstacles, AWallOfOverlappingSectorsIsRoundedAsOne) {
  const std::vector<O> wall = {
      {{4.0, 0.0}, 1.0}, {{4.0, 2.5}, 1.0}, {{4.0, -2.5}, 1.0}, {{4.0, -5.0}, 1.0}};
  const auto a = avoided(wall);
  // The left edge of the blocked sector is the bearing of (4, 2.5) plus the half angle. The right
  // edge is farther from the goal.
  const double d = std::hypot(4.0, 2.5);
  const double w = (5.0 - (d - 2.0)) / 5.0;
  EXPECT_NEAR(a.psi_rad, std::atan2(2.5, 4.0) + std::asin(2.0 / d) + 0.2 * w, 1e-12);
}

TEST(Obstacles, BehindTheTargetTheyDoNotMatter) {
  EXPECT_FALSE(avoided({{{5.0, 0.0}, 1.0}}, 0.0, 2.9).active);  // D_obs = 3
  EXPECT_TRUE(avoided({{{5.0, 0.0}, 1.0}}, 0.0, 3.1).active);
}

TEST(Obstacles, BehindTheVehicleTheyDoNotMatter) {
  EXPECT_FALSE(avoided({{{-3.0, 0.0}, 1.0}}).active);
}

TEST(Obstacles, StartingInsideTheHeadingLeadsOutAndNotFurtherIn) {
  const auto a = avoided({{{1.5, 0.0}, 1.0}});  // inflated radius 2 > 1.5
  EXPECT_NEAR(std::abs(a.psi_rad), pi<double>() / 2.0 + 0.2, 1e-9);
  EXPECT_EQ(a.speed_share, 0.0);  // the vehicle heads into the obstacle
  EXPECT_EQ(avoided({{{-1.5, 0.0}, 1.0}}).speed_share, 1.0);
}

TEST(Obstacles, OnTheVeryCentreItTurnsAway) {
  const auto a = avoided({{{0.0, 0.0}, 1.0}});
  EXPECT_TRUE(std::isfinite(a.psi_rad));
  EXPECT_TRUE(a.active);
}

TEST(Obstacles, ARingAroundTheVehicleBlocksEveryDirection) {
  std::vector<O> ring;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * pi<double>() / 4.0;
    ring.push_back({{4.0 * std::cos(angle), 4.0 * std::sin(angle)}, 1.0});
  }
  const auto a = avoided(ring);
  EXPECT_TRUE(a.blocked);
  EXPECT_EQ(a.speed_share, 0.0);
}

TEST(Obstacles, TheSpeedFallsWithTheFreeWayAhead) {
  // The circle for braking has the radius 1 + 0.5 + 0.25 = 1.75 m (disc, vehicle, half the
  // clearance). The free distance is 3.0 - 1.75 = 1.25 m, and brake_m is 2 m.
  EXPECT_NEAR(avoided({{{3.0, 0.0}, 1.0}}).speed_share, 0.625, 1e-12);
}

TEST(Obstacles, OneOnTheWaypointCoversIt) {
  EXPECT_TRUE(covers(kAvoidance, O{{0.0, 0.0}, 1.0}, {0.5, 0.0}, 1.0));
  EXPECT_FALSE(covers(kAvoidance, O{{0.0, 0.0}, 1.0}, {1.5, 0.0}, 1.0));
}

TEST(Obstacles, MixNoDoubleIntoTheirScalar) {
  using S = Strict;
  const Avoidance<S> avoidance{S(4.0), S(1.0), S(0.2), S(0.5), S(0.5), S(0.5), S(0.2), S(2.0)};
  const Obstacle<S> obstacle{{S(5.0), S(0.0)}, S(1.0)};
  AvoidanceState state;
  Sector<S> sector{};
  EXPECT_TRUE(avoid(avoidance, &obstacle, &sector, 1, {S(0.0), S(0.0)}, S(0.0), S(1.0), S(0.0),
                    S(1e9), state)
                  .active);
}

}  // namespace
}  // namespace awmr::testing
