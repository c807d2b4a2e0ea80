#include "awmr/model/observer_rate.h"

#include <fmt/format.h>

namespace awmr {

Status check_observer_rate(double bandwidth_radps, double sample_time_s, const std::string& place) {
  if (bandwidth_radps * sample_time_s < 1.0) return {};
  return input_error(
      ErrorCode::kOutOfRange, place,
      fmt::format("with a bandwidth of {:g} rad/s and a sample time of {:g} s, the "
                  "observer's estimate would oscillate; give a bandwidth below {:g} rad/s",
                  bandwidth_radps, sample_time_s, 1.0 / sample_time_s));
}

}  // namespace awmr
