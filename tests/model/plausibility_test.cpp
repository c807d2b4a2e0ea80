/// Realistic vehicles give no finding; each wrong unit is named.
#include "awmr/model/plausibility.h"

#include <gmock/gmock.h>

#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Vehicle with this mass and these dimensions, and with a typical servo and inertia.
Vehicle vehicle(double mass_kg, double length_m, double width_m, double front_axle_m,
                double half_track_m) {
  Vehicle v = paper_vehicle();
  v.mass_kg = mass_kg;
  v.length_m = length_m;
  v.width_m = width_m;
  v.front_axle_m = front_axle_m;
  v.half_track_m = half_track_m;
  v.yaw_inertia_kgm2.reset();
  return v;
}

std::vector<std::string> pointers(const Vehicle& v) {
  std::vector<std::string> found;
  for (const Implausible& one : implausible_values(v)) found.push_back(one.pointer);
  return found;
}

std::string words(const Vehicle& v) {
  std::string text;
  for (const Implausible& one : implausible_values(v)) text += one.message + "\n";
  return text;
}

TEST(Plausibility, AcceptsRealVehicles) {
  const Vehicle built[] = {paper_vehicle(),
                           vehicle(0.16, 0.17, 0.09, 0.05, 0.035),   // model car, 1:28
                           vehicle(0.25, 0.15, 0.12, 0.04, 0.055),   // construction-kit toy
                           vehicle(2.1, 0.32, 0.22, 0.1, 0.085),     // Arduino rover
                           vehicle(3.2, 0.5, 0.3, 0.16, 0.13),       // model car, 1:10
                           vehicle(50.0, 0.99, 0.67, 0.26, 0.28),    // field robot
                           vehicle(10.0, 0.6, 0.45, 0.25, 0.18),     // mower
                           vehicle(120.0, 2.0, 1.5, 0.9, 0.7),       // weeder
                           vehicle(1500.0, 4.5, 1.8, 1.3, 0.77),     // car
                           vehicle(18000.0, 8.0, 2.55, 3.0, 1.05),   // truck
                           vehicle(400000.0, 14.8, 9.2, 4.2, 3.6)};  // mining truck
  for (const Vehicle& v : built) EXPECT_THAT(pointers(v), IsEmpty()) << v.mass_kg << words(v);
}

TEST(Plausibility, EverySizeInMillimetresIsNamed) {
  const Vehicle v = vehicle(2.1, 320.0, 220.0, 100.0, 85.0);
  EXPECT_THAT(pointers(v), ElementsAre("/length_m", "/width_m", "/half_track_m", "/front_axle_m"));
  EXPECT_THAT(words(v), HasSubstr("looks like mm: 0.085"));
  EXPECT_THAT(words(v), HasSubstr("looks like mm: 0.1\n"));
  EXPECT_THAT(words(v), HasSubstr("looks like mm: 0.32\n"));
  EXPECT_THAT(words(v), HasSubstr("looks like mm: 0.22\n"));
}

TEST(Plausibility, ASingleSizeInMillimetresIsNamed) {
  EXPECT_THAT(words(vehicle(2.1, 0.32, 220.0, 0.1, 0.085)), HasSubstr("looks like mm: 0.22\n"));
  EXPECT_THAT(words(vehicle(2.1, 320.0, 0.22, 0.1, 0.085)), HasSubstr("looks like mm: 0.32\n"));
}

TEST(Plausibility, EverySizeInCentimetresIsNamed) {
  const Vehicle v = vehicle(37.0, 132.0, 78.0, 35.0, 36.0);
  EXPECT_THAT(pointers(v), ElementsAre("/length_m", "/width_m", "/half_track_m", "/front_axle_m"));
  EXPECT_THAT(words(v), HasSubstr("looks like cm: 0.36"));
}

TEST(Plausibility, MillimetresAndGramsTogetherAreNamed) {
  const Vehicle v = vehicle(2100.0, 320.0, 220.0, 100.0, 85.0);
  EXPECT_THAT(pointers(v),
              ElementsAre("/mass_kg", "/length_m", "/width_m", "/half_track_m", "/front_axle_m"));
  EXPECT_THAT(words(v), HasSubstr("looks like g: 2.1\n"));
}

TEST(Plausibility, LengthAndWidthFitEachOther) {
  EXPECT_THAT(pointers(vehicle(20.0, 0.3, 1.2, 0.1, 0.5)), IsEmpty());
  EXPECT_THAT(pointers(vehicle(20.0, 0.3, 2.0, 0.1, 0.8)), ElementsAre("/width_m"));
  EXPECT_THAT(pointers(vehicle(20.0, 2.0, 0.22, 0.8, 0.09)), IsEmpty());
  EXPECT_THAT(pointers(vehicle(20.0, 2.0, 0.15, 0.8, 0.07)), ElementsAre("/length_m"));
}

TEST(Plausibility, TheInertiaOfAnotherVehicleIsNamedAndAMeasuredOneIsNot) {
  Vehicle v = vehicle(2.1, 0.32, 0.22, 0.1, 0.085);
  v.yaw_inertia_kgm2 = 5.841;
  EXPECT_THAT(words(v),
              HasSubstr("measure it again, or omit the key to use the inertia of the box"));
  v.yaw_inertia_kgm2 = 0.03;
  EXPECT_THAT(words(v), IsEmpty());
}

TEST(Plausibility, AcceptsAVehicleWithoutSteering) {
  Vehicle v = vehicle(2.1, 0.32, 0.22, 0.085, 0.085);
  v.drive = Drive::kDifferential;
  v.steering_max_deg = v.steering_max_rate_degps = v.steering_time_constant_s = 0.0;
  EXPECT_THAT(words(v), IsEmpty());
}

TEST(Plausibility, FindingsNameTheFile) {
  const auto findings =
      plausibility_findings(vehicle(2.1, 0.32, 0.22, 0.1, 0.17), Severity::kError, "rover.json");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].file, "rover.json:/half_track_m");
  EXPECT_EQ(findings[0].code, "implausible-vehicle");
  EXPECT_THAT(findings[0].message, HasSubstr("looks like the whole track: 0.085"));
}

}  // namespace
}  // namespace awmr::testing
