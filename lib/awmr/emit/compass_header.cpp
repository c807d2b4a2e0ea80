#include "awmr/emit/compass_header.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "awmr/core/units.h"
#include "c_text.h"

namespace awmr {
namespace {

constexpr std::string_view kCompassIntro =
    R"(/* awmr_compass.h, made by awmr {} from {}, SHA-256 {}:
   calibration of the compass of one vehicle. Put this file into src/ of the emitted library.
     c = S (field - centre),  heading = atan2(-c_left, c_ahead) - declination
   Standard deviation of the field's distance from the fitted ellipse: {:.2f} % of the field.
   Heading error of the fit: {:.2f} deg (95 %). 95 % intervals in brackets. */
#ifndef AWMR_COMPASS_H
#define AWMR_COMPASS_H
#define AWMR_COMPASS_CALIBRATED 1
)";

struct CompassConstant {
  const char* name;
  WithInterval value;
};

bool is_compass_float(double value) {
  const float rounded = static_cast<float>(value);
  return std::isnormal(rounded) || (rounded == 0.0F && std::abs(value) < 1e-30);
}

}  // namespace

Result<std::string> compass_header(const CompassCalibration& calibration, const InputFile& record) {
  const std::vector<CompassConstant> constants{{"AHEAD_0", calibration.centre_ahead},
                                               {"LEFT_0", calibration.centre_left},
                                               {"AHEAD_AHEAD", calibration.gain_ahead},
                                               {"AHEAD_LEFT", calibration.gain_cross},
                                               {"LEFT_LEFT", calibration.gain_left}};
  std::string text = fmt::format(kCompassIntro, version(), comment_safe(record.name), record.sha256,
                                 100.0 * calibration.residual, calibration.heading_error_deg);
  for (const auto& [name, value] : constants) {
    if (!is_compass_float(value.value)) {
      return input_error(ErrorCode::kOutOfRange, record.name,
                         fmt::format("{} = {:g} does not fit the chip's 32-bit float: record the "
                                     "field in counts or microtesla",
                                     name, value.value));
    }
    text += fmt::format("#define AWMR_COMPASS_{} {} /* [{:.6g}, {:.6g}] */\n", name,
                        float_literal(value.value), value.ci95.lo, value.ci95.hi);
  }
  text +=
      fmt::format("#define AWMR_COMPASS_DECLINATION_RAD {} /* given: {:g} deg east */\n",
                  float_literal(radians(calibration.declination_deg)), calibration.declination_deg);
  return text + "#endif /* AWMR_COMPASS_H */\n";
}

}  // namespace awmr
