#include "awmr/model/vehicle_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "json_edit.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::filesystem::path kConfigs = AWMR_SOURCE_DIR "/configs/paper";

std::string paper_text() { return bytes_of(kConfigs / "vehicle.json"); }

std::vector<std::string> faults_after(const Edit& edit) {
  return faults_of(read_vehicle, edited(paper_text(), edit));
}

TEST(VehicleFile, ReadsThePapersVehicle) {
  const auto vehicle = read_vehicle(kConfigs / "vehicle.json");
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  EXPECT_EQ(vehicle->mass_kg, 37.0);
  EXPECT_EQ(vehicle->length_m, 1.32);
  EXPECT_EQ(vehicle->width_m, 0.78);
  EXPECT_EQ(vehicle->front_axle_m, 0.35);
  EXPECT_EQ(vehicle->half_track_m, 0.36);
  EXPECT_EQ(vehicle->wheel_force.lo, -1.0);
  EXPECT_EQ(vehicle->wheel_force.hi, 1.0);
  EXPECT_EQ(vehicle->steering_max_deg, 20.0);
  EXPECT_EQ(vehicle->steering_max_rate_degps, 300.0);
  EXPECT_EQ(vehicle->steering_time_constant_s, 0.02);
  EXPECT_EQ(vehicle->sample_time_s, 0.01);
  EXPECT_EQ(vehicle->yaw_inertia_kgm2, 5.841);
  EXPECT_EQ(vehicle->sway_alpha, 3.0);
  EXPECT_EQ(vehicle->inertia_kgm2(), 5.841);
}

TEST(VehicleFile, ASizeBeyondAnyVehicleIsNamedInItsUnit) {
  EXPECT_THAT(faults_after({"/length_m", 1320}), ElementsAre(::testing::HasSubstr("mm: 1.32")));
  EXPECT_THAT(faults_after({"/length_m", "1320"}),
              ElementsAre(::testing::Not(::testing::HasSubstr("mm"))));
}

TEST(VehicleFile, ReadsTheForwardOnlyVehicle) {
  const auto vehicle = read_vehicle(kConfigs / "vehicle_forward_only.json");
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  EXPECT_EQ(vehicle->wheel_force.lo, 0.0);
  EXPECT_EQ(vehicle->wheel_force.hi, 0.5);
}

TEST(VehicleFile, ReadsAVehicleWithoutSteering) {
  Json json = Json::parse(paper_text());
  json["drive"] = "differential";
  json.erase("steering");
  json.erase("front_axle_m");
  const ScratchFile file("vehicle.json", json.dump());
  const auto vehicle = read_vehicle(file.path());
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  EXPECT_FALSE(vehicle->has_steering());
  EXPECT_EQ(vehicle->steering_max_deg, 0.0);
  EXPECT_EQ(vehicle->front_axle_m, vehicle->half_track_m);
  EXPECT_TRUE(read_vehicle(kConfigs / "vehicle.json")->has_steering());
}

TEST(VehicleFile, RefusesADriveThatContradictsItsSteering) {
  EXPECT_THAT(faults_after({"/drive", "differential"}),
              ElementsAre(StartsWith("/steering: a vehicle with drive")));
  EXPECT_THAT(faults_after({"/drive", "rear_wheel"}),
              ElementsAre(AllOf(StartsWith("/drive: "), HasSubstr("use differential"),
                                Not(HasSubstr("four_wheel")))));
  EXPECT_THAT(faults_after({"/steering", {}, true}), ElementsAre(StartsWith("/steering")));
}

TEST(VehicleFile, UsesTheBoxFormulaWithoutAnInertia) {
  const ScratchFile file("vehicle.json", edited(paper_text(), {"/yaw_inertia_kgm2", {}, true}));
  const auto vehicle = read_vehicle(file.path());
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  // 37 (0.78^2 + 1.32^2)/12 = 37 x 2.3508/12 = 7.2483, exact in decimals; 1e-14 relative is
  // rounding.
  EXPECT_NEAR(vehicle->inertia_kgm2(), 7.2483, 7.2483e-14);
}

TEST(VehicleFile, HasTheContractsDefaultsForWhatIsOptional) {
  Json json = Json::parse(paper_text());
  for (const char* key : {"schema", "yaw_inertia_kgm2", "sway_alpha", "surge_beta_range"})
    json.erase(key);
  const ScratchFile file("vehicle.json", json.dump());
  const auto vehicle = read_vehicle(file.path());
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  EXPECT_FALSE(vehicle->yaw_inertia_kgm2);
  EXPECT_FALSE(vehicle->sway_alpha);
  EXPECT_EQ(vehicle->surge_beta_range.lo, 0.0);
  EXPECT_EQ(vehicle->surge_beta_range.hi, 2.5);
  EXPECT_EQ(vehicle->yaw_beta_range.lo, 0.0);
  EXPECT_EQ(vehicle->yaw_beta_range.hi, 4.0);
}

TEST(VehicleFile, AcceptsTheEndsOfItsRanges) {
  for (const Edit& edit : std::vector<Edit>{{"/wheel_force/min", 0},
                                            {"/wheel_force/max", 1e-3},
                                            {"/steering/max_deg", 89.9},
                                            {"/surge_beta_range", Json::array({0, 2})}}) {
    EXPECT_THAT(faults_after(edit), IsEmpty()) << edit.pointer;
  }
}

TEST(VehicleFile, ReadsTheConditionsOfTuning) {
  Json json = Json::parse(paper_text());
  json["allocation"] = "paper";
  json["noise"] = {{"heading_deg", 0.5}, {"position_m", 0.01}};
  json["latency_s"] = {{"heading", 0.03}, {"yaw_rate", 0}};
  json["motor"] = {{"time_constant_s", 0.04}, {"back_emf_s_per_m", 0.3}};
  json["yaw_rate_max_degps"] = 60;
  const ScratchFile file("vehicle.json", json.dump());
  const auto vehicle = read_vehicle(file.path());
  ASSERT_TRUE(vehicle) << to_text(vehicle.error());
  EXPECT_EQ(vehicle->allocation, AllocationForm::kPaper);
  const SensorQuality expected{
      .heading_deg = 0.5, .position_m = 0.01, .heading_latency_s = 0.03, .yaw_rate_latency_s = 0.0};
  EXPECT_TRUE(vehicle->sensors == expected);
  EXPECT_EQ(vehicle->motor_time_constant_s, 0.04);
  EXPECT_EQ(vehicle->back_emf_s_per_m, 0.3);
  EXPECT_EQ(vehicle->yaw_rate_max_degps, 60.0);
}

TEST(VehicleFile, KeepsTheMappingsOfItsLogs) {
  Json json = Json::parse(paper_text());
  json["columns"] = {{"speed_mps", "V*0.277778"}};
  const ScratchFile file("vehicle.json", json.dump());
  const auto vehicle = read_vehicle(file.path());
  ASSERT_TRUE(vehicle);
  EXPECT_EQ(vehicle->columns.at("speed_mps"), "V*0.277778");
  EXPECT_THAT(faults_after({"/columns", {{"speed_mps", "V*("}}}), SizeIs(1));
  EXPECT_THAT(faults_after({"/columns", {{"speed_mps", ""}}}), SizeIs(1));
}

TEST(VehicleFile, ReportsAllFaultsAtOnce) {
  Json json = Json::parse(paper_text());
  json["mass_kg"] = -1;
  json.erase("width_m");
  json["colour"] = "red";
  json["steering"]["max_deg"] = 120;
  EXPECT_THAT(faults_of(read_vehicle, json.dump()), SizeIs(4));
}

}  // namespace
}  // namespace awmr::testing
