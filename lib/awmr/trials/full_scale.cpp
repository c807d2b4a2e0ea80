#include "full_scale.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace awmr {
namespace {

struct Range {
  double end;
  std::string_view words;
};
constexpr std::array<Range, 5> kRanges{{{100.0, "percent"},
                                        {255.0, "8-bit PWM counts"},
                                        {1000.0, "per mille"},
                                        {1023.0, "10-bit PWM counts"},
                                        {4095.0, "12-bit PWM counts"}}};

}  // namespace

FullScale full_scale_of(double largest, double limit) {
  constexpr double kRounding = 1.005;
  constexpr double kPlainlyBeyond = 1.05;
  for (const Range& range : kRanges) {
    if (largest > range.end * kRounding || largest <= kPlainlyBeyond * limit) continue;
    return {fmt::format("the forces look like {}", range.words), 1.0 / range.end};
  }
  return {"give the force over F_max, the largest force of one motor", limit / largest};
}

}  // namespace awmr
