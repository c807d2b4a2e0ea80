// Counts the arithmetic operations of a closed loop per Runge-Kutta step, including the control
// laws, the allocation and the metrics, as a mean over the run of the nominal vehicle. Prints JSON
// for scripts/bench. usage: step_budget MODEL.json GAINS.json SCENARIO.json
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "counted.h"
// The scalar type must be declared before the templates that are instantiated with it.
#include "awmr/control/control_step.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/rest.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario_file.h"
#include "closed_loop.h"

namespace {

using namespace awmr;
using bench::Counted;

/// Cost of functions in a batch (lib/awmr/simulate/lanes/lane_math.h), in additions,
/// multiplications, divisions and roots; an FMA counts as two. Sine and cosine of an angle are
/// computed together. A polynomial of n coefficients is n - 1 FMAs.
///   pow      3 + 1 + 2 + 3 FMAs and a polynomial of 7, of the logarithm; 1; 3 and a polynomial of 12
///   sin, cos 1 + 4 FMAs, 3 products, 3 FMAs and two polynomials of 6
///   atan     4 + 1 + 3, an FMA and a polynomial of 11
constexpr double kPower = 48.0;
constexpr double kSineAndCosine = 38.0;
constexpr double kArcTangent = 31.0;

/// Converts a struct to counted scalars.
template <class Of, class From>
Of counted(const From& numbers) {
  static_assert(sizeof(Counted) == sizeof(double));
  return std::bit_cast<Of>(numbers);
}

/// Number of Runge-Kutta steps of the run.
double drive(const Plant<double>& nominal, const Controller<double>& controller,
             const Scenario& scenario, double sample_time_s) {
  const int substeps = substeps_for(nominal, sample_time_s);
  const double step_s = sample_time_s / substeps;
  const auto plant = counted<Plant<Counted>>(resolved_at_rest(nominal, step_s));
  const auto laws = counted<PreparedController<Counted>>(prepared(controller));
  const auto vehicle = counted<MetricsVehicle<Counted>>(metered_vehicle(controller.limits));
  double steps = 0.0;
  const auto command = [&](const Measurement<Counted>& measured,
                           const Reference<Counted>& reference) {
    Allocation<Counted> a;
    allocate(kFourWheelSteering, yaw_split<Counted>(YawMode::kCombined, controller.limits.split),
             speed_law(laws, measured, reference), heading_law(laws, measured, reference),
             laws.constants.allocation, a);
    return a;
  };
  const auto move = [&](double, const Allocation<Counted>& a, State<Counted>& state) {
    Resolution<Counted> resolution;
    integrate(
        plant, Counted(step_s), Counted(substeps),
        [&](const State<Counted>& at) { return state_rates(plant, at, a.force, a.steering_rad); },
        true, state, resolution);
    steps += substeps + resolution.halves.value();
  };
  bench::operations = {};
  bench::driven<Counted>(scenario, sample_time_s, laws.yaw, vehicle, command, move);
  return steps;
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
