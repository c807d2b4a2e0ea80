/// Plausibility checks of compass, gyroscope and GPS, arming, and the RMC parser.
#include "awmr/emit/board/gps_receiver.h"
#include "awmr/emit/board/heading_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "awmr/emit/board/arming.h"

namespace awmr::testing {
namespace {

std::string sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}", body, sum);
}
constexpr const char* kGood =
    "GPRMC,123519.20,A,4807.0380000,N,01131.0000000,E,022.4,084.4,230394,003.1,W,A";

/// Parses the characters of a line and returns the verdict; kOther if they are not a sentence.
GpsSentence read(const std::string& line, GpsFix& fix) {
  RmcReader reader;
  GpsSentence kind = GpsSentence::kOther;
  for (const char c : line) {
    if (!reader.take(c)) continue;
    kind = reader.kind();
    if (kind == GpsSentence::kFix) fix = to_fix(reader.numbers());
  }
  return kind;
}

TEST(Rmc, ReadsAWholeSentence) {
  GpsFix fix{};
  ASSERT_EQ(read(sentence(kGood) + "\r\n", fix), GpsSentence::kFix);
  EXPECT_EQ(fix.utc_ms, ((12U * 60 + 35) * 60 + 19) * 1000 + 200);
  EXPECT_EQ(fix.lat_e7, 481173000);
  EXPECT_EQ(fix.lon_e7, 115166666);
  EXPECT_NEAR(fix.speed_mps, 22.4 * 0.514444, 1e-4);
  ASSERT_EQ(read(sentence("GNRMC,000000,A,0000.0,S,18000.0,W,0,,230394,,") + "\n", fix),
            GpsSentence::kFix);
  EXPECT_EQ(fix.lat_e7, 0);
  EXPECT_EQ(fix.lon_e7, -1800000000);
}

TEST(Rmc, RefusesEmptyAndMalformedFields) {
  const std::string good = kGood;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string body = good;
    return sentence(body.replace(body.find(from), from.size(), to)) + "\n";
  };
  GpsFix fix{};
  for (const auto& [from, to] : {std::pair{"123519.20", ""},
                                 {"123519.20", "12351"},
                                 {"123519.20", "243519"},
                                 {"123519.20", "126019"},
                                 {"123519.20", "123560"},
                                 {"123519.20", "240000"},
                                 {"123519.20", "1235190"},
                                 {"123519.20", "12a519"},
                                 {",A,48", ",,48"},
                                 {",A,48", ",X,48"},
                                 {"4807.0380000", ""},
                                 {"4807.0380000", "4860.0"},
                                 {"4807.0380000", "9107.0"},
                                 {"4807.0380000", "4807"},
                                 {"4807.0380000", "4807.03x"},
                                 {",N,", ",,"},
                                 {",N,", ",E,"},
                                 {"01131.0000000", ""},
                                 {"01131.0000000", "1131.0"},
                                 {"01131.0000000", "18131.0"},
                                 {",E,", ",,"},
                                 {"022.4", ""},
                                 {"022.4", "-1"},
                                 {"022.4", "nan"},
                                 {"022.4", "1234567"}}) {
    EXPECT_EQ(read(with(from, to), fix), GpsSentence::kDamaged) << from << " -> " << to;
  }
  EXPECT_EQ(read(with(",A,48", ",V,48"), fix), GpsSentence::kNoFix);
  for (const char* mode : {",W,N", ",W,E"}) {
    EXPECT_EQ(read(with(",W,A", mode), fix), GpsSentence::kNoFix) << mode;
  }
  EXPECT_EQ(read(sentence("GPGGA,1,2,3") + "\n", fix), GpsSentence::kOther);
  EXPECT_EQ(read(sentence("GPRMC,123519") + "\n", fix), GpsSentence::kDamaged);
  for (const std::string& line : {std::string("$"), "$" + good, "$" + good + "*", "$" + good + "*0",
                                  "$" + good + "*00", sentence(good) + "x"}) {
    EXPECT_EQ(read(line + "\n", fix), GpsSentence::kDamaged) << line;
  }
}

/// Serial port with an unlimited receive buffer. `most`: largest number of characters that waited
/// in it, to be compared with the size of Arduino's buffer.
struct Port {
  std::string waiting;
  int most = 0;
  void receive(const std::string& text) {
    waiting += text;
    most = std::max(most, static_cast<int>(waiting.size()));
  }
  int available() const { return static_cast<int>(waiting.size()); }
  int read() {
    const char c = waiting.front();
    waiting.erase(0, 1);
    return c;
  }
};

constexpr GpsLimits kLimits{
    .speed_max_mps = 8.0F, .on_course_rad = 0.262F, .off_course_mrad = 20.0F, .timeout_ms = 600};

struct ReceiverOnAPort {
  Port port;
  GpsReceiver<> gps{kLimits};
  std::uint32_t now_ms = 0;
  std::string on_the_way;
  ReceiverOnAPort() { gps.begin(0); }
  /// Simulates a step of 10 ms, in which 39 characters arrive at 38,400 baud.
  void step() {
    now_ms += 10;
    port.receive(on_the_way.substr(0, 39));
    on_the_way.erase(0, 39);
    const auto project = [](const GpsFix& fix) {
      return GpsPlace{static_cast<float>(fix.lat_e7 - 481173000), 0.0F};
    };
    gps.receive(port, now_ms);
    gps.step(project, {0.0F, 0.0F, 1, true});
  }
};

TEST(GpsReceiver, SpreadsASentenceOverStepsAndPublishesTwoStepsAfterItsEnd) {
  ReceiverOnAPort board;
  board.on_the_way =
      sentence(kGood) + "\n";  // 82 characters, 39 per step: the third step reads the last one
  for (int i = 1; i <= 4; ++i) {
    board.step();
    EXPECT_FALSE(board.gps.has_fix()) << i;
  }
  board.step();
  ASSERT_TRUE(board.gps.has_fix());
  EXPECT_EQ(board.gps.time_ms, 30U);
  EXPECT_EQ(board.gps.x_m, 0.0F);
  EXPECT_NEAR(board.gps.speed_mps, 22.4 * 0.514444, 1e-4);
  EXPECT_EQ(board.gps.fault(board.now_ms), kSensorGood);
}

TEST(GpsReceiver, KeepsUpWithAPortThatNeverRests) {
  ReceiverOnAPort board;
  int fixes = 0;
  std::uint32_t time_ms = 0;
  for (int i = 0; i < 400; ++i) {
    if (board.on_the_way.size() < 100) {
      std::string body = kGood;
      body.replace(body.find("123519.20"), 9, fmt::format("1235{:05.2f}", 0.01 * i));
      board.on_the_way += sentence(body) + "\r\n" + sentence("GPGGA,1,2,3,4,5,6,7") + "\r\n";
    }
    board.step();
    fixes += board.gps.has_fix() && board.gps.time_ms != time_ms ? 1 : 0;
    time_ms = board.gps.time_ms;
  }
  EXPECT_LE(board.port.most, 64);
  // In 400 steps, 400 * 39 characters arrive. Each fix takes two sentences with 110 characters in
  // total.
  EXPECT_GE(fixes, 400 * 39 / 110 - 3);
}

TEST(FrozenCheck, FindsTheSameWordForHalfASecondAlsoAcrossTheClocksWrap) {
  for (const std::uint32_t start_ms : {0U, 0xFFFFFF00U}) {
    FrozenCheck check;
    for (std::uint32_t t = 0; t <= 500; t += 10) check.take(7, start_ms + t);
    EXPECT_FALSE(check.is_frozen());
    check.take(7, start_ms + 510);
    EXPECT_TRUE(check.is_frozen());
    check.take(8, start_ms + 520);
    EXPECT_FALSE(check.is_frozen());
  }
}

/// Resolution of the board's gyroscope, rad/s per count.
constexpr float kPerWord = 500.0F / 32768.0F * 0.0174532925F;

GyroCalibration calibrated(double rate_radps, double sway_radps, bool has_compass) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 5.0);
  GyroCalibration calibration;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.01 * i;
    const double rate = 0.02 + rate_radps + sway_radps * std::sin(6.28 * t);
    calibration.take(static_cast<std::int16_t>(
                         std::lround(rate / static_cast<double>(kPerWord) + noise(random))),
                     kPerWord, has_compass, static_cast<float>(1.0 + rate_radps * t));
  }
  return calibration;
}

TEST(GyroCalibration, WaitsUntilTheVehicleIsAtRest) {
  const GyroCalibration still = calibrated(0.0, 0.0, true);
  EXPECT_TRUE(still.is_done());
  // Tolerance: 4 standard errors of the mean of 100 values with 5 counts of noise.
  EXPECT_NEAR(still.bias_radps(), 0.02, 4 * 0.5 * static_cast<double>(kPerWord));
  EXPECT_FALSE(calibrated(0.5, 0.0, true).is_done());
  EXPECT_FALSE(calibrated(0.5, 0.0, false).is_done());
  EXPECT_FALSE(calibrated(-0.2, 0.0, false).is_done());
  EXPECT_FALSE(calibrated(0.065, 0.0, true).is_done()) << "slow turn, seen by the compass";
  EXPECT_FALSE(calibrated(0.0, 0.1, false).is_done()) << "mean right, scatter too large";
}

struct Receiver {
  GpsCheck<> check{kLimits};
  GpsFix fix{1000, 0, 0, 1.0F};
  std::uint32_t now_ms = 5000;
  float x_m = 0.0F, y_m = 0.0F;
  GpsContext at{0.0F, 0.0F, 1, true};

  Receiver() { check.begin(now_ms); }
  bool next(std::uint32_t utc_ms = 200, std::uint32_t wait_ms = 200) {
    fix.utc_ms = (fix.utc_ms + utc_ms) % kDay_ms;
    now_ms += wait_ms;
    return check.take_fix(fix, x_m, y_m, now_ms, at);
  }
  bool drive(int fixes) {
    bool good = true;
    for (int i = 0; i < fixes; ++i) {
      x_m += 0.2F * fix.speed_mps * (at.direction < 0 ? -1.0F : 1.0F);
      good = next() && good;
    }
    return good && check.fault(now_ms) == kSensorGood;
  }
};

TEST(GpsCheck, AcceptsADriveThroughMidnightAndLostSentences) {
  Receiver gps;
  gps.fix.utc_ms = kDay_ms - 3000;
  EXPECT_TRUE(gps.drive(50));
  gps.x_m += 0.6F;
  EXPECT_TRUE(gps.next(600, 600));
  EXPECT_TRUE(gps.drive(500));
}

TEST(GpsCheck, IsSilentWithoutSentences) {
  Receiver gps;
  ASSERT_TRUE(gps.drive(10));
  EXPECT_EQ(gps.check.fault(gps.now_ms + 600), kSensorGood);
  EXPECT_EQ(gps.check.fault(gps.now_ms + 601), kGpsSilent);
}

TEST(GpsCheck, RefusesRepeatedOldAndDisplacedFixes) {
  Receiver gps;
  ASSERT_TRUE(gps.drive(10));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(gps.next(0));
  EXPECT_EQ(gps.check.fault(gps.now_ms), kGpsRepeated);
  Receiver late;
  ASSERT_TRUE(late.drive(10));
  EXPECT_FALSE(late.next(200, 900)) << "this fix arrives 700 ms later than the others";
  EXPECT_FALSE(late.next(200, 200));
  Receiver back;
  ASSERT_TRUE(back.drive(10));
  EXPECT_FALSE(back.next(kDay_ms - 1000));
  Receiver displaced;
  ASSERT_TRUE(displaced.drive(10));
  displaced.x_m += 20.0F;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(displaced.next());
  EXPECT_EQ(displaced.check.fault(displaced.now_ms), kGpsJump);
  displaced.at.is_armed = false;
  displaced.fix.speed_mps = 0.0F;
  int taken = 0;
  for (int i = 0; i < 10; ++i) taken += displaced.next() ? 1 : 0;
  EXPECT_GT(taken, 0) << "a disarmed vehicle accepts the new position";
}

TEST(GpsCheck, ToleratesAClockThatIsOffByHalfAPercent) {
  for (const std::uint32_t wait_ms : {199U, 201U}) {
    Receiver gps;
    for (int i = 0; i < 5000; ++i) {
      gps.x_m += 0.2F;
      ASSERT_TRUE(gps.next(200, wait_ms)) << i;
    }
  }
}

TEST(GpsCheck, FindsSpeedAndPositionThatContradictEachOther) {
  Receiver still;
  ASSERT_TRUE(still.drive(10));
  for (int i = 0; i < 10; ++i) still.next();
  EXPECT_EQ(still.check.fault(still.now_ms), kGpsInconsistent);
  Receiver fast;
  ASSERT_TRUE(fast.drive(10));
  fast.fix.speed_mps = 0.0F;
  for (int i = 0; i < 30; ++i) {
    fast.x_m += 0.4F;
    fast.next();
  }
  EXPECT_EQ(fast.check.fault(fast.now_ms), kGpsInconsistent);
}

TEST(GpsCheck, FindsAPositionThatDoesNotFollowTheSpeed) {
  // A position that stands still, and one that moves by a fifth of the speed. The window of 12 m
  // ends after 13 m.
  for (const float share : {0.0F, 0.2F}) {
    Receiver held;
    ASSERT_TRUE(held.drive(10));
    int fixes = 0;
    for (; fixes < 200 && held.check.fault(held.now_ms) == kSensorGood; ++fixes) {
      held.x_m += share * 0.2F + (fixes % 2 == 0 ? 0.05F : -0.05F);
      held.next();
    }
    EXPECT_EQ(held.check.fault(held.now_ms), kGpsInconsistent);
    EXPECT_LT(fixes, 130);
  }
  // A receiver whose position and speed froze at rest is detected after 10 s.
  Receiver frozen;
  frozen.fix.speed_mps = 0.0F;
  for (int i = 0; i < 49; ++i) ASSERT_TRUE(frozen.next());
  EXPECT_EQ(frozen.check.fault(frozen.now_ms), kSensorGood);
  for (int i = 0; i < 3; ++i) frozen.next();
  EXPECT_EQ(frozen.check.fault(frozen.now_ms), kGpsInconsistent);
  frozen.at.direction = 0;
  frozen.at.is_armed = false;
  ASSERT_TRUE(frozen.drive(500)) << "no motion is commanded, so constant fixes are no fault";
  // A speed that is stuck at 1 m/s while the vehicle rests is detected after 10 s and 12 m.
  Receiver stuck;
  ASSERT_TRUE(stuck.drive(10));
  stuck.at.direction = 0;
  int waited = 0;
  for (; waited < 200 && stuck.check.fault(stuck.now_ms) == kSensorGood; ++waited) {
    stuck.x_m += waited % 2 == 0 ? 0.05F : -0.05F;
    stuck.next();
  }
  EXPECT_NEAR(waited, 5 * (10 + 12), 5);
  // At rest, the noise of a speed without a sign adds up to a distance, while the displacements of
  // the position cancel. This is no fault.
  Receiver resting;
  resting.fix.speed_mps = 0.25F;
  resting.at.direction = 0;
  for (int i = 0; i < 1000; ++i) {
    resting.x_m = i % 2 == 0 ? 0.05F : -0.05F;
    ASSERT_TRUE(resting.next());
  }
  resting.fix.speed_mps = 1.0F;
  for (int i = 0; i < 20; ++i) {
    resting.at.direction = static_cast<std::int8_t>(i % 2 == 0 ? 1 : -1);
    ASSERT_TRUE(resting.drive(35)) << i;
  }
}

TEST(GpsCheck, FindsAVehicleThatMovesTheWrongWay) {
  Receiver gps;
  ASSERT_TRUE(gps.drive(20));
  for (int i = 0; i < 25; ++i) {
    gps.x_m -= 0.2F;
    gps.next();
  }
  EXPECT_EQ(gps.check.fault(gps.now_ms), kWrongWay);
  gps.at.is_armed = false;
  gps.fix.speed_mps = 0.0F;
  gps.next();
  EXPECT_EQ(gps.check.fault(gps.now_ms), kSensorGood) << "disarming at rest clears the fault";
}

/// Drives at 1 m/s for `seconds` and turns by `turn_radps` until the heading is `wanted_rad`.
/// Returns the distance driven when kOffCourse was raised, m; -1: never.
double off_course_after_m(double wanted_rad, double turn_radps, double seconds) {
  Receiver gps;
  double psi_rad = 0.0;
  gps.at.psi_ref_rad = static_cast<float>(wanted_rad);
  for (int i = 0; i < 5 * seconds; ++i) {
    psi_rad = std::min(wanted_rad, psi_rad + 0.2 * turn_radps);
    gps.at.psi_rad = static_cast<float>(psi_rad);
    gps.x_m += static_cast<float>(0.2 * std::cos(psi_rad));
    gps.y_m += static_cast<float>(0.2 * std::sin(psi_rad));
    gps.next();
    if (gps.check.fault(gps.now_ms) == kOffCourse) return 0.2 * (i + 1);
  }
  return -1.0;
}

TEST(GpsCheck, FindsAVehicleThatDoesNotTurnToItsHeading) {
  constexpr double kLimit_mrad = static_cast<double>(kLimits.off_course_mrad);
  // The vehicle drives straight on with the heading error e: the fault is raised after
  // off_course_mrad/(e - on_course_rad). Tolerance: three fixes of 0.2 m. The first fix shows no
  // motion, the second a new heading, and the last may be one fix late.
  for (const double error_rad : {1.0, 1.57, 2.5, 3.1}) {
    EXPECT_NEAR(off_course_after_m(error_rad, 0.0, 300.0), kLimit_mrad / (error_rad - 0.262), 0.6)
        << error_rad;
  }
  EXPECT_EQ(off_course_after_m(0.25, 0.0, 300.0), -1.0);
  // In a turn by 180 deg with the radius R, distance times error adds up to (pi - 0.262)^2/2 R =
  // 4.15 R. It reaches the limit of 20 m rad at R = 4.8 m.
  EXPECT_EQ(off_course_after_m(3.14, 1.0 / 4.6, 300.0), -1.0);
  EXPECT_GT(off_course_after_m(3.14, 1.0 / 5.4, 300.0), 0.0);
}

TEST(GpsCheck, AcceptsANewCommandedHeading) {
  // The commanded heading is reversed every 6 m. This adds 6 m (3.1 - 0.262) = 17 m rad, below the
  // limit of 20 m rad.
  Receiver gps;
  for (int i = 0; i < 3000; ++i) {
    if (i % 30 == 0) gps.at.psi_ref_rad = gps.at.psi_ref_rad > 0.0F ? 0.0F : 3.1F;
    gps.x_m += 0.2F;
    gps.next();
    ASSERT_EQ(gps.check.fault(gps.now_ms), kSensorGood) << i;
  }
}

/// Turns against the commanded moment, first at `rate_radps`; in a turn by 90 deg the rate falls by
/// the fraction `fall`. Returns the angle turned when the fault was raised, rad; -1: never.
double wrong_turn_after_rad(double rate_radps, double fall) {
  TurnCheck check;
  check.begin(kPerWord, 0.01F);
  double turned_rad = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double now_radps = rate_radps * std::max(0.0, 1.0 - fall * turned_rad / 1.5707963);
    turned_rad += 0.01 * now_radps;
    check.take(static_cast<std::int16_t>(std::lround(now_radps / static_cast<double>(kPerWord))),
               -0.1F);
    if (check.is_wrong()) return turned_rad;
  }
  return -1.0;
}

TEST(TurnCheck, FindsAQuarterTurnAgainstTheMomentUnlessTheTurnIsBraked) {
  for (const double rate_radps : {0.2, 1.0, 4.0}) {
    // The fault is raised after a quarter turn, at the latest one sample later.
    EXPECT_NEAR(wrong_turn_after_rad(rate_radps, 0.0), 1.5707963, 0.011 * rate_radps);
    EXPECT_NEAR(wrong_turn_after_rad(rate_radps, -1.0), 1.5707963, 0.021 * rate_radps);
    EXPECT_EQ(wrong_turn_after_rad(rate_radps, 0.3), -1.0);
    EXPECT_EQ(wrong_turn_after_rad(rate_radps, 1.0), -1.0);
  }
}

/// Drives with position errors that wander by 1 m RMS with a time constant of 60 s, speeds of 0.4
/// to 3 m/s that change (also in sign) by 0.3 to 1 m/s^2, turns of up to 0.5 rad/s, and heading
/// errors of 5 deg.
TEST(GpsCheck, RaisesNoFaultOnARoughDrive) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.0F, 1.0F);
    const auto draw = [&random](float from, float to) {
      return std::uniform_real_distribution<float>(from, to)(random);
    };
    Receiver gps;
    float x_m = 0.0F, y_m = 0.0F, u_mps = 0.0F, wanted_mps = 0.0F, turn_radps = 0.0F;
    float psi_rad = 0.0F, rate_mps2 = 0.5F, wander_x_m = 0.0F, wander_y_m = 0.0F;
    for (int i = 0; i < 3000; ++i) {
      if (i % 100 == 0) {
        wanted_mps = draw(0.4F, 3.0F) * (draw(0.0F, 1.0F) < 0.3F ? -1.0F : 1.0F);
        rate_mps2 = draw(0.3F, 1.0F);
        turn_radps = draw(-0.5F, 0.5F);
      }
      u_mps += std::min(std::max(wanted_mps - u_mps, -0.2F * rate_mps2), 0.2F * rate_mps2);
      psi_rad += 0.2F * turn_radps;
      x_m += 0.2F * u_mps * std::cos(psi_rad);
      y_m += 0.2F * u_mps * std::sin(psi_rad);
      const float step_m = std::sqrt(2.0F * 0.2F / 60.0F);
      wander_x_m += step_m * noise(random) - 0.2F / 60.0F * wander_x_m;
      wander_y_m += step_m * noise(random) - 0.2F / 60.0F * wander_y_m;
      gps.x_m = x_m + wander_x_m + 0.02F * noise(random);
      gps.y_m = y_m + wander_y_m + 0.02F * noise(random);
      gps.fix.speed_mps = std::abs(u_mps + 0.05F * noise(random));
      gps.at.psi_rad = psi_rad + 0.09F * std::sin(0.01F * static_cast<float>(i));
      gps.at.psi_ref_rad = psi_rad + 0.35F * std::sin(0.02F * static_cast<float>(i));
      gps.at.direction = wanted_mps > 0.0F ? 1 : -1;
      ASSERT_TRUE(gps.next()) << seed << " " << i;
      ASSERT_EQ(gps.check.fault(gps.now_ms), kSensorGood) << seed << " " << i;
    }
  }
}

/// Number of 200 slow drives of two minutes that raise a fault. Positions wander by `wander_m` RMS
/// with a time constant of 60 s, the measured speed is the fraction `speed_share` of the true one,
/// and the track is `off_rad` off the heading.
int faults_of_slow_drives(float wander_m, float speed_share, float off_rad) {
  int faults = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.0F, 1.0F);
    const float u_mps = std::uniform_real_distribution<float>(0.1F, 0.5F)(random);
    Receiver gps;
    EXPECT_TRUE(gps.next());
    float x_m = 0.0F, y_m = 0.0F, wander_x_m = 0.0F, wander_y_m = 0.0F;
    for (int i = 0; i < 600 && gps.check.fault(gps.now_ms) == kSensorGood; ++i) {
      x_m += 0.2F * u_mps * std::cos(off_rad);
      y_m += 0.2F * u_mps * std::sin(off_rad);
      const float step_m = wander_m * std::sqrt(2.0F * 0.2F / 60.0F);
      wander_x_m += step_m * noise(random) - 0.2F / 60.0F * wander_x_m;
      wander_y_m += step_m * noise(random) - 0.2F / 60.0F * wander_y_m;
      gps.x_m = x_m + wander_x_m;
      gps.y_m = y_m + wander_y_m;
      gps.fix.speed_mps = speed_share * std::abs(u_mps + 0.05F * noise(random));
      EXPECT_TRUE(gps.next()) << seed << " " << i;
    }
    faults += gps.check.fault(gps.now_ms) != kSensorGood ? 1 : 0;
  }
  return faults;
}

TEST(MotionCheck, AcceptsADriftingPositionOfASlowVehicle) {
  // The limits of the two checks are 3.2 and 3.5 standard deviations of the drift: a false fault in
  // at most one of 200 drives.
  EXPECT_LE(faults_of_slow_drives(1.5F, 1.0F, 0.0F), 1);
  EXPECT_EQ(faults_of_slow_drives(1.0F, 1.0F, 0.0F), 0);
}

TEST(MotionCheck, FindsASpeedOfZeroAndACompassThatIsOffOnASlowVehicle) {
  // The speed of 0 is detected after 6 m, within 90 s if the drive is faster than 0.067 m/s.
  EXPECT_EQ(faults_of_slow_drives(0.0F, 0.0F, 0.0F), 200);
  // The compass error is detected when |ahead| + |left| of the displacement reaches 10 m + 0.1 m/s
  // t. At 45 deg this is within 120 s if the drive is faster than 0.16 m/s.
  EXPECT_GE(faults_of_slow_drives(0.0F, 1.0F, 0.785F), 200 * 8 / 10);
}

TEST(StepCheck, FindsAJumpAndADriftAndNothingInNoise) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.035F);  // heading error of 2 deg RMS
  StepCheck quiet;
  for (int i = 0; i < 100000; ++i) quiet.take(noise(random), 0.01F);
  EXPECT_FALSE(quiet.is_apart());
  StepCheck jump;
  for (int i = 0; i < 25; ++i) jump.take(0.5F + noise(random), 0.01F);
  EXPECT_TRUE(jump.is_apart());
  StepCheck drift;
  for (int i = 0; i < 1500; ++i) drift.take(0.12F + noise(random), 0.01F);
  EXPECT_TRUE(drift.is_apart());
  for (int i = 0; i < 1500; ++i) drift.take(noise(random), 0.01F);
  EXPECT_FALSE(drift.is_apart());
}

TEST(Arming, NeedsACommandAfterEveryReasonToStop) {
  Arming arming;
  EXPECT_FALSE(arming.is_armed());
  EXPECT_EQ(arming.reason, DisarmReason::kReset);
  EXPECT_FALSE(arming.arm(kFaultHeadingStale | kFaultCommandTimeout, 0));
  EXPECT_FALSE(arming.arm(kFaultNone, kGpsSilent));
  EXPECT_TRUE(arming.arm(kFaultCommandTimeout, 0)) << "a command time-out does not prevent arming";
  EXPECT_FALSE(arming.observe(kFaultNone, 0));
  EXPECT_TRUE(arming.observe(kFaultCommandTimeout, 0));
  EXPECT_EQ(arming.reason, DisarmReason::kTimeout);
  EXPECT_FALSE(arming.observe(kFaultNone, 0)) << "commands alone do not arm";
  EXPECT_FALSE(arming.is_armed());
  EXPECT_TRUE(arming.arm(kFaultNone, 0));
  EXPECT_TRUE(arming.observe(kFaultNone, kCompassFrozen));
  EXPECT_EQ(arming.reason, DisarmReason::kFault);
  EXPECT_EQ(arming.cause, kCompassFrozen);
  EXPECT_TRUE(arming.arm(kFaultNone, 0));
  arming.disarm(DisarmReason::kStop);
  EXPECT_EQ(arming.reason, DisarmReason::kStop);
}

}  // namespace
}  // namespace awmr::testing
