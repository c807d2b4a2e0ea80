#include "awmr/model/observer_rate.h"

#include <fmt/format.h>

namespace awmr {

Status check_observer_rate(double bandwidth_radps, double sample_time_s, const std::string& place) {
  if (bandwidth_radps * sample_time_s < 1.0) return {};
  return input_error(ErrorCode::kOutOfRange, place,
                     fmt::format("{:g} rad/s is too fast for a sample time of {:g} s, at which "
                                 "the observer's estimate would swing: give less than {:g}",
                                 bandwidth_radps, sample_time_s, 1.0 / sample_time_s));
}

}  // namespace awmr
