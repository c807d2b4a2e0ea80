// Prints the bits of results of batches and of the inner loops of log fits, for processors on which
// the tests do not run. other_processor.py builds this program for such a processor, runs it in an
// emulator, and compares the output with this machine's. Its scenarios are heading commands and
// open loop only, because these use no function of the C library, whose results may differ.
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "awmr/core/random.h"
#include "awmr/identify/logs/simulation/sensitivity_kernel.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/simd/kernels.h"

namespace {

using namespace awmr;

constexpr double kSampleTime_s = 0.01;

/// A vehicle like the paper's with every number changed by up to 20 %.
Plant<double> drawn_plant(std::uint64_t sample) {
  Random random(7, sample);
  const auto about = [&random](double value) { return value * (0.8 + 0.4 * random.uniform()); };
  return {.surge = {about(1.3157), about(0.8841)},
          .yaw = {about(0.3028), about(0.8250)},
          .sway_alpha = about(3.0),
          .mass_norm = about(0.0768),
          .inertia_norm = about(0.01212),
          .front_axle_m = 0.35,
          .half_track_m = 0.32,
          .steering_max_rad = 0.5,
          .steering_max_rate_radps = 6.0,
          .steering_time_constant_s = about(0.02)};
}

/// The gains of every third run have their own observer.
std::vector<BatchRun> drawn_runs(YawMode mode) {
  Vehicle vehicle;
  vehicle.wheel_force = {-1.0, 1.0};
  std::vector<BatchRun> runs;
  for (std::uint64_t i = 0; i < kBatchRuns; ++i) {
    runs.push_back(
        {drawn_plant(i), make_controller(drawn_plant(0), vehicle, kPaperGains), mode, 5U, i});
    if (i % 3 == 1) {
      runs.back().controller.gains.observer = {1.0 + static_cast<double>(i), 0.1, 0.4};
    }
  }
  return runs;
}

/// Heading steps, alone and with the other features of a kernel, and an open-loop path.
std::vector<Scenario> scenarios() {
  const Scenario headings = heading_steps({30.0, -30.0, 170.0}, {.hold_s = 4.0});
  Scenario observed = headings;
  observed.name = "observer";
  observed.control.observer = {.bandwidth_radps = 5.0, .yaw_max_m = 0.2, .surge_max = 0.5};
  DisturbanceTerm step;
  step.value = 0.05;
  step.window.from_s = 2.0;
  observed.disturbance.yaw = {step};
  Scenario small_angles = headings;
  small_angles.name = "small angles";
  small_angles.control.allocation = AllocationForm::kPaper;
  small_angles.control.split = CombinedSplit::kFixedHalf;
  Scenario sagging = headings;
  sagging.name = "a battery that sags";
  sagging.battery = Battery{.sag = 0.3};
  const Scenario open{"open loop", 8.0, {}, 0.0, OpenLoop{0.6, 0.02}};
  Scenario sloped = open;
  sloped.name = "open loop on a slope";
  sloped.disturbance.slope = Slope{.angle_rad = 0.1, .downhill_rad = 0.7};
  return {headings, observed, small_angles, sagging, open, sloped};
}

void print_bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  std::printf(" %016" PRIx64, bits);
}

void print_metrics(const Metrics& metrics) {
  for (const double value :
       {metrics.heading_iae_degs.value_or(0.0), metrics.overshoot_deg.value_or(0.0),
        metrics.settling_time_s.value_or(0.0), metrics.path_length_m,
        metrics.speed_drop_mps.value_or(0.0), metrics.sideslip_max_deg, metrics.yaw_rate_max_degps,
        metrics.control_variation, metrics.energy_mech, metrics.steering_travel_deg,
        metrics.tyre_work}) {
    print_bits(value);
  }
}

/// Prints sensitivities and sums of random numbers, with the widest instructions available.
void print_loops_of_fits() {
  constexpr std::size_t kColumns = 12;
  Random random(11, 0);
  const auto fill = [&random](double* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) from[i] = 2.0 * random.uniform() - 1.0;
  };
  std::array<StateSlopes, kStages> stages{};
  fill(&stages[0].x_psi, sizeof stages / sizeof(double));
  std::vector<double> driven(kStages * kDrivenSize * kColumns * 2);
  std::vector<double> sensitivities(kStateSize * kColumns);
  std::vector<double> sums(kColumns * kColumns);
  fill(driven.data(), driven.size());
  fill(sensitivities.data(), sensitivities.size());
  for (int step = 0; step < 100; ++step) {
    step_sensitivities(stages, driven.data(), 0.01, kColumns, sensitivities.data());
    add_products(sensitivities.data(), kStateSize, kColumns, sums.data());
  }
  std::printf("loops of fits:");
  for (const double value : sensitivities) print_bits(value);
  for (const double value : sums) print_bits(value);
  std::printf("\n");
}

}  // namespace

/// The kernel is given by name; by default it is the widest.
int main(int argc, char** argv) {
  const auto kernels = lanes::supported_kernels();
  const lanes::Kernel* kernel = kernels.empty() || argc > 1 ? nullptr : kernels.front();
  for (const lanes::Kernel* one : kernels) {
    if (argc > 1 && std::strcmp(one->name, argv[1]) == 0) kernel = one;
  }
  if (!kernel) return std::puts("no such kernel on this processor"), 2;
  for (const Scenario& scenario : scenarios()) {
    for (const YawMode mode : kYawModes) {
      const auto driven =
          simulate_batch(drawn_runs(mode), scenario, kSampleTime_s, {kernel->name, "fused"});
      for (std::size_t i = 0; i < driven.size(); ++i) {
        std::printf("%s, mode %d, run %zu:", scenario.name.c_str(), static_cast<int>(mode), i);
        const bool failed = driven[i].run.end == RunEnd::kFailed;
        if (!failed) print_metrics(driven[i].metrics);
        std::printf("%s\n", failed ? " failed" : "");
      }
    }
  }
  print_loops_of_fits();
  return 0;
}
