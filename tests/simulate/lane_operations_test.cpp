// Single lane operations compared with those on doubles, bit for bit. Built for each instruction
// set; does nothing on a processor without the instructions.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "simulate/lanes_here.h"

namespace {

using namespace awmr::lanes::AWMR_LANES;
using awmr::testing::has_instructions;

constexpr int kBlocks = 2000;
constexpr int kCount = Lanes::kCount;

/// Reproducible numbers in (-20, 20), with occasional special values.
double next_number() {
  constexpr double kOdd[] = {
      0.0, -0.0, 1.0, -1.0, 1e308, 5e-324, __builtin_inf(), __builtin_nan("")};
  static std::uint64_t state = 88172645463325252ULL;
  state ^= state << 13U;
  state ^= state >> 7U;
  state ^= state << 17U;
  if (state % 16U == 0) return kOdd[(state >> 4U) % 8U];
  return 40.0 * (static_cast<double>(state >> 12U) + 0.5) * 0x1p-52 - 20.0;
}

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

int failures = 0;

/// Compares f of three Lanes with the same f of three doubles, lane by lane.
template <class OfLanes, class OfDoubles>
void check(const char* name, const OfLanes& of_lanes, const OfDoubles& of_doubles) {
  for (int block = 0; block < kBlocks; ++block) {
    double x[kCount], y[kCount], z[kCount], result[kCount];
    for (int i = 0; i < kCount; ++i) {
      x[i] = next_number();
      y[i] = next_number();
      z[i] = next_number();
    }
    of_lanes(Lanes::load(x), Lanes::load(y), Lanes::load(z)).store(result);
    for (int i = 0; i < kCount; ++i) {
      const double expected = of_doubles(x[i], y[i], z[i]);
      if (same(result[i], expected)) continue;
      std::printf("%s of %a, %a, %a: %a is not %a\n", name, x[i], y[i], z[i], result[i], expected);
      ++failures;
      return;
    }
  }
}

double select(bool mask, double a, double b) { return mask ? a : b; }
double larger(double a, double b) { return a < b ? b : a; }

}  // namespace

// Applies one expression to lanes and to doubles.
#define AWMR_CHECK(words)                                                                        \
  check(                                                                                         \
      #words, [](const Lanes& x, const Lanes& y, const Lanes& z) { return of(x, y, z, words); }, \
      [](double x, double y, double z) { return of(x, y, z, words); })
/// Silences unused warnings: not every check uses all three.
template <class T>
T of(const T&, const T&, const T&, const T& result) {
  return result;
}

int main() {
  if (!has_instructions()) return std::puts("this processor does not have the instructions"), 0;
  AWMR_CHECK(x + y);
  AWMR_CHECK(x - y);
  AWMR_CHECK(x * y);
  AWMR_CHECK(x / y);
  AWMR_CHECK(-x);
  AWMR_CHECK(larger(x, y));
  AWMR_CHECK(select(x < y, x, z));
  AWMR_CHECK(select(x <= y, x, z));
  AWMR_CHECK(select(x > y, x, z));
  AWMR_CHECK(select(x >= y, x, z));
  AWMR_CHECK(select(!(x >= y), x, z));
  AWMR_CHECK(select(x > y && y > z, x, z));
  AWMR_CHECK(select(x > y || y > z, x, z));
  check(
      "abs", [](const Lanes& x, const Lanes&, const Lanes&) { return abs(x); },
      [](double x, double, double) { return std::fabs(x); });
  check(
      "sqrt", [](const Lanes& x, const Lanes&, const Lanes&) { return sqrt(x); },
      [](double x, double, double) { return std::sqrt(x); });
  check(
      "fma", [](const Lanes& x, const Lanes& y, const Lanes& z) { return fma(x, y, z); },
      [](double x, double y, double z) { return std::fma(x, y, z); });
  if (failures == 0) std::printf("every operation of %d lanes is that of doubles\n", kCount);
  return failures == 0 ? 0 : 1;
}
