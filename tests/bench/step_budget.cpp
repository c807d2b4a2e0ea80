// Counts the arithmetic operations of a closed loop per Runge-Kutta step, including the control
// laws, the allocation and the metrics, as a mean over the run of the nominal vehicle. Prints JSON
// for scripts/bench. usage: step_budget MODEL.json GAINS.json SCENARIO.json
#include <fmt/format.h>

#include <algorithm>

#include "counted.h"
// The scalar type must be declared before the templates that are instantiated with it.
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/scenario_file.h"

namespace {

using namespace awmr;
using bench::Counted;

/// Cost of functions in a batch (lib/awmr/simulate/simd/lane_math.h), in additions,
/// multiplications, divisions and roots; an FMA counts as two. Sine and cosine of an angle are
/// computed together. A polynomial of n coefficients is n - 1 FMAs.
///   pow       logarithm: 6 operations, 2 FMAs and a polynomial of 7; a product with the exponent;
///             power of two: 3 operations and a polynomial of 12
///   sin, cos  4 operations, 7 FMAs and two polynomials of 6, for both together
///   atan      8 operations, an FMA and a polynomial of 11
constexpr double kPower = 48.0;
constexpr double kSineAndCosine = 38.0;
constexpr double kArcTangent = 30.0;

using View = OneRunOf<Counted>;
constexpr LoopSteps<Counted> kCountedSteps = {
    "counted",
    [](LoopRuns<Counted>& runs) { steps::control(View{}, runs); },
    [](LoopRuns<Counted>& runs) { steps::measure(View{}, runs); },
    {[](Vehicles<Counted>& v) { steps::dissipate(View{}, v); },
     [](Vehicles<Counted>& v) { steps::actuate(View{}, v); },
     [](Vehicles<Counted>& v) { steps::move(View{}, v); }}};

/// Simulates the nominal vehicle in combined mode. Returns the number of Runge-Kutta steps,
/// assuming that no step is halved.
double drive(const Plant<double>& nominal, const Controller<double>& controller,
             const Scenario& scenario, double sample_time_s) {
  const BatchRun run{nominal, controller, YawMode::kCombined};
  const std::size_t samples = samples_in(scenario.duration_s, sample_time_s);
  ClosedLoop<Counted> loop(
      {&run, 1}, scenario, kCountedSteps,
      {.sample_time_s = sample_time_s, .samples = samples, .has_metrics = true});
  bench::operations = {};
  loop.drive();
  return static_cast<double>(samples) * substeps_for(nominal, scenario, sample_time_s);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto model = read_model(argv[1]);
  const auto gains = read_gains(argv[2]);
  const auto scenario = read_scenario(argv[3]);
  if (!model || !gains || !scenario) return 2;
  const auto nominal = model->plant();
  if (!nominal) return 2;
  const auto controller = make_controller(*nominal, model->vehicle, *gains);
  const double steps = drive(*nominal, controller, *scenario, model->vehicle.sample_time_s);
  const bench::Operations& done = bench::operations;
  const double pairs = std::max(done.sines, done.cosines);
  const double plain = done.additions + done.multiplications + done.divisions + done.roots;
  const double all =
      plain + kPower * done.powers + kSineAndCosine * pairs + kArcTangent * done.arc_tangents;
  fmt::print(
      "{{\"plain\": {:.1f}, \"divisions\": {:.1f}, \"powers\": {:.2f}, \"sine_pairs\": {:.2f}, "
      "\"arc_tangents\": {:.2f}, \"flop\": {:.0f}}}\n",
      plain / steps, done.divisions / steps, done.powers / steps, pairs / steps,
      done.arc_tangents / steps, all / steps);
}
