#include "awmr/simulate/disturbance.h"

#include <cmath>

#include "awmr/core/units.h"

namespace awmr {
namespace {

/// Number of the first random stream of each axis (RunSeed::random()). Each disturbance term uses
/// one stream, so there is room for 200 terms per axis.
constexpr std::uint64_t kSurgeUse = 100;
constexpr std::uint64_t kSwayUse = 300;
constexpr std::uint64_t kYawUse = 500;

}  // namespace

DisturbanceSource::DisturbanceSource(const std::vector<DisturbanceTerm>& terms,
                                     double sample_time_s, const RunSeed& seed,
                                     std::uint64_t first_use) {
  for (const DisturbanceTerm& term : terms) {
    Running running{.term = term, .random = seed.random(first_use + terms_.size())};
    if (term.kind == DisturbanceTerm::Kind::kSine) {
      running.phase_rad =
          term.phase_rad ? *term.phase_rad : 2.0 * pi<double>() * running.random.uniform();
    }
    if (term.kind == DisturbanceTerm::Kind::kNoise) {
      // Low-pass filtered noise x at the sample times. Its first value already has the standard
      // deviation sigma:
      //   x(t + T_s) = c x(t) + sqrt(1 - c^2) sigma n,  c = exp(-2 pi f T_s)
      // n: standard normal number, f: bandwidth, T_s: sample time.
      running.keep = std::exp(-2.0 * pi<double>() * term.bandwidth_hz * sample_time_s);
      running.value = term.value * running.random.normal();
    }
    terms_.push_back(running);
  }
}

double DisturbanceSource::next(double t_s) {
  double sum = 0.0;
  for (Running& running : terms_) {
    const DisturbanceTerm& term = running.term;
    double value = term.value;
    if (term.kind == DisturbanceTerm::Kind::kSine) {
      value *= std::sin(2.0 * pi<double>() * term.frequency_hz * t_s + running.phase_rad);
    } else if (term.kind == DisturbanceTerm::Kind::kNoise) {
      value = running.value;
      running.value = running.keep * running.value + std::sqrt(1.0 - running.keep * running.keep) *
                                                         term.value * running.random.normal();
    }
    if (term.window.holds(t_s)) sum += value;
  }
  return sum;
}

RunDisturbance::RunDisturbance(const Disturbance& disturbance, double sample_time_s,
                               const RunSeed& seed)
    : surge_(disturbance.surge, sample_time_s, seed, kSurgeUse),
      sway_(disturbance.sway, sample_time_s, seed, kSwayUse),
      yaw_(disturbance.yaw, sample_time_s, seed, kYawUse) {}

}  // namespace awmr
