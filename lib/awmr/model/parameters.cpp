#include "awmr/model/parameters.h"

namespace awmr {
namespace {

constexpr std::string_view kSurgeTrial =
    "a surge trial: runs at two or more constant thrusts (tau_speed), wheels straight, each with "
    "its steady speed";
constexpr std::string_view kTurningTrial =
    "a turning trial: runs at constant wheel_force and two or more steering angles, each with its "
    "steady yaw rate";

/// The units follow from g1(u) = a1 |u|^b1 sgn u, which is dimensionless, and from
/// g3(r) = a3 |r|^b3 sgn r, which is in m.
constexpr std::array<ParameterInfo, kParameterCount> kTable{{
    {ParameterId::kSurgeAlpha, "surge.alpha", "/surge/alpha", "a1", "(s/m)^b1",
     "surge resistance at 1 m/s, divided by F_max", kSurgeTrial},
    {ParameterId::kSurgeBeta, "surge.beta", "/surge/beta", "b1", "1",
     "exponent of the surge resistance", kSurgeTrial},
    {ParameterId::kYawAlpha, "yaw.alpha", "/yaw/alpha", "a3", "m (s/rad)^b3",
     "yaw resistance at 1 rad/s, divided by F_max", kTurningTrial},
    {ParameterId::kYawBeta, "yaw.beta", "/yaw/beta", "b3", "1", "exponent of the yaw resistance",
     kTurningTrial},
    {ParameterId::kSwayAlpha, "sway.alpha", "/sway/alpha", "a_s", "s/m",
     "linear sway resistance divided by F_max",
     "a driven log with sway_mps; or give sway_alpha in vehicle.json"},
    {ParameterId::kMassNorm, "mass_norm", "/mass_norm", "m'", "s^2/m", "mass divided by F_max",
     "a coast-down trial (initial speed and stop time) together with a surge trial"},
    {ParameterId::kInertiaNorm, "inertia_norm", "/inertia_norm", "I'z", "s^2 m",
     "yaw inertia divided by F_max",
     "a coast-down trial together with a surge trial, which give m' and with it I'z"},
    {ParameterId::kSteeringTimeConstant, "steering.time_constant_s", "/steering/time_constant_s",
     "T", "s", "first-order lag of the steering servo",
     "a log with steering_cmd_deg and steering_deg; or give it in vehicle.json"},
    {ParameterId::kSurgeCoulomb, "surge.coulomb", "/surge/coulomb", "c1", "1",
     "Coulomb part of the surge resistance divided by F_max", kSurgeTrial, true},
    {ParameterId::kSurgeQuadratic, "surge.quadratic", "/surge/quadratic", "q1", "s^2/m^2",
     "quadratic part of the surge resistance divided by F_max", kSurgeTrial, true},
    {ParameterId::kYawCoulomb, "yaw.coulomb", "/yaw/coulomb", "c3", "m",
     "Coulomb part of the yaw resistance divided by F_max", kTurningTrial, true},
    {ParameterId::kYawQuadratic, "yaw.quadratic", "/yaw/quadratic", "q3", "m s^2/rad^2",
     "quadratic part of the yaw resistance divided by F_max", kTurningTrial, true},
    {ParameterId::kWheelDeadZone, "wheel.dead_zone", "/wheel/dead_zone", "F'0", "1",
     "part of each wheel's command without effect, divided by F_max", kSurgeTrial, true},
    {ParameterId::kBackEmf, "motor.back_emf_s_per_m", "/motor/back_emf_s_per_m", "k_e", "s/m",
     "decrease of a motor's force per m/s at its wheel, divided by F_max",
     "a log of driven stretches and, from the same speeds, of coasting with the motors off "
     "(both forces 0)",
     true},
}};

}  // namespace

const std::array<ParameterInfo, kParameterCount>& parameter_table() { return kTable; }

const ParameterInfo& info(ParameterId id) {
  return parameter_table()[static_cast<std::size_t>(id)];
}

std::optional<ParameterId> parameter_by_name(std::string_view name) {
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.name == name) return parameter.id;
  }
  return std::nullopt;
}

}  // namespace awmr
