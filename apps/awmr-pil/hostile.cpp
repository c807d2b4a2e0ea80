#include "hostile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "awmr/core/random.h"

namespace awmr::pil {
namespace {

constexpr int kFields = 11;  ///< floats in an AutopilotInput
constexpr float kAcceptance_m = 1.0F;

/// Candidate of the search: the input of one step, and the points to follow from this step on.
struct Attack {
  AutopilotInput input{};
  Points points;
};

float& field_of(AutopilotInput& in, int field) {
  float* const fields[kFields] = {
      &in.measured.psi_rad,    &in.measured.u_mps,           &in.measured.v_mps,
      &in.measured.r_radps,    &in.position_m.x_m,           &in.position_m.y_m,
      &in.reference.psi_rad,   &in.reference.psi_rate_radps, &in.reference.psi_accel_radps2,
      &in.reference.speed_mps, &in.reference.accel_mps2};
  return *fields[field];
}

/// Largest magnitude of an input field that the safety checks accept.
float largest_of(const SafetyLimits& limits, int field) {
  constexpr float kHeading = 0.5F * float_math::kAngleMax;
  const float largest[kFields] = {kHeading,
                                  limits.speed_max_mps,
                                  limits.speed_max_mps,
                                  limits.yaw_rate_max_radps,
                                  detail::kPositionMax,
                                  detail::kPositionMax,
                                  kHeading,
                                  kReferenceMax,
                                  kReferenceMax,
                                  limits.speed_max_mps,
                                  kReferenceMax};
  return largest[field];
}

/// Random value up to the magnitude `largest`; sometimes `largest`, a subnormal or random bits.
float hostile_value(Random& random, float largest) {
  const float sign = (random.bits() & 1U) != 0 ? -1.0F : 1.0F;
  switch (random.bits() % 32) {
    case 0:
      return sign * 0.0F;
    case 1:
      return sign * largest;
    case 2:
      return std::bit_cast<float>(random.bits() & 0x807FFFFFU);
    case 3:
      return std::bit_cast<float>(random.bits());
    default:
      // Magnitude log-uniform over eight decades below `largest`.
      return sign * largest * static_cast<float>(std::pow(10.0, -8.0 * random.uniform()));
  }
}

/// Returns a random waypoint, usually so near to the vehicle that it counts as reached at once. The
/// step then also evaluates the next waypoint, so it takes longer.
Position<float> hostile_point(Random& random, const Position<float>& vehicle_m) {
  const float reach_m = random.bits() % 8 == 0 ? 1000.0F : kAcceptance_m;
  const auto off = [&] { return reach_m * static_cast<float>(2.0 * random.uniform() - 1.0); };
  return {vehicle_m.x_m + off(), vehicle_m.y_m + off()};
}

/// Sets the time stamp of the GPS fix. Usually the fix is new, with an age of up to 2 s. Sometimes
/// its time is random, or the last fix is repeated.
void receive_fix(AutopilotInput& in, Random& random) {
  in.position_is_fix = 1;
  const std::uint32_t kind = random.bits() % 8;
  if (kind < 2) return;
  in.fix_ms = kind == 2 ? random.bits() : in.times.now_ms - random.bits() % 2000;
}

/// Returns `best` with one to three of its input fields and a few of its points redrawn; sometimes
/// all of them.
Attack changed(const Attack& best, const SafetyLimits& limits, bool has_fixes, Random& random) {
  Attack attack = best;
  const std::uint32_t changes = random.bits() % 8 == 0 ? kFields : 1 + random.bits() % 3;
  for (std::uint32_t i = 0; i < changes; ++i) {
    const int field =
        changes == kFields ? static_cast<int>(i) : static_cast<int>(random.bits() % kFields);
    field_of(attack.input, field) = hostile_value(random, largest_of(limits, field));
  }
  for (Position<float>& point : attack.points.points_m) {
    if (changes == kFields || random.bits() % 8 == 0) {
      point = hostile_point(random, attack.input.position_m);
    }
  }
  if (has_fixes) receive_fix(attack.input, random);
  return attack;
}

bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

bool same(const AutopilotOutput& a, const AutopilotOutput& b) {
  return same(a.command.force.left, b.command.force.left) &&
         same(a.command.force.right, b.command.force.right) &&
         same(a.command.steering_rad, b.command.steering_rad) && same(a.tau_speed, b.tau_speed) &&
         same(a.tau_turn_m, b.tau_turn_m) && same(a.psi_ref_rad, b.psi_ref_rad) &&
         a.arrived == b.arrived && a.fault == b.fault &&
         a.command.speed_limited == b.command.speed_limited &&
         a.command.steering_limited == b.command.steering_limited &&
         a.command.force_limited == b.command.force_limited &&
         a.command.steering_powerless == b.command.steering_powerless;
}

/// Executes one step on chip and host; adds the result to `found`. Returns the chip's cycles.
Result<unsigned> tried(Executor& chip, Executor& host, const Attack& attack, Hostile& found) {
  if (!attack.points.points_m.empty()) {
    AWMR_RETURN_IF_ERROR(chip.follow(attack.points));
    AWMR_RETURN_IF_ERROR(host.follow(attack.points));
  }
  AWMR_ASSIGN_OR_RETURN(const Step on_chip, chip.step(attack.input));
  AWMR_ASSIGN_OR_RETURN(const Step on_host, host.step(attack.input));
  ++found.steps;
  if (!same(on_chip.output, on_host.output)) ++found.differing;
  const unsigned cycles = on_chip.cycles.value_or(0);
  found.cycles = std::max(found.cycles, cycles);
  return cycles;
}

}  // namespace

Result<Hostile> provoke(Executor& chip, Executor& host, const SafetyLimits& limits,
                        const Mission& mission, const HostileSearch& search,
                        const Progress& progress) {
  Hostile found;
  // First, a step that is not counted clears the memory of the run before, on chip and host: its
  // invalid mode raises a fault. All steps of the search have the time 0.
  AutopilotInput first{};
  first.mode = 3;
  AWMR_RETURN_IF_ERROR(chip.step(first));
  AWMR_RETURN_IF_ERROR(host.step(first));
  constexpr std::uint8_t kModes = static_cast<std::uint8_t>(YawMode::kCombined) + 1;
  const std::size_t steps_per_mode = (search.steps + kModes - 1) / kModes;
  for (std::uint8_t mode = 0; mode < kModes; ++mode) {
    Random random(1, mode);
    Attack best;
    best.input.mode = mode;
    if (!mission.points.points_m.empty()) {
      // Firmware without optional parts stores up to kMaxPoints points; with optional parts, only
      // as many as the mission has.
      best.points.points_m.resize(parts_of(mission).empty() ? kMaxPoints
                                                            : mission.points.points_m.size());
      if (!mission.line) best.points.acceptance_m = kAcceptance_m;
    }
    unsigned most = 0;
    for (std::size_t i = 0; i < steps_per_mode; ++i) {
      const Attack attack = changed(best, limits, search.has_fixes, random);
      AWMR_ASSIGN_OR_RETURN(const unsigned cycles, tried(chip, host, attack, found));
      if (progress) progress(mode * steps_per_mode + i + 1, kModes * steps_per_mode);
      if (cycles < most) continue;
      most = cycles;
      best = attack;
    }
  }
  return found;
}

}  // namespace awmr::pil
