/// Fuzz target: gives the sensor checks of the sketch arbitrary readings at arbitrary times. A
/// repeated fix is rejected, each check reports only its own faults, and the vehicle is never armed
/// while a fault lasts.
#include "awmr/emit/board/gps_check.h"
#include "awmr/emit/board/heading_check.h"

#include <cmath>
#include <cstring>

#include "awmr/emit/board/arming.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

namespace {

struct Reader {
  const std::uint8_t* data;
  std::size_t size;
  template <class V>
  V get() {
    V value{};
    const std::size_t taken = size < sizeof value ? size : sizeof value;
    std::memcpy(&value, data, taken);
    data += taken;
    size -= taken;
    return value;
  }
};

float bounded(std::int16_t value, float scale) { return static_cast<float>(value) * scale; }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Reader in{data, size};
  std::uint32_t now_ms = in.get<std::uint32_t>();
  awmr::HeadingCheck heading;
  awmr::GpsCheck<> gps(
      {.speed_max_mps = 3.0F, .on_course_rad = 0.26F, .off_course_mrad = 20.0F, .timeout_ms = 600});
  awmr::Arming arming;
  heading.begin(now_ms);
  heading.turn.begin(2.6e-4F, 0.05F);
  gps.begin(now_ms);
  std::uint32_t last_utc_ms = 0xFFFFFFFFU;
  while (in.size > 0) {
    const auto use = in.get<std::uint8_t>();
    now_ms += in.get<std::uint8_t>();
    const auto word = in.get<std::int16_t>();
    if ((use & 1U) != 0) {
      heading.take_gyro(word, now_ms);
      heading.turn.take(word, bounded(static_cast<std::int16_t>(use), 0.01F) - 1.0F);
      heading.calibration.take(word, 2.6e-4F, (use & 2U) != 0, bounded(word, 1e-4F));
    }
    if ((use & 2U) != 0) {
      heading.take_field(word, in.get<std::int16_t>(), in.get<std::int16_t>(), now_ms);
      heading.step.take(bounded(word, 9e-5F), 0.01F);
    }
    if ((use & 4U) != 0) heading.take_range(word != 0);
    if ((use & 8U) != 0) {
      const awmr::GpsFix fix{in.get<std::uint32_t>() % awmr::kDay_ms, 0, 0,
                             std::fabs(bounded(in.get<std::int16_t>(), 1e-3F))};
      const bool taken =
          gps.take_fix(fix, bounded(word, 0.01F), bounded(in.get<std::int16_t>(), 0.01F), now_ms,
                       {bounded(word, 1e-3F), bounded(static_cast<std::int16_t>(use), 0.02F),
                        static_cast<std::int8_t>(use >> 6U), (use & 16U) != 0});
      require(!taken || fix.utc_ms != last_utc_ms, "a repeated sentence is rejected");
      last_utc_ms = fix.utc_ms;
      if (taken && gps.fault(now_ms) == awmr::kGpsSilent)
        require(false, "an accepted fix ends the silence");
    }
    if ((use & 32U) != 0) gps.take_unusable(awmr::GpsSentence::kDamaged, now_ms);
    const awmr::SensorFault a = heading.fault(now_ms);
    const awmr::SensorFault b = gps.fault(now_ms);
    require(a <= awmr::kHeadingOutOfStep || a == awmr::kWrongTurn,
            "the heading check reports its own faults");
    require(b == awmr::kSensorGood || (b >= awmr::kGpsSilent && b <= awmr::kOffHeading) ||
                b == awmr::kOffCourse,
            "the GPS check reports its own faults");
    require(!heading.calibration.is_done() || std::fabs(heading.calibration.bias_radps()) < 0.09F,
            "the gyroscope bias is below 0.09 rad/s");
    const std::uint8_t cause = a != awmr::kSensorGood ? a : b;
    if ((use & 128U) != 0) arming.arm(0, cause);
    arming.observe(0, cause);
    require(!arming.is_armed() || cause == awmr::kSensorGood, "not armed while there is a fault");
  }
  return 0;
}
