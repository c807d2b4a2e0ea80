#include "sensor_injection.h"

#include <algorithm>
#include <cmath>

namespace awmr::pil {
namespace {

using cli::Injection;

/// Resolution of the boards' gyroscope (range +-500 deg/s), rad/s per count.
constexpr float kRadpsPerWord = 500.0F / 32768.0F * 0.0174532925F;
/// Standard deviation of the noise of a working gyroscope and of a working compass, and size of the
/// magnetic field, counts.
constexpr double kGyroNoise = 5.0;
constexpr double kFieldNoise = 3.0;
constexpr double kFieldSize = 250.0;
/// Time constant of the complementary filter (gyroscope and compass), s.
constexpr double kLean_s = 2.0;
constexpr double kFixPeriod_s = 0.2;
/// Sizes of the injected failures (Injection in apps/awmr/pil_options.h).
constexpr double kCompassJump_rad = 1.0;
constexpr double kCompassTurning_radps = 0.0436;
constexpr double kGyroDrift_radps = 0.15;
constexpr std::uint32_t kGpsLate_ms = 2000;
constexpr float kGpsJump_m = 20.0F;

/// Returns the result of the sketches' parser for the sentence that a faulty GPS receiver sends;
/// kFix if the injected failure does not concern the sentence.
GpsSentence sentence_of(Injection injection) {
  const char* text = "";
  switch (injection) {
    case Injection::kGpsNoFix:
      text = "$GPRMC,120000.00,V,,,,,,,230394,,,N*71\n";
      break;
    case Injection::kGpsEmpty:
      text = "$GPRMC,120000.00,A,,,,,,,230394,,,A*69\n";
      break;
    case Injection::kGpsDamaged:
      text = "$GPRMC,120000.00,A,4806.0000000,N,01130.0000000,E,1.900,,230394,,,A*00\n";
      break;
    default:
      return GpsSentence::kFix;
  }
  RmcReader reader;
  for (; *text != '\0'; ++text) reader.take(*text);
  return reader.kind();
}

std::int16_t rounded(double counts) { return static_cast<std::int16_t>(std::lround(counts)); }

}  // namespace

CheckedSensors::CheckedSensors(Injection injection, double sample_time_s, const GpsLimits& limits)
    : injection_(injection), sample_time_s_(sample_time_s), gps_(limits) {
  heading_.begin(0);
  heading_.turn.begin(kRadpsPerWord, static_cast<float>(sample_time_s));
  gps_.begin(0);
  // Calibrates the gyroscope at rest, as a board does before the drive begins.
  for (int i = 0; i < 100; ++i) {
    heading_.calibration.take(rounded(kGyroNoise * std::normal_distribution<double>()(random_)),
                              kRadpsPerWord, false, 0.0F);
  }
}

SensorFault CheckedSensors::step(std::size_t k, bool fails, const Commanded& before,
                                 AutopilotInput& in) {
  const std::uint32_t now_ms = in.times.now_ms;
  psi_ref_rad_ = before.psi_ref_rad;
  if (fails && injection_ == Injection::kGyroReversed) {
    in.measured.r_radps = -in.measured.r_radps;
  }
  if (fails && injection_ == Injection::kCompassTurning) {
    // Adds the drift of the compass to the heading that the controller gets as well, because this
    // heading is computed from compass and gyroscope and follows the compass.
    turned_rad_ += kCompassTurning_radps * sample_time_s_;
    in.measured.psi_rad =
        float_math::wrapped(in.measured.psi_rad + static_cast<float>(turned_rad_));
  }
  if (fails && injection_ == Injection::kGpsSpeedZero) in.measured.u_mps = 0.0F;
  sense_heading(fails, in);
  heading_.turn.take(word_, before.moment_m);
  const auto samples =
      static_cast<std::size_t>(std::max(1L, std::lround(kFixPeriod_s / sample_time_s_)));
  if (k % samples == 0) sense_position(k, fails, in);
  const SensorFault heading = heading_.fault(now_ms);
  if (heading == kSensorGood) heading_ms_ = now_ms;
  in.times.heading_ms = heading_ms_;
  in.times.speed_ms = speed_ms_;
  return heading != kSensorGood ? heading : gps_.fault(now_ms);
}

void CheckedSensors::sense_heading(bool fails, const AutopilotInput& in) {
  const auto is = [&](Injection one) { return fails && injection_ == one; };
  const std::uint32_t now_ms = in.times.now_ms;
  std::normal_distribution<double> noise;
  const double rate_radps = static_cast<double>(in.measured.r_radps) +
                            (is(Injection::kGyroDrift) ? kGyroDrift_radps : 0.0);
  if (!is(Injection::kGyroFrozen)) {
    word_ = rounded(rate_radps / static_cast<double>(kRadpsPerWord) + kGyroNoise * noise(random_));
  }
  if (!is(Injection::kGyroSilent)) heading_.take_gyro(word_, now_ms);
  heading_.take_range(!is(Injection::kGyroRange));
  const double true_rad = static_cast<double>(in.measured.psi_rad);
  if (is(Injection::kCompassStuck) && !stuck_rad_) stuck_rad_ = true_rad;
  const double seen_rad =
      stuck_rad_.value_or(true_rad + (is(Injection::kCompassJump) ? kCompassJump_rad : 0.0));
  if (!is(Injection::kCompassFrozen)) {
    field_[0] = rounded(-kFieldSize * std::sin(seen_rad) + kFieldNoise * noise(random_));
    field_[1] = rounded(kFieldSize * std::cos(seen_rad) + kFieldNoise * noise(random_));
    field_[2] = rounded(kFieldNoise * noise(random_));
  }
  heading_rad_ += sample_time_s_ * static_cast<double>(kRadpsPerWord) * word_;
  if (is(Injection::kCompassSilent)) return;
  heading_.take_field(field_[0], field_[1], field_[2], now_ms);
  const double magnetic_rad = std::atan2(-field_[0], field_[1]);
  if (!has_heading_) heading_rad_ = magnetic_rad;
  has_heading_ = true;
  const float innovation = float_math::wrapped(
      static_cast<float>(std::remainder(magnetic_rad - heading_rad_, 6.283185307179586)));
  heading_.step.take(innovation, static_cast<float>(sample_time_s_));
  heading_rad_ += sample_time_s_ / kLean_s * static_cast<double>(innovation);
}

void CheckedSensors::sense_position(std::size_t k, bool fails, const AutopilotInput& in) {
  const auto is = [&](Injection one) { return fails && injection_ == one; };
  const std::uint32_t now_ms = in.times.now_ms;
  if (is(Injection::kGpsSilent)) return;
  if (const GpsSentence kind = fails ? sentence_of(injection_) : GpsSentence::kFix;
      kind != GpsSentence::kFix) {
    return gps_.take_unusable(kind, now_ms);
  }
  if (!is(Injection::kGpsRepeated) || !fix_) {
    const double utc_ms = 43'200'000.0 + 1000.0 * static_cast<double>(k) * sample_time_s_;
    fix_ = GpsFix{static_cast<std::uint32_t>(utc_ms) % kDay_ms, 0, 0, std::abs(in.measured.u_mps)};
    if (!is(Injection::kGpsPositionFrozen) || !has_position_) fix_m_ = in.position_m;
    has_position_ = true;
    if (is(Injection::kGpsJump)) fix_m_.x_m += kGpsJump_m;
  }
  if (!is(Injection::kGpsLate)) return take_fix(*fix_, fix_m_, in);
  delayed_.push_back({now_ms, *fix_, fix_m_});
  if (now_ms - delayed_.front().sent_ms < kGpsLate_ms) return;
  take_fix(delayed_.front().fix, delayed_.front().position_m, in);
  delayed_.pop_front();
}

void CheckedSensors::take_fix(const GpsFix& fix, const Position<float>& position_m,
                              const AutopilotInput& in) {
  const std::uint32_t now_ms = in.times.now_ms;
  const std::int8_t direction = in.reference.speed_mps > 0.0F   ? 1
                                : in.reference.speed_mps < 0.0F ? -1
                                                                : 0;
  if (gps_.take_fix(fix, position_m.x_m, position_m.y_m, now_ms,
                    {in.measured.psi_rad, psi_ref_rad_, direction, true})) {
    speed_ms_ = now_ms;
  }
}

}  // namespace awmr::pil
