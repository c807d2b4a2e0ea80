/// Every command with a vehicle without steering: its only mode is used, the others are refused by
/// name.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace awmr::testing::differential_test {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kHalfTrack_m = 0.25;
constexpr const char* kVehicle = R"({
  "schema": "awmr.vehicle/1", "name": "rover", "drive": "differential", "mass_kg": 20,
  "length_m": 0.6, "width_m": 0.5, "half_track_m": 0.25, "wheel_force": {"min": -1, "max": 1},
  "sample_time_s": 0.01, "sway_alpha": 4})";

/// Value with an error of 1 % whose sign alternates from row to row.
double with_error(double value, int row) { return value * (row % 2 == 0 ? 1.01 : 0.99); }

/// Table of surge runs of a rover with a1 = 1.2, b1 = 0.7, a3 = 0.4, b3 = 0.9, m' = 0.5.
std::string surge_text() {
  std::string text = "tau_speed,speed_mps\n";
  for (int i = 1; i <= 10; ++i) {
    text += fmt::format("{},{}\n", 0.2 * i, with_error(std::pow(0.2 * i / 1.2, 1.0 / 0.7), i));
  }
  return text;
}

/// Table of turns to the left and to the right, some on the spot, some about the wheels of one
/// side.
std::string turning_text() {
  std::string text = "force_left,force_right,yaw_rate_radps\n";
  for (int i = 1; i <= 8; ++i) {
    const double side = i % 3 == 0 ? -1.0 : 1.0;
    const double left = i % 4 == 0 ? 0.0 : -0.05 * i;
    const double right = 0.05 * i;
    const double tau = 2.0 * kHalfTrack_m * (right - left);  // 2 d (F'R - F'L)
    text += fmt::format("{},{},{}\n", side * left, side * right,
                        side * with_error(std::pow(tau / 0.4, 1.0 / 0.9), i));
  }
  return text;
}

std::string coastdown_text() {
  std::string text = "initial_speed_mps,stop_time_s\n";
  for (const double u : {0.8, 1.2, 1.6}) {
    text += fmt::format("{},{:.5f}\n", u, 0.5 * std::pow(u, 0.3) / (0.3 * 1.2));
  }
  return text;
}

class DifferentialDrive : public ::testing::Test {
 protected:
  DifferentialDrive() {
    write_all(path("vehicle.json"), kVehicle);
    write_all(path("surge.csv"), surge_text());
    write_all(path("turning.csv"), turning_text());
    write_all(path("coastdown.csv"), coastdown_text());
    write_all(
        path("tune.json"),
        R"({"global_evaluations": 20, "local_evaluations": 10, "draws": 4, "judged_draws": 4})");
    write_all(path("gains.json"), R"({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                                      "speed": {"mu": 5, "epsilon": 1.2}})");
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  ProcessResult identify(const std::string& more = "") {
    return awmr(fmt::format("identify --vehicle {} --surge {} --turning {} --coastdown {} -o {} {}",
                            path("vehicle.json"), path("surge.csv"), path("turning.csv"),
                            path("coastdown.csv"), path("model.json"), more));
  }
  ProcessResult with_model(const std::string& command) {
    return awmr(command + " --model " + path("model.json"));
  }
  TemporaryDirectory directory_;
};

TEST_F(DifferentialDrive, IsIdentified) {
  const ProcessResult result = identify();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, Not(HasSubstr("steering")));
  const ordered_json model = ordered_json::parse(read_all(path("model.json")));
  // Tolerance: each of the ten rows has an error of 1 %.
  EXPECT_NEAR(model["yaw"]["alpha"]["value"].get<double>(), 0.4, 0.01);
  EXPECT_NEAR(model["yaw"]["beta"]["value"].get<double>(), 0.9, 0.02);
  EXPECT_NEAR(model["mass_norm"]["value"].get<double>(), 0.5, 0.05);
  EXPECT_TRUE(model["steering"]["time_constant_s"]["value"].is_null());
  EXPECT_EQ(model["steering"]["time_constant_s"]["method"], "no steering");
  EXPECT_EQ(model["vehicle"]["drive"], "differential");
  for (const auto& finding : model["findings"]) EXPECT_NE(finding["code"], "not-identifiable");
}

TEST_F(DifferentialDrive, HasNoServoParameter) {
  const ProcessResult result = identify("--fit steering.time_constant_s");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--fit"), HasSubstr("differential")));
}

TEST_F(DifferentialDrive, RunsEveryCommandInItsMode) {
  ASSERT_EQ(identify().exit_code, 0);
  const std::string gains = " --gains " + path("gains.json");
  const std::string scenario = " --scenario configs/paper/scenarios/c3_heading_steps.json";
  for (const std::string& command :
       {"tune --config " + path("tune.json") + " -o " + path("tuned.json"),
        "simulate --mode differential" + gains + scenario + " -o " + path("run.csv"),
        "validate" + gains + " -o " + path("validation.json"),
        "compare --samples 3" + gains + scenario + " -o " + path("comparison"),
        "emit" + gains + " -o " + path("firmware"),
        "suggest --mode differential" + gains + scenario + " -o " + path("suggest.json"),
        "recover --runs 10 -o " + path("recover.json"),
        "recover --plan log --duration 20 --runs 2 -o " + path("recover_log.json")}) {
    const ProcessResult result = with_model(command);
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.out << result.err;
  }
  const std::string rows = read_all(path("comparison/comparison.csv"));
  EXPECT_THAT(rows, AllOf(HasSubstr(",differential,"), Not(HasSubstr(",steering,")),
                          Not(HasSubstr(",combined,"))));
  const std::string header = read_all(path("firmware/awmr_params.h"));
  EXPECT_THAT(header, HasSubstr("#define AWMR_STEERING_MAX_RAD 0.0f"));
  EXPECT_THAT(read_all(path("validation.json")), HasSubstr("this vehicle has one"));
}

TEST_F(DifferentialDrive, RefusesTheModesThatSteer) {
  ASSERT_EQ(identify().exit_code, 0);
  const std::string loop = " --gains " + path("gains.json") +
                           " --scenario configs/paper/scenarios/c3_heading_steps.json -o " +
                           path("out");
  for (const std::string command : {"simulate", "suggest"}) {
    for (const std::string mode : {"steering", "combined"}) {
      const ProcessResult result = with_model(command + " --mode " + mode + loop);
      EXPECT_EQ(result.exit_code, 2) << command << mode;
      EXPECT_THAT(result.err, AllOf(HasSubstr("--mode"), HasSubstr("no steering"),
                                    HasSubstr("give mode differential")));
      EXPECT_FALSE(std::filesystem::exists(path("out")));
    }
  }
}

TEST_F(DifferentialDrive, RefusesATurningTableOfASteeredVehicle) {
  write_all(path("turning.csv"), "steering_deg,wheel_force,yaw_rate_radps\n5,0.35,0.1\n");
  const ProcessResult result = identify();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("force_left"));
}

TEST_F(DifferentialDrive, RefusesForcesOfSidesInPercent) {
  write_all(path("turning.csv"),
            "force_left,force_right,yaw_rate_radps\n-10,10,0.1\n-20,20,0.21\n-40,40,0.5\n");
  const ProcessResult result = identify();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("percent"), HasSubstr("force_left="),
                                HasSubstr("force_right="), HasSubstr("--as-is")));
}

/// Alternating thrust and turns of the same rover, by Euler steps of 1 ms.
std::string log_text(const std::string& header, double steering_deg) {
  std::string text = header + "\n";
  double u = 0.0;
  double r = 0.0;
  const double inertia_norm = 0.5 * (0.6 * 0.6 + 0.5 * 0.5) / 12.0;
  for (int i = 0; i < 1500; ++i) {
    const int level = i / 75;
    const double mean = 0.1 + 0.08 * (level * 7 % 5);
    const double apart = 0.06 * (level * 3 % 5 - 2);
    const double left = mean - apart;
    const double right = mean + apart;
    text += fmt::format("{:.2f},{},{},{:.5f},{:.5f}", 0.02 * i, left, right,
                        u + 0.004 * ((i * 37) % 11 - 5), r + 0.004 * ((i * 53) % 13 - 6));
    text += steering_deg != 0.0 ? fmt::format(",{}\n", steering_deg) : "\n";
    for (int n = 0; n < 20; ++n) {
      u += 0.001 * (2.0 * (left + right) - 1.2 * std::pow(std::max(u, 1e-6), 0.7)) / 0.5;
      const double g3 = 0.4 * std::pow(std::abs(r) + 1e-12, 0.9) * (r < 0.0 ? -1.0 : 1.0);
      r += 0.001 * (2.0 * kHalfTrack_m * (right - left) - g3) / inertia_norm;
    }
  }
  return text;
}

TEST_F(DifferentialDrive, IsIdentifiedFromALogWithoutSteeringColumns) {
  write_all(path("log.csv"), log_text("t_s,force_left,force_right,speed_mps,yaw_rate_radps", 0.0));
  const std::string command = fmt::format(
      "identify --vehicle {} --log {} --family power --fit "
      "surge.alpha,surge.beta,yaw.alpha,yaw.beta,"
      "mass_norm,inertia_norm -o {}",
      path("vehicle.json"), path("log.csv"), path("model.json"));
  const ProcessResult result = awmr(command);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ordered_json model = ordered_json::parse(read_all(path("model.json")));
  // Tolerance: the generator omits sway, which changes the result by at most a few per cent at
  // these yaw rates.
  EXPECT_NEAR(model["surge"]["alpha"]["value"].get<double>(), 1.2, 0.06);
  EXPECT_NEAR(model["yaw"]["alpha"]["value"].get<double>(), 0.4, 0.02);
  EXPECT_NEAR(model["mass_norm"]["value"].get<double>(), 0.5, 0.03);
}

TEST_F(DifferentialDrive, RefusesALogThatSteers) {
  write_all(path("log.csv"),
            log_text("t_s,force_left,force_right,speed_mps,yaw_rate_radps,steering_deg", 5.0));
  const ProcessResult result =
      awmr(fmt::format("identify --vehicle {} --log {} -o {}", path("vehicle.json"),
                       path("log.csv"), path("model.json")));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("steering_deg=0"), HasSubstr("no steering")));
}

}  // namespace
}  // namespace awmr::testing::differential_test
