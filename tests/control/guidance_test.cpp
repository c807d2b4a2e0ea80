/// Waypoints, lines, timed paths and reference shaping.
#include "awmr/control/guidance/waypoints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "awmr/control/guidance/heading_shaping.h"
#include "awmr/control/guidance/line_laws.h"
#include "awmr/control/guidance/timed_path.h"
#include "support/strict_scalar.h"

namespace awmr::testing {
namespace {

using P = Position<double>;
constexpr double kPi = pi<double>();

TEST(Waypoints, TheLineOfSightPointsFromTheVehicleToThePoint) {
  // The heading from (80, 0) to (90, 20) is atan2(20, 10) = 1.1071 rad. Equation (103) as printed
  // gives the opposite direction.
  const P points[] = {{90.0, 20.0}};
  auto progress = start_waypoints(P{80.0, 0.0}, 0.0);
  const auto guided = guide(Waypoints<double>{points, 1, 1.0, false}, {80.0, 0.0}, progress);
  EXPECT_NEAR(guided.psi_rad, std::atan2(20.0, 10.0), 1e-15);
  EXPECT_FALSE(guided.finished);
}

TEST(Waypoints, TheNextOneFollowsInsideTheAcceptanceRadius) {
  const P points[] = {{10.0, 0.0}, {10.0, 10.0}};
  const Waypoints<double> waypoints{points, 2, 1.0, false};
  auto progress = start_waypoints(P{0.0, 0.0}, 0.0);
  guide(waypoints, {8.9, 0.0}, progress);
  EXPECT_EQ(progress.next, 0);
  guide(waypoints, {9.0, 0.0}, progress);
  EXPECT_EQ(progress.next, 1);
}

TEST(Waypoints, PointsThatCoincideAreReachedInOneStep) {
  const P points[] = {{1.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}};
  auto progress = start_waypoints(P{0.0, 0.0}, 0.3);
  const auto guided = guide(Waypoints<double>{points, 3, 0.5, true}, {0.9, 0.0}, progress);
  EXPECT_TRUE(guided.finished);
  EXPECT_EQ(guided.psi_rad, 0.3);
  EXPECT_EQ(progress.missed, 0);
}

TEST(Waypoints, WithNoneTheHeadingIsHeld) {
  auto progress = start_waypoints(P{0.0, 0.0}, 0.7);
  const auto guided = guide(Waypoints<double>{nullptr, 0, 0.5, false}, {0.0, 0.0}, progress);
  EXPECT_TRUE(guided.finished);
  EXPECT_EQ(guided.psi_rad, 0.7);
}

TEST(Waypoints, AfterTheLastTheLineOfSightIsHeld) {
  const P points[] = {{1.0, 1.0}};
  const Waypoints<double> waypoints{points, 1, 0.1, false};
  auto progress = start_waypoints(P{0.0, 0.0}, 0.0);
  guide(waypoints, {0.0, 0.0}, progress);
  const auto guided = guide(waypoints, {1.0, 1.0}, progress);
  EXPECT_TRUE(guided.finished);
  EXPECT_NEAR(guided.psi_rad, kPi / 4.0, 1e-15);
}

TEST(Waypoints, APassedOneIsTurnedBackToOrMissed) {
  const P points[] = {{10.0, 0.0}, {20.0, 0.0}};
  auto back = start_waypoints(P{0.0, 0.0}, 0.0);
  auto on = back;
  const P beyond{10.5, 3.0};  // 3.04 m from the waypoint, past the perpendicular at x = 10
  const auto turned = guide(Waypoints<double>{points, 2, 1.0, false}, beyond, back);
  EXPECT_EQ(back.next, 0);
  EXPECT_NEAR(turned.psi_rad, std::atan2(-3.0, -0.5), 1e-15);
  const auto skipped = guide(Waypoints<double>{points, 2, 1.0, true}, beyond, on);
  EXPECT_EQ(on.next, 1);
  EXPECT_EQ(on.missed, 1);
  EXPECT_NEAR(skipped.psi_rad, std::atan2(-3.0, 9.5), 1e-15);
}

using LosLine = Polyline<double, LineOfSight<double>>;
constexpr LineMotion<double> kStraight{0.0, 1.0, 0.01};

/// Returns psi_d at a signed distance from a line with the direction 0.2 rad.
double heading_beside(const LineOfSight<double>& law, double cross_track_m, double sideslip_rad) {
  const double t[] = {std::cos(0.2), std::sin(0.2)};
  const P points[] = {{0, 0}, {100.0 * t[0], 100.0 * t[1]}};
  const P at{50.0 * t[0] - cross_track_m * t[1], 50.0 * t[1] + cross_track_m * t[0]};
  auto progress = start_polyline(0.0);
  return guide(LosLine{points, 2, 0.0, law}, at, {sideslip_rad, 1.0, 0.01}, progress).psi_rad;
}

TEST(Line, FarFromItTheLaneIsApproachedAtDelta) {
  const LineOfSight<double> law{kPi / 3.0, 2.0, true};
  EXPECT_NEAR(heading_beside(law, 50.0, 0.0), 0.2 - kPi / 3.0, 1e-14);
  EXPECT_NEAR(heading_beside(law, -50.0, 0.0), 0.2 + kPi / 3.0, 1e-14);
  EXPECT_NEAR(heading_beside(law, 1.0, 0.0), 0.2 - kPi / 6.0, 1e-14);
}

TEST(Line, SideslipIsTakenOffOnlyWhereRequested) {
  EXPECT_NEAR(heading_beside({1.0, 2.0, true}, 0.0, 0.1), 0.1, 1e-14);
  EXPECT_NEAR(heading_beside({1.0, 2.0, false}, 0.0, 0.1), 0.2, 1e-14);
  EXPECT_EQ(sideslip_rad(0.0, 0.01), 0.0);  // at rest the course is undefined
  EXPECT_NEAR(sideslip_rad(1.0, 1.0), kPi / 4.0, 1e-15);
}

/// Signed distance from the line A to B, left positive.
double cross_track(P a, P b, P at) {
  const P points[] = {a, b};
  auto progress = start_polyline(0.0);
  return guide(LosLine{points, 2, 0.0, {1.0, 1.0, false}}, at, kStraight, progress).cross_track_m;
}

TEST(Line, VerticalLinesAreLinesToo) {
  EXPECT_NEAR(cross_track({0, 0}, {0, 10}, {-3, 5}), 3.0, 1e-15);  // upwards: left is -x
  EXPECT_NEAR(cross_track({0, 10}, {0, 0}, {-3, 5}), -3.0, 1e-15);
  EXPECT_NEAR(cross_track({0, 0}, {10, 0}, {5, 2}), 2.0, 1e-15);
}

TEST(Polyline, PassesOnAtTheEndOfASegmentAndFinishesAtTheLast) {
  const P points[] = {{0, 0}, {10, 0}, {10, 0}, {10, 10}};  // the second segment has length 0
  const LosLine line{points, 4, 1.0, {1.0, 1.0, false}};
  auto progress = start_polyline(0.0);
  EXPECT_NEAR(guide(line, {8.9, 0.0}, kStraight, progress).to_go_m, 1.1, 1e-12);
  EXPECT_EQ(progress.segment, 0);
  const auto turned = guide(line, {9.0, 0.0}, kStraight, progress);
  EXPECT_EQ(progress.segment, 2);
  EXPECT_NEAR(turned.cross_track_m, 1.0, 1e-15);
  EXPECT_NEAR(turned.psi_rad, kPi / 2.0 - 1.0, 1e-15);
  EXPECT_FALSE(guide(line, {10.0, 9.5}, kStraight, progress).finished);
  const auto at_end = guide(line, {10.2, 10.0}, kStraight, progress);
  EXPECT_TRUE(at_end.finished);
  EXPECT_EQ(at_end.to_go_m, 0.0);
}

TEST(Polyline, WithoutAnyLengthItIsFinishedAndTheHeadingHeld) {
  const P points[] = {{1, 1}, {1, 1}};
  auto progress = start_polyline(0.4);
  const auto guided = guide(LosLine{points, 2, 0.0, {1.0, 1.0, true}}, {0, 0}, kStraight, progress);
  EXPECT_TRUE(guided.finished);
  EXPECT_EQ(guided.psi_rad, 0.4);
}

constexpr Lissajous<double> kPaperPath{10.0, 10.0, 0.01, 0.03};

TEST(LissajousPath, DerivativesAreThoseOfThePosition) {
  // Compares with central differences with the step h, whose error, h^2/6 times the third
  // derivative, is below 1e-10 here.
  const double t = 37.0, h = 1e-3;
  const auto before = kPaperPath.at(t - h), at = kPaperPath.at(t), after = kPaperPath.at(t + h);
  EXPECT_NEAR(at.vx_mps, (after.position_m.x_m - before.position_m.x_m) / (2 * h), 1e-9);
  EXPECT_NEAR(at.vy_mps, (after.position_m.y_m - before.position_m.y_m) / (2 * h), 1e-9);
  EXPECT_NEAR(at.ax_mps2, (after.vx_mps - before.vx_mps) / (2 * h), 1e-9);
  EXPECT_NEAR(at.ay_mps2, (after.vy_mps - before.vy_mps) / (2 * h), 1e-9);
  const double rate =
      wrap_angle(open_path(after, 0.0).psi_rad - open_path(before, 0.0).psi_rad) / (2 * h);
  EXPECT_NEAR(open_path(at, 0.0).psi_rate_radps, rate, 1e-8);
}

TEST(LissajousPath, WhereItStandsStillTheHeadingIsHeld) {
  const Lissajous<double> point{0.0, 0.0, 1.0, 1.0};
  for (const PathGuidance<double>& held :
       {open_path(point.at(1.0), 0.9), closed_path(point.at(1.0), 0.5, {0.0, 0.0}, 0.0, 0.9),
        closed_path(point.at(1.0), 0.5, {1e-5, -1e-5}, 0.0, 0.9)}) {
    EXPECT_EQ(held.psi_rad, 0.9);
    EXPECT_EQ(held.psi_rate_radps, 0.0);
    EXPECT_EQ(held.speed_mps, 0.0);
  }
}

TEST(LissajousPath, OnThePathTheClosedFormIsTheOpenOne) {
  const auto path = kPaperPath.at(12.0);
  const auto open = open_path(path, 0.0);
  const auto closed = closed_path(path, 0.5, path.position_m, 0.0, 0.0);
  EXPECT_NEAR(closed.psi_rad, open.psi_rad, 1e-15);
  EXPECT_NEAR(closed.speed_mps, open.speed_mps, 1e-15);
}

TEST(LissajousPath, ClosedFormCatchesUpAndTurnsTowardsThePath) {
  const PathPoint<double> path{{0.0, 0.0}, 1.0, 0.0, 0.0, 0.0};
  EXPECT_NEAR(closed_path(path, 0.5, {-1.0, 0.0}, 0.0, 0.0).speed_mps, 1.5, 1e-15);
  EXPECT_NEAR(closed_path(path, 0.5, {9.0, 0.0}, 0.0, 0.0).speed_mps, 0.0, 1e-15);
  EXPECT_NEAR(closed_path(path, 0.5, {0.0, -2.0}, 0.0, 0.0).psi_rad, kPi / 4.0, 1e-15);
}

TEST(Shaping, ArrivesWithoutOvershootAndItsDerivativesAreItsOwn) {
  const HeadingShaping<double> filter{4.0, 1.0, 100.0};
  auto state = start_shaping(0.0);
  for (int i = 0; i < 1000; ++i) {
    const auto before = state;
    shape(filter, 1.0, 0.01, state);
    EXPECT_LE(state.psi_rad, 1.0 + 1e-12);
    EXPECT_LE(std::abs(state.psi_rate_radps), 1.0 + 1e-12);
    EXPECT_NEAR(state.psi_rate_radps, (state.psi_rad - before.psi_rad) / 0.01, 1e-9);
    EXPECT_NEAR(state.psi_accel_radps2, (state.psi_rate_radps - before.psi_rate_radps) / 0.01,
                1e-9);
  }
  EXPECT_NEAR(state.psi_rad, 1.0, 1e-9);
}

TEST(Shaping, GoesTheShortWayRound) {
  auto state = start_shaping(radians(170.0));
  for (int i = 0; i < 1000; ++i) {
    shape(HeadingShaping<double>{4.0, 1.0, 10.0}, radians(-170.0), 0.01, state);
  }
  EXPECT_NEAR(degrees(state.psi_rad), 190.0, 1e-6);
}

TEST(Guidance, MixesNoDoubleIntoItsScalar) {
  using S = Strict;
  const Position<S> points[] = {{S(1.0), S(2.0)}, {S(3.0), S(4.0)}};
  auto progress = start_waypoints(points[0], S(0.0));
  EXPECT_FALSE(guide(Waypoints<S>{points, 2, S(0.1), true}, points[0], progress).finished);
  auto along = start_polyline(S(0.0));
  const Polyline<S, LineOfSight<S>> line{points, 2, S(0.0), {S(1.0), S(1.0), true}};
  EXPECT_FALSE(
      guide(line, points[0], {sideslip_rad(S(1.0), S(0.1)), S(1.0), S(0.01)}, along).finished);
  const Lissajous<S> path{S(10.0), S(10.0), S(0.01), S(0.03)};
  const auto at = path.at(S(1.0));
  EXPECT_GT(closed_path(at, S(0.5), at.position_m, S(0.0), S(0.0)).speed_mps.value(), 0.0);
  auto shaped = start_shaping(S(0.0));
  shape(HeadingShaping<S>{S(1.0), S(1.0), S(1.0)}, S(1.0), S(0.01), shaped);
  EXPECT_GT(shaped.psi_rad.value(), 0.0);
}

}  // namespace
}  // namespace awmr::testing
