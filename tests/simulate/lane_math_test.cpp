// Elementary functions of lanes compared with the C library's long double ones. Built for each
// instruction set; does nothing on a processor without the instructions.
#include <cstdint>
#include <cstdio>

#include "simulate/lanes_here.h"

namespace {

using namespace awmr::lanes::AWMR_LANES;
using awmr::testing::has_instructions;

constexpr double kInfinity = __builtin_inf();
const double kNaN = __builtin_nan("");

/// Generator of reproducible random numbers in (0, 1).
double next_uniform() {
  static std::uint64_t state = 88172645463325252ULL;
  state ^= state << 13U;
  state ^= state >> 7U;
  state ^= state << 17U;
  return (static_cast<double>(state >> 12U) + 0.5) * 0x1p-52;
}
double between(double lo, double hi) { return lo + (hi - lo) * next_uniform(); }

/// Error in units of the last place of the larger of the result and `least`.
double ulps(double result, long double exact, double least) {
  const auto scale = static_cast<double>(fmaxl(fabsl(exact), least));
  const double place = nextafter(scale, kInfinity) - scale;
  return static_cast<double>(fabsl(result - exact)) / place;
}

int failures = 0;

/// Checks the worst error of f over the arguments from draw() against `most`.
template <class F, class Exact, class Draw>
void check(const char* name, const F& f, const Exact& exact, const Draw& draw, double least,
           double most) {
  double worst = 0.0;
  for (int block = 0; block < 20000; ++block) {
    double x[Lanes::kCount];
    double y[Lanes::kCount];
    double result[Lanes::kCount];
    for (int i = 0; i < Lanes::kCount; ++i) draw(x[i], y[i]);
    f(Lanes::load(x), Lanes::load(y)).store(result);
    for (int i = 0; i < Lanes::kCount; ++i) {
      worst = fmax(worst, ulps(result[i], exact(x[i], y[i]), least));
    }
  }
  const bool holds = worst <= most;
  printf("%-26s worst %6.2f ulp, at most %g%s\n", name, worst, most, holds ? "" : "  FAILED");
  if (!holds) ++failures;
}

/// Outside the range of a polynomial the result is NaN.
template <class F>
void check_out_of_range(const char* name, const F& f, double x, double y) {
  double result[Lanes::kCount];
  f(Lanes(x), Lanes(y)).store(result);
  if (isnan(result[0])) return;
  printf("%s(%g, %g) is %g and not NaN  FAILED\n", name, x, y, result[0]);
  ++failures;
}

}  // namespace

int main() {
  if (!has_instructions()) {
    printf("this processor does not have the instructions\n");
    return 0;
  }
  const auto raise = [](const Lanes& x, const Lanes& y) { return pow(x, y); };
  const auto raised = [](long double x, long double y) { return powl(x, y); };
  // The error of log2(x) is multiplied by y: 2 ulp of |y log2 x| < 20.
  check(
      "pow, speeds", raise, raised,
      [](double& x, double& y) {
        x = exp(between(-10.0, 5.0));
        y = between(0.0, 2.0);
      },
      0.0, 24.0);
  check(
      "pow, everywhere", raise, raised,
      [](double& x, double& y) {
        x = exp(between(-300.0, 300.0));
        y = between(-1.0, 1.0);
      },
      0.0, 600.0);
  const auto one = [](double& x, double& y, double most) {
    x = between(-most, most);
    y = 0.0;
  };
  const auto sine = [](const Lanes& x, const Lanes&) { return sin(x); };
  const auto cosine = [](const Lanes& x, const Lanes&) { return cos(x); };
  for (const double most : {1.0, 100.0, 1e6}) {
    // Errors are in units of the last place of 1, because near a root of sin or cos the rounding of
    // the argument determines them.
    check(
        "sin", sine, [](long double x, long double) { return sinl(x); },
        [&](double& x, double& y) { one(x, y, most); }, 1.0, 1.5);
    check(
        "cos", cosine, [](long double x, long double) { return cosl(x); },
        [&](double& x, double& y) { one(x, y, most); }, 1.0, 1.5);
  }
  check(
      "atan", [](const Lanes& x, const Lanes&) { return atan(x); },
      [](long double x, long double) { return atanl(x); },
      [&](double& x, double& y) { one(x, y, 20.0); }, 0.0, 3.0);
  check(
      "atan2", [](const Lanes& y, const Lanes& x) { return atan2(y, x); },
      [](long double y, long double x) { return atan2l(y, x); },
      [](double& y, double& x) {
        y = between(-1.0, 1.0);
        x = between(-1.0, 1.0);
      },
      0.0, 3.0);

  for (const double x : {0.0, 5e-324, 1e-310, -1.0, kNaN}) check_out_of_range("pow", raise, x, 0.5);
  check_out_of_range("pow", raise, 1e200, 20.0);
  check_out_of_range("pow", raise, 1.0, kNaN);
  for (const double x : {1.1e6, -1e12, kInfinity, kNaN}) {
    check_out_of_range("sin", sine, x, 0.0);
    check_out_of_range("cos", cosine, x, 0.0);
  }
  // Values below 2^-1000 count as 2^-1000: they are negligible in any sum.
  double least[Lanes::kCount];
  pow(Lanes(1e-200), Lanes(20.0)).store(least);
  if (!(least[0] < 1e-300)) {
    printf("pow(1e-200, 20) is %g, which is not negligible  FAILED\n", least[0]);
    ++failures;
  }
  // Within half a turn, with the sign of the C library's remainder, as in wrap_angle() of the laws.
  for (double x = -40.0; x < 40.0; x += 0.37) {
    double result[Lanes::kCount];
    wrap_angle(Lanes(x)).store(result);
    const double exact = x - 2.0 * M_PI * ceil(x / (2.0 * M_PI) - 0.5);
    if (fabs(result[0] - exact) > 1e-14) {
      printf("wrap_angle(%g) is %.17g and not %.17g  FAILED\n", x, result[0], exact);
      ++failures;
    }
  }
  return failures == 0 ? 0 : 1;
}
