#include <gmock/gmock.h>

#include "awmr/core/units.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/scenario_file.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

const std::string kHeading = R"({
  "name": "two headings", "duration_s": 4,
  "initial": {"x_m": 1, "y_m": 2, "psi_deg": 90, "u_mps": 0, "v_mps": 0, "r_degps": 10},
  "speed_mps": 1,
  "guidance": {"type": "heading", "steps": [{"t_s": 0, "psi_deg": 30}, {"t_s": 2, "psi_deg": -30}]}
})";

Result<Scenario> read(const std::string& text) {
  const TemporaryDirectory directory;
  write_all(directory.path() / "s.json", text);
  return read_scenario(directory.path() / "s.json");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ScenarioFile, ReadsHeadingStepsInRadians) {
  const auto scenario = read(kHeading);
  ASSERT_TRUE(scenario) << to_text(scenario.error());
  EXPECT_EQ(scenario->initial.psi_rad, radians(90.0));
  EXPECT_EQ(scenario->initial.r_radps, radians(10.0));
  const auto& steps = std::get<HeadingSteps>(scenario->guidance).steps;
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[1].t_s, 2.0);
  EXPECT_EQ(steps[1].psi_rad, radians(-30.0));
}

TEST(ScenarioFile, ReportsAnInvalidListOnce) {
  for (const auto& steps : {"3", "[3]"}) {
    const auto scenario = read(replaced(
        kHeading, "[{\"t_s\": 0, \"psi_deg\": 30}, {\"t_s\": 2, \"psi_deg\": -30}]", steps));
    ASSERT_FALSE(scenario);
    for (const Fault& fault : scenario.error().faults) {
      EXPECT_NE(fault.code, ErrorCode::kWrongOrder) << to_text(scenario.error());
    }
  }
  const auto none = read(
      replaced(kHeading, "[{\"t_s\": 0, \"psi_deg\": 30}, {\"t_s\": 2, \"psi_deg\": -30}]", "[]"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().faults.front().code, ErrorCode::kWrongOrder);
}

TEST(ScenarioFile, EveryShippedScenarioReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(AWMR_SOURCE_DIR) +
                                                               "/configs/paper/scenarios")) {
    const auto scenario = read_scenario(entry.path());
    EXPECT_TRUE(scenario) << (scenario ? "" : to_text(scenario.error()));
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(YawModeNames, ConvertInBothDirections) {
  for (const YawMode mode : kYawModes) EXPECT_EQ(value_in(kYawModeNames, name_of(mode)), mode);
  EXPECT_FALSE(value_in(kYawModeNames, "sideways"));
}

std::string with_tyres(const std::string& rest) {
  return R"({"name": "on tyres", "duration_s": 4, "speed_mps": 1,
    "initial": {"x_m": 0, "y_m": 0, "psi_deg": 0, "u_mps": 0, "v_mps": 0, "r_degps": 0},
    "guidance": {"type": "heading", "steps": [{"t_s": 0, "psi_deg": 30}]}, )" +
         rest + "}";
}

TEST(ScenarioFile, TyresHaveDefaultsAndAreOffWithoutTheirKey) {
  const auto none = read(with_tyres(R"("seed": 1)"));
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->tyres);
  const auto usual = read(with_tyres(R"("tyres": {})"));
  ASSERT_TRUE(usual);
  EXPECT_EQ(plant_text(*usual),
            "four-wheel, friction 0.8, cornering stiffness 10 per rad, rest speed 0.1 m/s");
  const auto given = read(with_tyres(
      R"("tyres": {"friction": 0.3, "cornering_stiffness_per_rad": 5, "rest_speed_mps": 0.2})"));
  ASSERT_TRUE(given);
  EXPECT_EQ(given->tyres->friction, 0.3);
  EXPECT_EQ(given->tyres->cornering_per_rad, 5.0);
  EXPECT_EQ(given->tyres->rest_speed_mps, 0.2);
}

TEST(ScenarioFile, RefusesKeysThatDoNotApplyOnTyres) {
  const auto refused = read(with_tyres(
      R"("tyres": {}, "slippery": [{"x_m": 1, "y_m": 2, "radius_m": 3, "force_max": 0.1}],
         "corner": {"sway.alpha": "hi", "mass_norm": "lo"})"));
  ASSERT_FALSE(refused);
  const std::string text = to_text(refused.error());
  EXPECT_NE(text.find(":/slippery: a patch limits only the longitudinal forces"), std::string::npos)
      << text;
  EXPECT_NE(text.find(":/corner: sway.alpha has no effect on tyres"), std::string::npos) << text;
  EXPECT_EQ(text.find("mass_norm"), std::string::npos);
}

const std::string kFull = R"({
  "name": "everything", "duration_s": 4,
  "initial": {"x_m": 0, "y_m": 0, "psi_deg": 0, "u_mps": 0, "v_mps": 0, "r_degps": 0},
  "speed_mps": 1,
  "guidance": {"type": "waypoints", "points_m": [[1, 2], [3, 4]], "acceptance_m": 0.5,
               "skip_passed": true, "slow_down_m": 2},
  "obstacles": [{"x_m": 5, "y_m": 6, "radius_m": 0.5}],
  "avoidance": {"mmd_base_m": 6, "mmd_per_speed_s": 1, "sigma_deg": 10, "vehicle_radius_m": 0.8,
                "clearance_m": 0.5, "hysteresis_m": 0.5, "side_hysteresis_deg": 10, "brake_m": 1.5},
  "shaping": {"omega_radps": 4, "rate_max_degps": 60, "accel_max_degps2": 300},
  "disturbance": {"surge": [{"type": "constant", "value": 0.1, "from_s": 1, "to_s": 2}],
                  "sway": [{"type": "step", "t_s": 1, "value": 0.2}],
                  "yaw": [{"type": "sine", "amplitude": 0.3, "frequency_hz": 2, "phase_deg": 90},
                          {"type": "noise", "std": 0.4, "bandwidth_hz": 3}],
                  "slope": {"angle_deg": 5, "downhill_deg": 90}},
  "faults": [{"wheel": "left", "from_s": 1, "share": 0.5}],
  "slippery": [{"x_m": 1, "y_m": 2, "radius_m": 3, "force_max": 0.1}],
  "battery": {"from_s": 0, "to_s": 3, "share_end": 0.5},
  "sensors": {"heading_deg": {"noise": 1, "bias": 2, "quantum": 0.1},
              "yaw_rate_degps": {"noise": 0.3}, "speed_mps": {"bias": 0.1}, "sway_measured": false, "speed_signed": false,
              "gps": {"rate_hz": 10, "latency_s": 0.1, "noise_m": 0.05, "quantum_m": 0.01,
                      "dropouts": [{"from_s": 1, "to_s": 2}]}},
  "estimator": "none",
  "actuators": {"servo": {"us_per_deg": 10, "step_us": 4}, "pwm_counts": 255},
  "control": {"combined_split": "fixed_half", "allocation": "paper",
              "heading_law": {"type": "lqi", "heading_deg": 5, "yaw_rate_degps": 20,
                              "integral_deg_s": 30, "tau_turn_m": 0.02},
              "disturbance_observer": {"bandwidth_radps": 5, "yaw_max_m": 0.1, "surge_max": 0.2,
                                       "anti_windup": true}},
  "corner": {"mass_norm": "hi", "surge.alpha": "lo"},
  "seed": 7
})";

TEST(ScenarioFile, ReadsTheWholeWorldInSiUnits) {
  const auto s = read(kFull);
  ASSERT_TRUE(s) << to_text(s.error());
  const auto& path = std::get<WaypointPath>(s->guidance);
  EXPECT_EQ(path.points_m[1].y_m, 4.0);
  EXPECT_TRUE(path.skip_passed);
  EXPECT_EQ(path.slow_down_m, 2.0);
  EXPECT_EQ(s->avoidance->sigma_rad, radians(10.0));
  EXPECT_EQ(s->shaping->accel_max_radps2, radians(300.0));
  EXPECT_EQ(s->disturbance.surge[0].window.to_s, 2.0);
  EXPECT_EQ(s->disturbance.sway[0].window.from_s, 1.0);
  EXPECT_EQ(s->disturbance.yaw[0].phase_rad, radians(90.0));
  EXPECT_EQ(s->disturbance.yaw[1].kind, DisturbanceTerm::Kind::kNoise);
  EXPECT_EQ(s->disturbance.slope->downhill_rad, radians(90.0));
  EXPECT_EQ(s->faults[0].wheels.size(), 2U);
  EXPECT_EQ(s->patches[0].force_max, 0.1);
  EXPECT_EQ(s->battery->share_end, 0.5);
  EXPECT_EQ(s->sensors->heading.bias, radians(2.0));
  EXPECT_FALSE(s->sensors->sway_measured);
  EXPECT_FALSE(s->sensors->speed_signed);
  EXPECT_EQ(s->sensors->gps->y.quantum, 0.01);
  EXPECT_EQ(s->estimator, PositionMethod::kNone);
  EXPECT_NEAR(s->actuators->steering_quantum_rad, radians(0.4), 1e-15);
  EXPECT_EQ(s->control.split, CombinedSplit::kFixedHalf);
  EXPECT_EQ(s->control.allocation, AllocationForm::kPaper);
  EXPECT_TRUE(s->control.anti_windup);
  EXPECT_EQ(s->control.lqi->heading_rad, radians(5.0));
  EXPECT_EQ(s->control.lqi->yaw_rate_radps, radians(20.0));
  EXPECT_EQ(s->control.lqi->integral_rad_s, radians(30.0));
  EXPECT_EQ(s->control.lqi->tau_turn_m, 0.02);
  EXPECT_EQ(s->corner[0].id, ParameterId::kMassNorm);
  EXPECT_FALSE(s->corner[1].high);
  EXPECT_EQ(s->seed, 7U);
  EXPECT_TRUE(s->random());
}

TEST(ScenarioFile, ReadsLinesAndTimedPaths) {
  const std::string steps =
      "{\"type\": \"heading\", \"steps\": [{\"t_s\": 0, \"psi_deg\": 30}, "
      "{\"t_s\": 2, \"psi_deg\": -30}]}";
  const auto line = read(replaced(kHeading, steps,
                                  R"({"type": "line", "from_m": [0, 1], "to_m": [2, 3],
                                      "delta_deg": 45, "width_m": 2})"));
  ASSERT_TRUE(line) << to_text(line.error());
  EXPECT_EQ(std::get<LinePath>(line->guidance).points_m[1].y_m, 3.0);
  EXPECT_TRUE(
      std::get<LineOfSight<double>>(std::get<LinePath>(line->guidance).law).sideslip_compensation);
  const auto integral = read(replaced(kHeading, steps,
                                      R"({"type": "line", "from_m": [0, 1], "to_m": [2, 3],
                                          "law": "ilos", "lookahead_m": 3,
                                          "integral_gain_mps": 0.4, "corner_m": 1})"));
  ASSERT_TRUE(integral) << to_text(integral.error());
  const auto& ilos = std::get<IntegralLos<double>>(std::get<LinePath>(integral->guidance).law);
  EXPECT_EQ(ilos.lookahead_m, 3.0);
  EXPECT_EQ(ilos.integral_gain_mps, 0.4);
  EXPECT_EQ(std::get<LinePath>(integral->guidance).corner_m, 1.0);
  const auto pursued = read(replaced(kHeading, steps,
                                     R"({"type": "line", "from_m": [0, 1], "to_m": [2, 3],
                                         "law": "pure_pursuit", "lookahead_m": 3,
                                         "sideslip_compensation": false})"));
  ASSERT_TRUE(pursued) << to_text(pursued.error());
  const auto& law = std::get<PurePursuit<double>>(std::get<LinePath>(pursued->guidance).law);
  EXPECT_EQ(law.lookahead_m, 3.0);
  EXPECT_FALSE(law.sideslip_compensation);
  const std::string timed = R"({"type": "lissajous", "amplitude_m": [1, 2],
                                "rate_radps": [0.1, 0.2], "closed_loop": true})";
  const auto closed =
      read(replaced(replaced(kHeading, steps, timed), "\"speed_mps\": 1", "\"speed_mps\": 0"));
  ASSERT_TRUE(closed) << to_text(closed.error());
  EXPECT_EQ(std::get<LissajousPath>(closed->guidance).path.rate_y_radps, 0.2);
  // The speed on a closed timed path follows from the path, so speed_mps is refused.
  EXPECT_THAT(to_text(read(replaced(kHeading, steps, timed)).error()), HasSubstr("/speed_mps"));
}

}  // namespace
}  // namespace awmr::testing
