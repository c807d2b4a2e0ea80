// Searches for the cause of a drive that differs from the prediction: a single change of the
// vehicle, its sensors, or the forces on it.
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/core/units.h"
#include "awmr/validate/drive_series.h"

namespace awmr {
namespace {

/// Model and scenario, changed by a fault hypothesis.
struct PerturbedModel {
  Model model;
  Scenario scenario;
};

/// A fault hypothesis to be tried: a change of the model or the scenario by one value.
struct Change {
  std::string what;
  std::string unit;
  Interval range;  ///< range of the search; factors are searched in the logarithm
  double none;     ///< value without effect: 1 for a factor, else 0
  std::function<void(PerturbedModel&, double value)> apply;
  bool is_factor() const { return unit == "times"; }
};

/// Search for the value of a change: range of factors, number of grid points, accuracy in bits.
constexpr Interval kFactor{0.25, 4.0};
constexpr int kGrid = 9;
constexpr int kBits = 10;
/// A hypothesis is reported if it removes at least this fraction of the sum of squared distances;
/// at most kMaxNamed hypotheses are reported.
constexpr double kWorthNaming = 0.3;
constexpr std::size_t kMaxNamed = 4;

void add_parameters(const Model& model, std::vector<Change>& changes) {
  for (const ParameterInfo& parameter : parameter_table()) {
    const ParameterId id = parameter.id;
    // Exponents are not varied: a changed exponent and a changed coefficient have similar effects.
    const bool exponent = id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
    if (exponent || !model[id].value || *model[id].value <= 0.0) continue;
    changes.push_back({std::string(parameter.name), "times", kFactor, 1.0,
                       [id](PerturbedModel& v, double f) { *v.model[id].value *= f; }});
  }
}

WheelFault all_the_time(std::vector<Wheel> wheels, double share) {
  return {.wheels = std::move(wheels), .window = {}, .share = share};
}

void add_motors(std::vector<Change>& changes) {
  const auto add = [&](const char* what, std::vector<Wheel> wheels) {
    changes.push_back({what, "times", {0.3, 1.5}, 1.0, [wheels](PerturbedModel& v, double share) {
                         v.scenario.faults.push_back(all_the_time(wheels, share));
                       }});
  };
  add("force of all motors",
      {Wheel::kFrontLeft, Wheel::kFrontRight, Wheel::kRearLeft, Wheel::kRearRight});
  add("force of the left motors", {Wheel::kFrontLeft, Wheel::kRearLeft});
  add("force of the right motors", {Wheel::kFrontRight, Wheel::kRearRight});
  changes.push_back(
      {"lag of the motors", "s", {0.0, 0.5}, 0.0, [](PerturbedModel& v, double lag_s) {
         if (lag_s > 0.0) v.scenario.actuators->motor_time_constant_s = lag_s;
       }});
}

void add_sensors(std::vector<Change>& changes) {
  const auto add = [&](const char* sensor, Channel Sensors::*which, const char* unit,
                       double to_unit, double most) {
    changes.push_back({std::string("bias of the ") + sensor,
                       unit,
                       {-most, most},
                       0.0,
                       [=](PerturbedModel& v, double bias) {
                         ((*v.scenario.sensors).*which).bias += bias / to_unit;
                       }});
    changes.push_back({std::string("latency of the ") + sensor,
                       "s",
                       {0.0, 0.5},
                       0.0,
                       [=](PerturbedModel& v, double latency_s) {
                         if (latency_s > 0.0) ((*v.scenario.sensors).*which).latency_s = latency_s;
                       }});
  };
  add("heading", &Sensors::heading, "deg", degrees(1.0), 30.0);
  add("yaw rate", &Sensors::yaw_rate, "deg/s", degrees(1.0), 20.0);
  add("speed", &Sensors::speed, "m/s", 1.0, 0.5);
}

void add_pushes(const Model& model, std::vector<Change>& changes) {
  changes.push_back({"constant longitudinal force",
                     "F_max",
                     {-1.0, 1.0},
                     0.0,
                     [](PerturbedModel& v, double value) {
                       v.scenario.disturbance.surge.push_back(
                           {.value = value, .window = {}, .phase_rad = {}});
                     }});
  const double most_m = model.vehicle.half_track_m;
  changes.push_back(
      {"constant yaw moment", "m", {-most_m, most_m}, 0.0, [](PerturbedModel& v, double value) {
         v.scenario.disturbance.yaw.push_back({.value = value, .window = {}, .phase_rad = {}});
       }});
}

std::vector<Change> changes_of(const Model& model) {
  std::vector<Change> changes;
  add_parameters(model, changes);
  add_motors(changes);
  add_sensors(changes);
  add_pushes(model, changes);
  return changes;
}

Scenario without_noise(Scenario scenario) {
  for (const auto which : {&Sensors::heading, &Sensors::yaw_rate, &Sensors::speed}) {
    ((*scenario.sensors).*which).noise = 0.0;
    ((*scenario.sensors).*which).quantum = 0.0;
  }
  return scenario;
}

/// Search for the value of a change with which the simulated drive is nearest to the logged drive.
struct Search {
  const Model& model;
  const Controller<double>& controller;
  Scenario scenario;  ///< the scenario of the drive without noise
  const AcceptanceOptions& options;
  double duration_s;
  const std::vector<ComparedChannel>& channels;

  /// Mean over the windows of the squared distance between the drive and the run of the changed
  /// vehicle, summed over channels. The largest double if the run fails.
  double distance(const Change& change, double value) const {
    constexpr double kNever = std::numeric_limits<double>::max();
    PerturbedModel changed{model, scenario};
    change.apply(changed, value);
    const auto plant = changed.model.plant();
    if (!plant) return kNever;
    const double sample_s = model.vehicle.sample_time_s;
    const Run run = simulate(*plant, controller, changed.scenario, options.mode,
                             {.sample_time_s = sample_s, .substeps = {}, .seed = options.seed});
    if (run.end == RunEnd::kFailed) return kNever;
    double sum = 0.0;
    for (const ComparedChannel& one : channels) {
      const WindowMeans windows = means_of(one.channel, run, sample_s, duration_s, nullptr);
      for (std::size_t w = 0; w < windows.mean.size(); ++w) {
        if (windows.rows[w] == 0) continue;
        const double apart = one.measured.mean[w] - windows.mean[w];
        sum +=
            std::pow(apart / one.predicted.spread[w], 2) / static_cast<double>(windows.mean.size());
      }
    }
    return std::isfinite(sum) ? sum : kNever;
  }

  /// Searches the best value: first on a grid, because the distance can have several minima, then
  /// between the neighbours of the best grid point.
  FaultHypothesis best(const Change& change, double unchanged) const {
    const auto to = [&](double value) { return change.is_factor() ? std::log(value) : value; };
    const auto from = [&](double z) { return change.is_factor() ? std::exp(z) : z; };
    const double lo = to(change.range.lo);
    const double step = (to(change.range.hi) - lo) / (kGrid - 1);
    const auto cost = [&](double z) { return distance(change, from(z)); };
    int nearest = 0;
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i < kGrid; ++i) {
      if (const double here = cost(lo + i * step); here < least) {
        least = here;
        nearest = i;
      }
    }
    std::uintmax_t evaluations = 20;
    const auto [z, found] = boost::math::tools::brent_find_minima(
        cost, lo + std::max(0, nearest - 1) * step, lo + std::min(kGrid - 1, nearest + 1) * step,
        kBits, evaluations);
    return {change.what, from(z), change.unit, 1.0 - std::min(found, unchanged) / unchanged};
  }
};

}  // namespace

std::vector<FaultHypothesis> fault_hypotheses(const Model& model,
                                              const Controller<double>& controller,
                                              const Scenario& scenario,
                                              const AcceptanceOptions& options, double duration_s,
                                              const std::vector<ComparedChannel>& channels) {
  const Search search{model, controller, without_noise(scenario), options, duration_s, channels};
  const std::vector<Change> changes = changes_of(model);
  const double unchanged = search.distance(changes.front(), changes.front().none);
  std::vector<FaultHypothesis> hypotheses(changes.size());
  parallel_for(changes.size(), options.threads,
               [&](std::size_t i) { hypotheses[i] = search.best(changes[i], unchanged); });
  std::stable_sort(
      hypotheses.begin(), hypotheses.end(),
      [](const FaultHypothesis& a, const FaultHypothesis& b) { return a.explained > b.explained; });
  std::erase_if(hypotheses,
                [](const FaultHypothesis& one) { return one.explained < kWorthNaming; });
  if (hypotheses.size() > kMaxNamed) hypotheses.resize(kMaxNamed);
  return hypotheses;
}

}  // namespace awmr
