/// Hard- and soft-iron calibration: recovers a known ellipse, its intervals cover the truth, and
/// data without a turn or an ellipse are refused.
#include "awmr/identify/compass/compass.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "awmr/core/units.h"
#include "awmr/emit/compass_header.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

/// True calibration: the compass reads f = o + S^-1 c for the field c, with offsets o and the
/// symmetric soft-iron matrix S, det S = 1.
struct Truth {
  double ahead_0 = 42.0, left_0 = -67.0;
  double ahead = 1.1, cross = 0.06;
  double left() const { return (1.0 + cross * cross) / ahead; }
  double field = 130.0;
};

struct Turn {
  double from_deg = 20.0, turned_deg = 720.0;
  double noise = 1.0;
  int rows = 400;
  unsigned seed = 1;
};

FieldRecord record_of(const Truth& truth, const Turn& turn) {
  std::mt19937 random(turn.seed);
  std::normal_distribution<double> noise(0.0, turn.noise);
  FieldRecord record{.file = "field.csv"};
  for (int i = 0; i < turn.rows; ++i) {
    const double psi = radians(turn.from_deg + turn.turned_deg * i / (turn.rows - 1));
    const double c = truth.field * std::cos(psi);
    const double d = -truth.field * std::sin(psi);
    record.t_s.push_back(0.1 * i);
    record.ahead.push_back(truth.ahead_0 + truth.left() * c - truth.cross * d + noise(random));
    record.left.push_back(truth.left_0 - truth.cross * c + truth.ahead * d + noise(random));
    record.yaw_rate_radps.push_back(radians(turn.turned_deg) / (0.1 * (turn.rows - 1)));
  }
  return record;
}

TEST(Compass, FindsAKnownEllipseToTheRounding) {
  const Truth truth;
  for (const double turned : {720.0, -720.0}) {
    const auto fit = fit_compass(record_of(truth, {.turned_deg = turned, .noise = 0.0}), 4.5);
    ASSERT_TRUE(fit) << to_text(fit.error());
    const CompassCalibration& c = fit->calibration;
    // Tolerances: the solver stops when the next step is expected to reduce the residuals by less
    // than 1e-8 of their size.
    EXPECT_NEAR(c.centre_ahead.value, truth.ahead_0, 1e-5);
    EXPECT_NEAR(c.centre_left.value, truth.left_0, 1e-5);
    EXPECT_NEAR(c.gain_ahead.value, truth.ahead, 1e-7);
    EXPECT_NEAR(c.gain_cross.value, truth.cross, 1e-7);
    EXPECT_NEAR(c.gain_left.value, truth.left(), 1e-7);
    EXPECT_NEAR(c.field.value, truth.field, 1e-5);
    EXPECT_NEAR(c.turned_deg, turned, 1e-6);
    EXPECT_EQ(c.declination_deg, 4.5);
    EXPECT_TRUE(fit->findings.empty());
  }
}

TEST(Compass, IntervalsCoverTheTruthAtTheirRate) {
  const Truth truth;
  const int kRuns = 400;
  int held[4] = {};
  int heading_held = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const auto fit = fit_compass(record_of(truth, {.noise = 3.0, .seed = seed}), 0.0);
    ASSERT_TRUE(fit);
    const CompassCalibration& c = fit->calibration;
    held[0] += c.centre_ahead.ci95.contains(truth.ahead_0) ? 1 : 0;
    held[1] += c.gain_ahead.ci95.contains(truth.ahead) ? 1 : 0;
    held[2] += c.gain_cross.ci95.contains(truth.cross) ? 1 : 0;
    held[3] += c.field.ci95.contains(truth.field) ? 1 : 0;
    // Heading error when the vehicle points north (true heading 0). The bound is for the worst
    // heading, so it also applies to this one.
    const double ahead = truth.ahead_0 + truth.left() * truth.field - c.centre_ahead.value;
    const double left = truth.left_0 - truth.cross * truth.field - c.centre_left.value;
    const double heading = std::atan2(-(c.gain_cross.value * ahead + c.gain_left.value * left),
                                      c.gain_ahead.value * ahead + c.gain_cross.value * left);
    heading_held += std::abs(degrees(heading)) <= c.heading_error_deg ? 1 : 0;
  }
  // Expected: 95 % of 400 = 380, with a binomial standard deviation of 4.4. The lower bound is
  // three standard deviations below. The upper bound is farther away, because intervals of the
  // jackknife contain the truth in up to 1 % more cases.
  for (const int count : held) {
    EXPECT_GE(count, 0.92 * kRuns);
    EXPECT_LE(count, 0.99 * kRuns);
  }
  EXPECT_GE(heading_held, 0.92 * kRuns);
}

TEST(Compass, ATurnThatDoesNotCoverTheCircleIsRefusedWithWhatIsMissing) {
  const auto most = fit_compass(record_of({}, {.from_deg = 0.0, .turned_deg = 300.0}), 0.0);
  ASSERT_FALSE(most);
  EXPECT_EQ(exit_code(most.error()), 1);
  EXPECT_THAT(to_text(most.error()),
              HasSubstr("no reading for 60 deg of the circle, counter-clockwise from the magnetic "
                        "heading -60 deg"));
  EXPECT_TRUE(fit_compass(record_of({}, {.turned_deg = 340.0}), 0.0));
  for (const double little : {0.0, 1.0, 30.0, 90.0, 180.0}) {
    EXPECT_FALSE(fit_compass(record_of({}, {.turned_deg = little}), 0.0)) << little;
  }
}

TEST(Compass, RefusesOrReportsAFieldThatIsNotAnEllipse) {
  FieldRecord same{.file = "field.csv"};
  for (int i = 0; i < 100; ++i) {
    same.t_s.push_back(i);
    same.ahead.push_back(5.0);
    same.left.push_back(7.0);
  }
  EXPECT_FALSE(fit_compass(same, 0.0));
  FieldRecord line = same;
  for (std::size_t i = 0; i < 100; ++i) line.ahead[i] = line.left[i] = std::sin(0.1 * same.t_s[i]);
  EXPECT_FALSE(fit_compass(line, 0.0));
  const auto noisy = fit_compass(record_of({}, {.noise = 60.0}), 0.0);
  EXPECT_FALSE(noisy);
  const auto rough = fit_compass(record_of({}, {.noise = 12.0}), 0.0);
  ASSERT_TRUE(rough) << to_text(rough.error());
  ASSERT_EQ(rough->findings.size(), 1U);
  EXPECT_EQ(rough->findings[0].code, "compass-residual");
}

TEST(Compass, ReportsAxesThatContradictTheGyroscope) {
  FieldRecord exchanged = record_of({}, {});
  std::swap(exchanged.ahead, exchanged.left);
  FieldRecord turned = record_of({}, {});
  for (double& value : turned.left) value = -value;
  for (const FieldRecord& record : {exchanged, turned}) {
    const auto fit = fit_compass(record, 0.0);
    ASSERT_FALSE(fit);
    EXPECT_EQ(exit_code(fit.error()), 1);
    EXPECT_THAT(to_text(fit.error()),
                HasSubstr("signs of field_ahead and field_left, whether they are exchanged"));
  }
  // Refused: a gyroscope in deg/s, one stuck at zero, and turns that differ by 11 %. 9 % are
  // accepted.
  for (const double factor : {57.3, 0.0, 1.11, 0.89}) {
    FieldRecord apart = record_of({}, {});
    for (double& value : apart.yaw_rate_radps) value *= factor;
    const auto fit = fit_compass(apart, 0.0);
    ASSERT_FALSE(fit) << factor;
    EXPECT_EQ(exit_code(fit.error()), 1) << factor;
  }
  FieldRecord near = record_of({}, {});
  for (double& value : near.yaw_rate_radps) value *= 1.09;
  EXPECT_TRUE(fit_compass(near, 0.0));
  FieldRecord alone = record_of({}, {});
  alone.yaw_rate_radps.clear();
  EXPECT_EQ(fit_compass(alone, 0.0)->findings.at(0).code, "turn-not-checked");
}

TEST(Compass, HeaderHasTheConstantsOfTheSketch) {
  const auto fit = fit_compass(record_of({}, {.noise = 0.0}), 4.5);
  const auto header = compass_header(fit->calibration, {"field*/.csv", std::string(64, 'a')});
  ASSERT_TRUE(header);
  for (const char* line :
       {"#define AWMR_COMPASS_CALIBRATED 1\n", "#define AWMR_COMPASS_AHEAD_0 42.0",
        "#define AWMR_COMPASS_LEFT_0 (-67.0f)", "#define AWMR_COMPASS_AHEAD_AHEAD 1.1",
        "#define AWMR_COMPASS_AHEAD_LEFT 0.0", "#define AWMR_COMPASS_LEFT_LEFT 0.91",
        "#define AWMR_COMPASS_DECLINATION_RAD 0.0785398"}) {
    EXPECT_THAT(*header, HasSubstr(line));
  }
  EXPECT_EQ(header->find("*/.csv"), std::string::npos);
  CompassCalibration tiny = fit->calibration;
  tiny.centre_ahead.value = 1e300;
  EXPECT_FALSE(compass_header(tiny, {"a", "b"}));
}

}  // namespace
}  // namespace awmr::testing
