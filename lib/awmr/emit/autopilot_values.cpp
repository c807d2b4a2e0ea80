/// Computes the parameters of ArduPilot Rover and of PX4's rovers from a model.
///
/// Throttle and steering of these autopilots are in [-1, 1], like the wheel force F' (divided by
/// the largest force F_max). At constant speed u and yaw rate r, with the model's symbols (d: half
/// track, l_f: centre of gravity to front axle, d_r: steering angle, g1, g3: resistances):
///
///     throttle = F' of every wheel                              4 F' = g1(u)
///     skid steering s: F'L = throttle + s, F'R = throttle - s   4 d s = g3(r)
///     steered wheels:  d_r = steering times the stop            l_f g1(u) tan(d_r/2) = g3(r)
///
/// The equations for skid steering and for steered wheels follow from (41) of the paper for turns
/// in the positive direction. The autopilots' laws are in ArduPilot's
/// libraries/APM_Control/AR_AttitudeControl.cpp (get_throttle_out_speed, get_steering_out_rate) and
/// AR_Motors/AP_MotorsUGV.cpp, and in PX4's src/lib/rover_control/RoverControl.cpp (speedControl,
/// rateControl) and rovercontrol_params.yaml.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/validity.h"
#include "exported_values.h"
#include "of_plant.h"

namespace awmr {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

double steady_or_never(const Resistance<double>& law, double force) {
  return steady_rate(law, force).value_or(kNever);
}

/// Collects the values of an autopilot's parameters, and the parameters without a value.
struct Autopilot {
  const ExportSource& source;
  AutopilotValues found = {};

  const Vehicle& vehicle() const { return source.model.vehicle; }
  /// The mode in which the autopilot turns the vehicle.
  YawMode mode() const {
    return vehicle().has_steering() ? YawMode::kSteering : YawMode::kDifferential;
  }
  bool knows(ParameterId id) const { return source.model[id].value.has_value(); }

  /// Adds a positive number computed from the plant, with an interval that is symmetric in its
  /// logarithm. `usual`: range in the autopilot's documentation; a number outside of it is exported
  /// with a remark.
  void add(const char* name, const char* unit, std::string derivation, const OfPlant& f,
           std::optional<Interval> usual = {}) {
    const double value = f(source.model.plant_as_known());
    if (!(value > 0.0) || !std::isfinite(value)) {
      return leave_out(name,
                       "according to the model, the motors do not overcome friction at the "
                       "operating point of this parameter");
    }
    if (usual && !usual->contains(value)) {
      derivation += fmt::format(", outside of [{:g}, {:g}], the range in the autopilot's manual",
                                usual->lo, usual->hi);
      found.beyond_range.push_back(
          fmt::format("{} = {:.3g} ({:g} to {:g})", name, value, usual->lo, usual->hi));
    }
    ExportedValue one{.name = name,
                      .value = value,
                      .unit = unit,
                      .meaning = std::move(derivation),
                      .origin = "derived",
                      .std_error = std_error_of(source.model, f)};
    if (one.std_error) {
      constexpr double kNormal95 = 1.96;
      const double factor = std::exp(kNormal95 * *one.std_error / value);
      if (std::isfinite(value * factor)) one.ci95 = Interval{value / factor, value * factor};
    }
    found.values.push_back(std::move(one));
  }
  void leave_out(const char* name, const char* why) {
    found.left_out.push_back(fmt::format("{}: {}", name, why));
  }
};

constexpr const char* kNoGains = "it is computed from gains, but none were given (option --gains)";
constexpr const char* kNoMass = "the model lacks mass_norm";
constexpr const char* kNoInertia = "the model lacks inertia_norm";
constexpr const char* kNoYaw = "the model lacks the yaw law";

bool knows_yaw(const Autopilot& pilot) {
  return pilot.knows(ParameterId::kYawAlpha) && pilot.knows(ParameterId::kYawBeta);
}

/// Returns the steady speed u for a throttle F', at which the surge resistance equals the force of
/// four motors: g1(u) = 4 (F' minus the dead zone of the motors). NaN if the force does not
/// overcome friction.
double speed_at(const Plant<double>& plant, double throttle) {
  return steady_or_never(plant.surge, 4.0 * beyond_dead_zone(throttle, plant.wheel_dead_zone));
}

/// Adds the gains of the autopilot's speed loop, a PI controller of the throttle with the gains K_p
/// and K_i. The closed loop gets the time constant T that awmr's speed law (gains mu_s, eps_s) has
/// inside its boundary layer:
///   T = eps_s/mu_s,   K_p = m'/(4 T),   K_i = g1'(u)/(4 T),   g1' = dg1/du
/// m': mass divided by F_max, g1: surge resistance. The zero of the PI controller then cancels the
/// pole of the plant, m' du/dt = 4 dF' - g1'(u) du. [Skogestad 2003, J. Process Control 13, 291]
void add_speed_loop(Autopilot& pilot, const char* p, const char* i, double throttle,
                    std::optional<Interval> usual = {}) {
  if (!pilot.source.gains || !pilot.knows(ParameterId::kMassNorm)) {
    const char* why = pilot.source.gains ? kNoMass : kNoGains;
    pilot.leave_out(p, why);
    return pilot.leave_out(i, why);
  }
  const SpeedGains<double> gains = pilot.source.gains->in(pilot.mode()).speed;
  const double closed_s = gains.epsilon / gains.mu;
  pilot.add(
      p, "1/(m/s)",
      fmt::format("m'/(4 T); m': mass divided by F_max; T = eps_s/mu_s = {:.4g} s: time constant "
                  "of the closed speed loop (eps_s, mu_s: gains of the speed law)",
                  closed_s),
      [closed_s](const Plant<double>& plant) { return plant.mass_norm / (4.0 * closed_s); }, usual);
  pilot.add(
      i, "1/m",
      fmt::format("g1'(u)/(4 T); g1'(u): slope of the surge resistance at the speed u of throttle "
                  "{:g}; T: time constant of the closed speed loop",
                  throttle),
      [closed_s, throttle](const Plant<double>& plant) {
        return slope(plant.surge, speed_at(plant, throttle)) / (4.0 * closed_s);
      },
      usual);
}

/// If the gains were tuned with a disturbance observer, lists it among the parameters left out.
void leave_out_observer(Autopilot& pilot) {
  if (!pilot.source.gains || !pilot.source.gains->in(pilot.mode()).observer.is_on()) return;
  pilot.leave_out("the disturbance observer",
                  "the gains were tuned with this observer, which the autopilot does not have; the "
                  "autopilot's integrators replace the observer");
}

Status check_surge(const Model& model) {
  AWMR_RETURN_IF_ERROR(model.plant(Motion::kSteadySurge));
  if (model.vehicle.driven_wheels() != 4) {
    return input_error(ErrorCode::kUnsupported, model.file + ":/vehicle/drive",
                       "the parameters of an autopilot can be derived for four driven wheels only; "
                       "use the format ros2, matlab, python or csv");
  }
  const double back_emf = model[ParameterId::kBackEmf].value.value_or(0.0);
  if (!(back_emf > 0.0)) return {};
  return input_error(
      ErrorCode::kUnsupported,
      fmt::format("{}:{}", model.file, info(ParameterId::kBackEmf).pointer),
      fmt::format(
          "the parameters of an autopilot would neglect the motors' back-EMF of {:.3g} s/m; use "
          "the format ros2, matlab, python or csv",
          back_emf));
}

/// Adds ATC_STR_RAT_FF: ArduPilot's steering output s divided by the yaw rate r that it causes, at
/// half of the largest output.
void add_steering_feed_forward(Autopilot& pilot, double throttle) {
  constexpr const char* kName = "ATC_STR_RAT_FF";
  constexpr Interval kUsual{0.0, 3.0};
  if (!knows_yaw(pilot)) return pilot.leave_out(kName, kNoYaw);
  if (!pilot.vehicle().has_steering()) {
    // s/r: steering output s divided by the yaw rate r. At a constant yaw rate, the yaw moment 4 d
    // s equals the yaw resistance g3(r) (d: half of the track width).
    const double s = 0.5 * pilot.vehicle().wheel_force.hi;
    pilot.add(
        kName, "1/(rad/s)",
        fmt::format("s/r at the steering output s = {:g}; r: steady yaw rate, at which the yaw "
                    "moment 4 d s equals the yaw resistance g3(r); d: half of the track width",
                    s),
        [s](const Plant<double>& plant) {
          return s / steady_or_never(plant.yaw, 4.0 * plant.half_track_m * s);
        },
        kUsual);
    return;
  }
  // s/r: steering output s divided by the yaw rate r. At a constant yaw rate, the yaw moment of the
  // steering, l_f g1(u) tan(s d_max/2), equals the yaw resistance g3(r). Above MOT_SPD_SCA_BASE = 1
  // m/s, ArduPilot divides the output by the speed u, so the value is multiplied by u.
  pilot.add(
      kName, "1/(rad/s)",
      "s/r at the steering output s = 0.5, multiplied by u if u is above MOT_SPD_SCA_BASE = 1 m/s; "
      "r: yaw rate at which the yaw moment of the steering, l_f g1(u) tan(s d_max/2), equals the "
      "yaw resistance g3(r) at the speed u = CRUISE_SPEED; l_f: centre of gravity to front axle, "
      "g1: surge resistance, d_max: steering stop",
      [throttle](const Plant<double>& plant) {
        const double u = speed_at(plant, throttle);
        const double moment =
            plant.front_axle_m * plant.surge.at(u) * std::tan(0.25 * plant.steering_max_rad);
        return 0.5 / steady_or_never(plant.yaw, moment) * std::max(1.0, u);
      },
      kUsual);
}

/// Steady yaw rate r at the largest steering command, but at most the highest yaw rate at which
/// resistance was measured. d: half track, l_f: centre of gravity to front axle, d_max: steering
/// stop:
///   skid:     g3(r) = 2 d (F'max - F'min)
///   steered:  g3(r) = 2 l_f F'max sin d_max
double largest_yaw_rate(const Plant<double>& plant, const Vehicle& vehicle,
                        std::optional<double> measured_degps) {
  const Interval& force = vehicle.wheel_force;
  const double moment =
      vehicle.has_steering()
          ? steering_moment_m(plant.front_axle_m, force.hi, plant.steering_max_rad)
          : differential_moment_m(plant.half_track_m, force.hi - force.lo);
  const double rate = steady_or_never(plant.yaw, moment);
  return measured_degps ? std::min(rate, radians(*measured_degps)) : rate;
}

/// Adds the gains K_p and K_i of PX4's yaw-rate loop for skid steering. The closed loop gets the
/// time constant T that the yaw rate has with awmr's heading law inside the boundary layer:
///   T = 1/(lambda + mu/epsilon),   K_p = I'z/(4 d T),   K_i = g3'(r)/(4 d T),   g3' = dg3/dr
void add_skid_rate_loop(Autopilot& pilot, const OfPlant& rate) {
  const bool known = pilot.source.gains && pilot.knows(ParameterId::kInertiaNorm);
  if (!known) {
    const char* why = pilot.source.gains ? kNoInertia : kNoGains;
    pilot.leave_out("RO_YAW_RATE_P", why);
    return pilot.leave_out("RO_YAW_RATE_I", why);
  }
  const HeadingGains<double> gains = pilot.source.gains->in(YawMode::kDifferential).heading;
  const double closed_s = 1.0 / (gains.lambda + gains.mu / gains.epsilon);
  pilot.add("RO_YAW_RATE_P", "1/(rad/s)",
            fmt::format("RO_YAW_RATE_P = I'z/(4 d T); I'z: yaw inertia divided by F_max; d: half "
                        "of the track width; T = {:.4g} s: time constant of the closed yaw-rate "
                        "loop, 1/(lambda + mu/epsilon) with the gains of the heading law",
                        closed_s),
            [closed_s](const Plant<double>& plant) {
              return plant.inertia_norm / (4.0 * plant.half_track_m * closed_s);
            });
  pilot.add("RO_YAW_RATE_I", "1/rad",
            "RO_YAW_RATE_I = g3'(r)/(4 d T); g3'(r): slope of the yaw resistance at the yaw rate "
            "r, half of RO_YAW_RATE_LIM; d: half of the track width; T: time constant of the "
            "closed yaw-rate loop",
            [closed_s, rate](const Plant<double>& plant) {
              return slope(plant.yaw, 0.5 * rate(plant)) / (4.0 * plant.half_track_m * closed_s);
            });
}

/// Adds the parameters of a skid-steered rover. PX4's feed-forward of the steering output is s =
/// RO_YAW_RATE_CORR r d/u_max, with u_max = RO_MAX_THR_SPEED. In the model, the yaw moment 4 d s
/// must equal the yaw resistance g3(r) (d: half of the track width), so that
///   RO_YAW_RATE_CORR = g3(r) u_max/(4 d^2 r)
void add_skid(Autopilot& pilot, const OfPlant& rate) {
  pilot.add("RD_WHEEL_TRACK", "m", "2 d; d: half track",
            [](const Plant<double>& plant) { return 2.0 * plant.half_track_m; });
  pilot.add("RO_YAW_RATE_CORR", "1",
            "RO_YAW_RATE_CORR = g3(r) RO_MAX_THR_SPEED/(4 d^2 r); g3: yaw resistance divided by "
            "F_max, d: half of the track width, r: half of RO_YAW_RATE_LIM",
            [rate](const Plant<double>& plant) {
              const double r = 0.5 * rate(plant);
              const double d = plant.half_track_m;
              return plant.yaw.at(r) * speed_at(plant, 1.0) / (4.0 * d * d * r);
            });
  add_skid_rate_loop(pilot, rate);
}

void add_steered(Autopilot& pilot) {
  pilot.add("RA_MAX_STR_ANG", "rad", "d_max: steering stop",
            [](const Plant<double>& plant) { return plant.steering_max_rad; });
  pilot.add("RA_STR_RATE_LIM", "deg/s", "largest rate of the steering angle",
            [](const Plant<double>& plant) { return degrees(plant.steering_max_rate_radps); });
  pilot.leave_out("RA_WHEEL_BASE",
                  "the model has only the front axle's position; measure the wheelbase");
  for (const char* name : {"RO_YAW_RATE_CORR", "RO_YAW_RATE_P", "RO_YAW_RATE_I"}) {
    pilot.leave_out(
        name,
        "corrects the steering angle that PX4 computes from the wheelbase; tune this value in "
        "Acro mode");
  }
}

std::string extrapolated(const Model& model) {
  double reached = 0.0;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kSurge) reached = std::max(reached, trial.input);
  }
  if (!(reached > 0.0) || reached >= 4.0) return "";
  return fmt::format("; extrapolated: the trials reach only tau_speed {:g}; verify by a drive",
                     reached);
}

}  // namespace

Result<AutopilotValues> ardupilot_values(const ExportSource& source) {
  AWMR_RETURN_IF_ERROR(check_surge(source.model));
  Autopilot pilot{source};
  // CRUISE_THROTTLE is in whole percent.
  const double percent = std::max(1.0, std::round(50.0 * pilot.vehicle().wheel_force.hi));
  const double throttle = 0.01 * percent;
  pilot.add("CRUISE_THROTTLE", "%", "half of the largest wheel force, in whole percent",
            [percent](const Plant<double>&) { return percent; });
  pilot.add("CRUISE_SPEED", "m/s",
            "speed u at which the surge resistance g1(u) equals the force 4 F' of CRUISE_THROTTLE",
            [throttle](const Plant<double>& plant) { return speed_at(plant, throttle); });
  add_speed_loop(pilot, "ATC_SPEED_P", "ATC_SPEED_I", throttle, Interval{0.0, 2.0});
  add_steering_feed_forward(pilot, throttle);
  pilot.leave_out("ATC_SPEED_FF",
                  "CRUISE_THROTTLE/CRUISE_SPEED is the feed-forward; leave it at 0");
  pilot.leave_out("ATC_STR_RAT_P, _I, _D", "they depend on filters and delays of the autopilot");
  leave_out_observer(pilot);
  return std::move(pilot.found);
}

Result<AutopilotValues> px4_values(const ExportSource& source) {
  AWMR_RETURN_IF_ERROR(check_surge(source.model));
  Autopilot pilot{source};
  pilot.add("RO_MAX_THR_SPEED", "m/s",
            "speed u at which the surge resistance g1(u) equals the largest force 4 F' (F' = 1)" +
                extrapolated(source.model),
            [](const Plant<double>& plant) { return speed_at(plant, 1.0); });
  add_speed_loop(pilot, "RO_SPEED_P", "RO_SPEED_I", 0.5 * pilot.vehicle().wheel_force.hi);
  leave_out_observer(pilot);
  if (!knows_yaw(pilot)) {
    pilot.leave_out("RO_YAW_RATE_LIM, _CORR, _P, _I", kNoYaw);
    return std::move(pilot.found);
  }
  const auto measured_degps = measured_yaw_rate_degps(source.model);
  const OfPlant rate = [&vehicle = source.model.vehicle,
                        measured_degps](const Plant<double>& plant) {
    return largest_yaw_rate(plant, vehicle, measured_degps);
  };
  pilot.add(
      "RO_YAW_RATE_LIM", "deg/s",
      "yaw rate r at which the yaw resistance g3(r) equals the largest yaw moment, but at most "
      "the highest yaw rate at which resistance was measured",
      [rate](const Plant<double>& plant) { return degrees(rate(plant)); });
  if (pilot.vehicle().has_steering()) {
    add_steered(pilot);
  } else {
    add_skid(pilot, rate);
  }
  return std::move(pilot.found);
}

}  // namespace awmr
