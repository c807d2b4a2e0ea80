/// The recorder of the sketch RecordTrials, run on this machine: its tables identify the simulated
/// vehicle.
#include <awmr_trials.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "awmr/identify/identify.h"
#include "awmr/trials/load.h"
#include "support/paper_vehicle.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using namespace awmr_trials;

/// Simulated rover, relative to its motors ten times as heavy as the paper's robot, because that
/// robot comes to rest between two GPS fixes:
///   m' du/dt = 2 F' (1 + cos d) - a1 u^b1,   I'z dr/dt = 2 F' l_f sin d - a3 r^b3
struct Rover {
  double a1 = 1.3157, b1 = 0.8841, a3 = 0.3028, b3 = 0.8250, mass = 1.0, inertia = 0.15;
  double front_axle_m = paper_vehicle().front_axle_m;
  double u = 0.0, r = 0.0;

  void move(double force, double steering_rad, double dt_s) {
    const double drag = a1 * std::pow(u, b1);
    const double resistance = std::copysign(a3 * std::pow(std::abs(r), b3), r);
    const double thrust = 2.0 * force * (1.0 + std::cos(steering_rad));
    const double moment = 2.0 * force * front_axle_m * std::sin(steering_rad);
    u = std::max(0.0, u + dt_s * (thrust - drag) / mass);
    r += dt_s * (moment - resistance) / inertia;
  }
};

/// Inputs of the recorder: a step every 10 ms, a fix every 100 ms.
struct Drive {
  Recorder recorder;
  Rover rover = {};
  std::uint32_t now_ms = 1000;
  float speed_mps = 0.0F;
  std::uint32_t speed_ms = 0;

  Event step(bool is_held) {
    for (int i = 0; i < 100; ++i) {
      rover.move(recorder.force(), recorder.steering_rad(), 1e-4);
    }
    now_ms += 10;
    if (now_ms % 100 == 0) {
      speed_mps = static_cast<float>(rover.u);
      speed_ms = now_ms;
    }
    return recorder.step({now_ms, speed_mps, speed_ms, static_cast<float>(rover.r), is_held});
  }
  /// Runs to the next event; a minute without one is an error of the test.
  Event until_event(bool is_held = true) {
    for (int i = 0; i < 6000; ++i) {
      const Event event = step(is_held);
      if (event != kNothing) return event;
    }
    return kNothing;
  }
};

/// Settling time of a run: eight time constants m'/a1, after which e^-8 = 3e-4 of the speed is
/// missing.
constexpr Settings kSettings = {8.0F, 3.0F, 15.0F, 0.05F, 0.05F};

TEST(TrialRecorder, ItsTablesGiveBackTheVehicle) {
  std::vector<Trial> runs;
  for (const float force : {0.15F, 0.25F, 0.35F, 0.45F, 0.5F})
    runs.push_back({kSurge, force, 0.0F});
  for (const float angle : {0.1F, 0.15F, 0.2F, 0.25F, 0.3F})
    runs.push_back({kTurning, 0.3F, angle});
  for (const float force : {0.3F, 0.4F, 0.5F}) runs.push_back({kCoastdown, force, 0.0F});
  std::string surge = "wheel_force,speed_mps\n";
  std::string turning = "steering_deg,wheel_force,yaw_rate_radps\n";
  std::string coastdown = "run,t_s,speed_mps\n";
  Drive drive{Recorder(runs.data(), static_cast<std::uint8_t>(runs.size()), kSettings)};
  while (drive.recorder.state() != kDone) {
    drive.recorder.go();
    const std::uint8_t number = drive.recorder.number();
    const Event event = drive.until_event();
    const Row& row = drive.recorder.row();
    if (event == kCurveRow) {
      coastdown += fmt::format("{},{:.4f},{:.4f}\n", number, row.t_s, row.value);
    } else if (event == kRow && runs[number].kind == kSurge) {
      surge += fmt::format("{:.4f},{:.4f}\n", row.force, row.value);
    } else if (event == kRow) {
      turning += fmt::format("{:.4f},{:.4f},{:.4f}\n", row.steering_rad * 57.2957795F, row.force,
                             row.value);
    } else {
      ASSERT_EQ(event, kCoasted);
    }
  }

  const TemporaryDirectory directory;
  const auto path = [&](const char* name) { return directory.path() / name; };
  write_all(path("surge.csv"), surge);
  write_all(path("turning.csv"), turning);
  write_all(path("coastdown.csv"), coastdown);
  const auto trials = load_trials(paper_vehicle(), {.surge = path("surge.csv"),
                                                    .turning = path("turning.csv"),
                                                    .coastdowns = {path("coastdown.csv")}});
  ASSERT_TRUE(trials) << to_text(trials.error());
  const auto found = identify(*trials, {});
  ASSERT_TRUE(found) << to_text(found.error());
  const auto value = [&](ParameterId id) { return found->model[id].value.value_or(NAN); };
  // Cells have four decimals: a step of 1e-4 m/s is 2.5e-4 of the smallest speed, 0.4 m/s. The
  // error of the exponent is this number divided by the logarithm of the range of speeds, about
  // 1.3.
  const Rover truth;
  EXPECT_NEAR(value(ParameterId::kSurgeAlpha), truth.a1, 5e-4 * truth.a1);
  EXPECT_NEAR(value(ParameterId::kSurgeBeta), truth.b1, 1e-3);
  EXPECT_NEAR(value(ParameterId::kYawAlpha), truth.a3, 2e-3 * truth.a3);
  EXPECT_NEAR(value(ParameterId::kYawBeta), truth.b3, 5e-3);
  // Tolerance: a fix is up to 10 ms (one step) older than its row states; a coast-down takes over a
  // second.
  EXPECT_NEAR(value(ParameterId::kMassNorm), truth.mass, 0.03 * truth.mass);
}

TEST(TrialRecorder, StopsIfTheCommandsEndAndWaitsAgain) {
  const Trial runs[] = {{kSurge, 0.5F, 0.0F}, {kTurning, 0.5F, 0.2F}};
  Drive drive{Recorder(runs, 2, kSettings)};
  EXPECT_EQ(drive.recorder.force(), 0.0F);
  EXPECT_EQ(drive.until_event(), kNothing);  // the recorder waits for go()
  drive.recorder.go();
  for (int i = 0; i < 900; ++i) EXPECT_EQ(drive.step(true), kNothing);
  EXPECT_EQ(drive.recorder.force(), 0.5F);
  EXPECT_EQ(drive.step(false), kLetGo);
  EXPECT_EQ(drive.recorder.force(), 0.0F);
  EXPECT_EQ(drive.recorder.number(), 0);
  EXPECT_EQ(drive.until_event(), kNothing);
  drive.recorder.go();
  EXPECT_EQ(drive.until_event(), kRow);
  EXPECT_EQ(drive.recorder.number(), 1);
  drive.recorder.skip();
  EXPECT_EQ(drive.recorder.state(), kDone);
  EXPECT_EQ(drive.until_event(), kNothing);
  EXPECT_EQ(drive.recorder.force(), 0.0F);
}

TEST(TrialRecorder, ARunThatIsNotSteadyOrWithoutFixesGivesNoRow) {
  const Trial runs[] = {{kSurge, 0.5F, 0.0F}};
  Drive slow{Recorder(runs, 1, {0.0F, 0.2F, 15.0F, 0.05F, 0.05F})};  // three fixes are too few
  slow.recorder.go();
  EXPECT_EQ(slow.until_event(), kNotSteady);
  Drive heavy{Recorder(runs, 1, {0.1F, 2.0F, 15.0F, 0.05F, 0.05F})};
  heavy.rover.mass = 5.0;  // still accelerates within the window
  heavy.recorder.go();
  EXPECT_EQ(heavy.until_event(), kNotSteady);
  EXPECT_EQ(heavy.recorder.state(), kWaiting);
}

TEST(TrialRecorder, ACoastDownHasEnoughRowsWithoutCommands) {
  const Trial runs[] = {{kCoastdown, 0.2F, 0.0F}};
  Drive drive{Recorder(runs, 1, kSettings)};
  drive.recorder.go();
  EXPECT_EQ(drive.until_event(), kCurveRow);
  EXPECT_EQ(drive.recorder.force(), 0.0F);
  int rows = 1;
  while (drive.until_event(false) == kCurveRow) ++rows;
  EXPECT_GE(rows, 8);
  EXPECT_EQ(drive.recorder.state(), kDone);
}

}  // namespace
}  // namespace awmr::testing
