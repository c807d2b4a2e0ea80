// The C interface over awmr/control/, which is the source that was simulated and tuned.
#include "awmr.h"

#include <stddef.h>

#include "awmr/control/autopilot.h"

namespace {

#if AWMR_RESISTANCE_TABLE
typedef awmr::ResistanceTable Resistance;
const awmr::ResistanceLine kSurgeLines[] AWMR_IN_FLASH = AWMR_SURGE_TABLE_LINES;
const awmr::ResistanceLine kYawLines[] AWMR_IN_FLASH = AWMR_YAW_TABLE_LINES;
const size_t kSurgeCount = AWMR_SURGE_TABLE_COUNT;
const size_t kYawCount = AWMR_YAW_TABLE_COUNT;
#define AWMR_TABLE_SHAPE(name) \
  { name##_COUNT, name##_FIRST, name##_MANTISSA_BITS }
#else
typedef awmr::Resistance<float> Resistance;
const awmr::ResistanceLine* const kSurgeLines = 0;
const awmr::ResistanceLine* const kYawLines = 0;
const size_t kSurgeCount = 0;
const size_t kYawCount = 0;
#define AWMR_TABLE_SHAPE(name) \
  { 0, 0, 0 }
#endif

}  // namespace

// Not static, so that a debugger or a flashing tool finds it by its name.
extern const awmr::ParameterBlock awmr_parameters;
const awmr::ParameterBlock awmr_parameters AWMR_IN_FLASH = {
    {AWMR_SURGE_ALPHA, AWMR_SURGE_BETA},
    {AWMR_YAW_ALPHA, AWMR_YAW_BETA},
    {AWMR_MASS_NORM,
     AWMR_INERTIA_NORM,
     AWMR_HEADING_LAMBDA,
     AWMR_INERTIA_NORM * AWMR_HEADING_LAMBDA,
     AWMR_INERTIA_NORM * (AWMR_HEADING_MU / AWMR_HEADING_EPSILON),
     AWMR_INERTIA_NORM * AWMR_HEADING_MU,
     AWMR_MASS_NORM * (AWMR_SPEED_MU / AWMR_SPEED_EPSILON),
     AWMR_MASS_NORM * AWMR_SPEED_MU,
     {4.0f * AWMR_WHEEL_FORCE_MIN, 4.0f * AWMR_WHEEL_FORCE_MAX, AWMR_WHEEL_FORCE_MIN,
      AWMR_WHEEL_FORCE_MAX, AWMR_HALF_TRACK_M, 0.5f / AWMR_HALF_TRACK_M, 1.0f / AWMR_HALF_TRACK_M,
      2.0f * AWMR_FRONT_AXLE_M, 0.25f / AWMR_FRONT_AXLE_M, 0.5f / AWMR_FRONT_AXLE_M, AWMR_STEERING_MAX_RAD,
      0.5f * AWMR_STEERING_MAX_TAN_HALF,
      0.5f * AWMR_STEERING_MAX_TAN_HALF * (0.5f * AWMR_STEERING_MAX_TAN_HALF)}},
    {AWMR_SPEED_MAX_MPS, AWMR_YAW_RATE_MAX_RADPS, AWMR_HEADING_TIMEOUT_MS, AWMR_SPEED_TIMEOUT_MS,
     AWMR_COMMAND_TIMEOUT_MS, AWMR_STEP_TIMEOUT_MS},
    AWMR_TABLE_SHAPE(AWMR_SURGE_TABLE),
    AWMR_TABLE_SHAPE(AWMR_YAW_TABLE)};

namespace {

awmr::Autopilot<Resistance> autopilot;

}  // namespace

uint8_t awmr_init(void) {
  const bool good =
      awmr::start_autopilot(autopilot, &awmr_parameters, kSurgeLines, kSurgeCount, kYawLines,
                            kYawCount, AWMR_PARAMETERS_CRC32);
  return good ? AWMR_FAULT_NONE : AWMR_FAULT_PARAMETERS;
}

// The C structs have the members of the C++ ones in their order.
static_assert(sizeof(awmr_input) == sizeof(awmr::AutopilotInput), "");
static_assert(offsetof(awmr_input, psi_rad) == offsetof(awmr::AutopilotInput, measured), "");
static_assert(offsetof(awmr_input, x_m) == offsetof(awmr::AutopilotInput, position_m), "");
static_assert(offsetof(awmr_input, psi_ref_rad) == offsetof(awmr::AutopilotInput, reference), "");
static_assert(offsetof(awmr_input, now_ms) == offsetof(awmr::AutopilotInput, times), "");
static_assert(sizeof(awmr_point) == sizeof(awmr::Position<float>), "");
static_assert(sizeof(awmr_output) == sizeof(awmr::AutopilotOutput), "");
static_assert(offsetof(awmr_output, tau_speed) == offsetof(awmr::AutopilotOutput, tau_speed), "");
static_assert(offsetof(awmr_output, arrived) == offsetof(awmr::AutopilotOutput, arrived), "");

// So they are used in place; the barriers keep the compiler from moving what a caller writes before
// or reads after past the call, whatever it knows of the two types.
__attribute__((noinline)) void awmr_step(const awmr_input* input, awmr_output* output) {
  __asm__ volatile("" ::: "memory");
  awmr::autopilot_step(autopilot, *reinterpret_cast<const awmr::AutopilotInput*>(input),
                       *reinterpret_cast<awmr::AutopilotOutput*>(output));
  __asm__ volatile("" ::: "memory");
}

__attribute__((noinline)) void awmr_follow(const awmr_point* points, int16_t count,
                                           float acceptance_m) {
  __asm__ volatile("" ::: "memory");
  const awmr::Waypoints<float> waypoints = {
      reinterpret_cast<const awmr::Position<float>*>(points), count, acceptance_m, false};
  awmr::follow_waypoints(autopilot, waypoints);
}
