// C interface to the controller in awmr/control/, whose source is that of simulation and tuning.

// Disables fused multiply-add, which rounds a b + c once instead of twice. With it, the chip's
// results would differ from those of the simulation.
#if defined(__FAST_MATH__)
#error "awmr: compile without -ffast-math; it hides infinities and NaN, and changes the results"
#elif defined(__clang__)
#pragma clang fp contract(off)
#elif !defined(__AVR__)
#pragma GCC optimize("fp-contract=off")
#endif

#include "awmr.h"

#include <stddef.h>

#include "awmr/control/autopilot.h"

// 1: awmr_input.speed_unsigned may be 1; the autopilot then computes the direction of travel. 0:
// saves flash, for a speed sensor with a sign; speed_unsigned = 1 is then a fault.
#ifndef AWMR_WITH_DIRECTION
#define AWMR_WITH_DIRECTION 1
#endif

namespace {

#if AWMR_RESISTANCE_TABLE
#if AWMR_FRICTION_AT_REST
typedef awmr::RestingTable Resistance;
#else
typedef awmr::ResistanceTable Resistance;
#endif
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

// Not static, so that debuggers and flashing tools find the parameters by name.
extern const awmr::ParameterBlock awmr_parameters;
const awmr::ParameterBlock awmr_parameters AWMR_IN_FLASH = {
    {AWMR_SURGE_ALPHA, AWMR_SURGE_BETA},
    {AWMR_YAW_ALPHA, AWMR_YAW_BETA},
    {AWMR_MASS_NORM,
     AWMR_INERTIA_NORM,
     {AWMR_HEADING_LAMBDA,
      AWMR_INERTIA_NORM * AWMR_HEADING_LAMBDA,
      AWMR_INERTIA_NORM * (AWMR_HEADING_MU / AWMR_HEADING_EPSILON),
      AWMR_INERTIA_NORM * AWMR_HEADING_MU,
      AWMR_MASS_NORM * (AWMR_SPEED_MU / AWMR_SPEED_EPSILON),
      AWMR_MASS_NORM * AWMR_SPEED_MU},
     {4.0f * AWMR_ALLOCATED_FORCE_MIN, 4.0f * AWMR_ALLOCATED_FORCE_MAX, AWMR_ALLOCATED_FORCE_MIN,
      AWMR_ALLOCATED_FORCE_MAX, AWMR_FRONT_AXLE_M, AWMR_HALF_TRACK_M, 1.0f / AWMR_HALF_TRACK_M,
      AWMR_STEERING_MAX_RAD, AWMR_STEERING_MAX_TAN_HALF}},
    {AWMR_SPEED_MAX_MPS, AWMR_YAW_RATE_MAX_RADPS, AWMR_HEADING_TIMEOUT_MS, AWMR_SPEED_TIMEOUT_MS,
     AWMR_COMMAND_TIMEOUT_MS, AWMR_STEP_TIMEOUT_MS},
    AWMR_TABLE_SHAPE(AWMR_SURGE_TABLE),
    AWMR_TABLE_SHAPE(AWMR_YAW_TABLE)};

#if AWMR_FRICTION_AT_REST
extern const awmr::RestBlock awmr_rest;
const awmr::RestBlock awmr_rest AWMR_IN_FLASH = {AWMR_DEAD_ZONE, AWMR_SURGE_REST_SPEED,
                                                 AWMR_SURGE_AT_REST, AWMR_YAW_REST_SPEED,
                                                 AWMR_YAW_AT_REST, AWMR_BACK_EMF_S_PER_M};
#define AWMR_REST &awmr_rest
#else
#define AWMR_REST 0
#endif

#ifdef AWMR_OBSERVER_BANDWIDTH_RADPS
extern const awmr::ObserverBlock awmr_tuned_observer;
const awmr::ObserverBlock awmr_tuned_observer AWMR_IN_FLASH = {
    AWMR_OBSERVER_BANDWIDTH_RADPS, AWMR_OBSERVER_YAW_MAX_M, AWMR_OBSERVER_SURGE_MAX,
    AWMR_SAMPLE_TIME_S};
#define AWMR_TUNED_OBSERVER &awmr_tuned_observer
#else
#define AWMR_TUNED_OBSERVER 0
#endif

#ifdef AWMR_OBSERVER_BANDWIDTH_RADPS_DIFFERENTIAL
#define AWMR_OBSERVER_IN(mode)                                                        \
  AWMR_OBSERVER_BANDWIDTH_RADPS_##mode, AWMR_OBSERVER_YAW_MAX_M_##mode,               \
      AWMR_OBSERVER_SURGE_MAX_##mode
#define AWMR_OBSERVER_SAMPLE_TIME_S AWMR_SAMPLE_TIME_S
#else
#define AWMR_OBSERVER_IN(mode) 0.0f, 0.0f, 0.0f
#define AWMR_OBSERVER_SAMPLE_TIME_S 0.0f
#endif

#ifdef AWMR_HEADING_LAMBDA_DIFFERENTIAL
#define AWMR_GAINS_IN(mode)                                                           \
  {{AWMR_HEADING_LAMBDA_##mode,                                                       \
    AWMR_INERTIA_NORM * AWMR_HEADING_LAMBDA_##mode,                                   \
    AWMR_INERTIA_NORM * (AWMR_HEADING_MU_##mode / AWMR_HEADING_EPSILON_##mode),       \
    AWMR_INERTIA_NORM * AWMR_HEADING_MU_##mode,                                       \
    AWMR_MASS_NORM * (AWMR_SPEED_MU_##mode / AWMR_SPEED_EPSILON_##mode),              \
    AWMR_MASS_NORM * AWMR_SPEED_MU_##mode},                                           \
   AWMR_OBSERVER_IN(mode)}
extern const awmr::ModeGainsBlock awmr_mode_gains;
const awmr::ModeGainsBlock awmr_mode_gains AWMR_IN_FLASH = {
    {AWMR_GAINS_IN(DIFFERENTIAL), AWMR_GAINS_IN(STEERING), AWMR_GAINS_IN(COMBINED)},
    AWMR_OBSERVER_SAMPLE_TIME_S};
#define AWMR_GAINS_BY_MODE 1
#define AWMR_MODE_GAINS &awmr_mode_gains
#else
#define AWMR_GAINS_BY_MODE 0
#define AWMR_MODE_GAINS 0
#endif

namespace {

typedef awmr::LineLaws<awmr::LineLawAt<AWMR_LINE_LAW>::Of, float>::Law LineLaw;

/// Constants of the position estimate. awmr::Positioner needs them with these names, those of the
/// members of awmr::PositionFilter.
struct PositionFilter {
  static constexpr float sample_time_s = AWMR_SAMPLE_TIME_S;
  static constexpr float sample_rate_hz = AWMR_SAMPLE_RATE_HZ;
  static constexpr float fix_variance_m2 = AWMR_FIX_VARIANCE_M2;
  static constexpr float drift_m2 = AWMR_DRIFT_M2;
  static constexpr float stride_inverse = AWMR_TRAVELLED_STRIDE_INVERSE;
  static constexpr float spread_inverse = AWMR_CORRECTION_STEPS_INVERSE;
  static constexpr uint8_t stride = AWMR_TRAVELLED_STRIDE;
  static constexpr uint8_t spread_steps = AWMR_CORRECTION_STEPS;
  static constexpr bool spreads_work = AWMR_SPREADS_FIXES;
};

struct Parts {
  typedef awmr::Optional<AWMR_WITH_LINE, awmr::LineFollower<float, LineLaw>>::type Line;
  typedef awmr::Optional<AWMR_WITH_PATH, awmr::PathFollower<float, uint32_t>>::type Path;
  typedef awmr::Optional<AWMR_WITH_SLOW_DOWN, awmr::SlowDown<float>>::type Arrival;
  typedef awmr::Optional<AWMR_WITH_AVOIDANCE, awmr::Avoider<float>>::type Avoidance;
  typedef awmr::Optional<AWMR_WITH_SHAPING, awmr::Shaper<float>>::type Shaping;
  typedef awmr::Optional<AWMR_WITH_OBSERVER, awmr::Observer>::type Observation;
  typedef awmr::Optional<AWMR_FRICTION_AT_REST, awmr::MotorCurve>::type Motors;
  typedef awmr::Optional<AWMR_GAINS_BY_MODE, awmr::GainsByMode>::type Gains;
  typedef awmr::Optional<AWMR_WITH_POSITION_ESTIMATE, awmr::Positioner<PositionFilter>>::type
      Positioning;
  static constexpr bool kIsDirected = AWMR_WITH_DIRECTION;
  static constexpr awmr::CombinedSplit kSplit =
      AWMR_FIXED_HALF ? awmr::CombinedSplit::kFixedHalf : awmr::CombinedSplit::kRedistribute;
};

awmr::Autopilot<Resistance, Parts> autopilot;

// Reads the caller's C structs as C++ structs of the same layout. The compiler assumes that objects
// of different types do not overlap, so it could move the caller's writes behind this call. The
// empty asm statements here and in awmr_step() are memory barriers that prevent this.
__attribute__((noinline)) void follow(const awmr_point* points, int16_t count, float acceptance_m, bool skip_passed) {
  // If the acceptance radius is invalid, a waypoint that is not a number replaces the route. Each
  // step then gives AWMR_FAULT_OUTPUT until the next route.
  static const awmr_point kNowhere = {__builtin_nanf(""), __builtin_nanf("")};
  if (!(acceptance_m >= 0.0f && acceptance_m < 1e6f)) {
    points = &kNowhere;
    count = 1;
  }
  __asm__ volatile("" ::: "memory");
  const awmr::Waypoints<float> waypoints = {reinterpret_cast<const awmr::Position<float>*>(points),
                                            count, acceptance_m, skip_passed};
  awmr::follow_waypoints(autopilot, waypoints);
}

}  // namespace

uint8_t awmr_init(void) {
  const bool good =
      awmr::start_autopilot(autopilot, &awmr_parameters, kSurgeLines, kSurgeCount, kYawLines,
                            kYawCount, AWMR_PARAMETERS_CRC32, AWMR_REST, AWMR_TUNED_OBSERVER,
                            AWMR_MODE_GAINS);
  return good ? AWMR_FAULT_NONE : AWMR_FAULT_PARAMETERS;
}

// Checks that the C structs have the same members in the same order as the C++ structs, because
// awmr_step() reads one as the other.
static_assert(sizeof(awmr_input) == sizeof(awmr::AutopilotInput), "");
static_assert(offsetof(awmr_input, psi_rad) == offsetof(awmr::AutopilotInput, measured), "");
static_assert(offsetof(awmr_input, x_m) == offsetof(awmr::AutopilotInput, position_m), "");
static_assert(offsetof(awmr_input, psi_ref_rad) == offsetof(awmr::AutopilotInput, reference), "");
static_assert(offsetof(awmr_input, now_ms) == offsetof(awmr::AutopilotInput, times), "");
static_assert(offsetof(awmr_input, speed_unsigned) == offsetof(awmr::AutopilotInput, speed_unsigned), "");
static_assert(offsetof(awmr_input, fix_ms) == offsetof(awmr::AutopilotInput, fix_ms), "");
static_assert(sizeof(awmr_point) == sizeof(awmr::Position<float>), "");
static_assert(sizeof(awmr_output) == sizeof(awmr::AutopilotOutput), "");
static_assert(offsetof(awmr_output, tau_speed) == offsetof(awmr::AutopilotOutput, tau_speed), "");
static_assert(offsetof(awmr_output, arrived) == offsetof(awmr::AutopilotOutput, arrived), "");

// Reads and writes the C structs as the C++ structs of the same layout.
__attribute__((noinline)) void awmr_step(const awmr_input* input, awmr_output* output) {
  __asm__ volatile("" ::: "memory");
  awmr::autopilot_step(autopilot, *reinterpret_cast<const awmr::AutopilotInput*>(input),
                       *reinterpret_cast<awmr::AutopilotOutput*>(output));
  __asm__ volatile("" ::: "memory");
}

__attribute__((noinline)) void awmr_follow(const awmr_point* points, int16_t count,
                                           float acceptance_m) {
  follow(points, count, acceptance_m, false);
}

__attribute__((noinline)) void awmr_follow_skipping(const awmr_point* points, int16_t count,
                                                    float acceptance_m) {
  follow(points, count, acceptance_m, true);
}

#if AWMR_WITH_POSITION_ESTIMATE
uint8_t awmr_position_resets(void) {
  return awmr::part_of<awmr::Positioner<PositionFilter>>(autopilot).estimate.resets;
}
#endif

#if AWMR_WITH_LINE
namespace {
struct NextParameter {
  const float* next;
  void operator()(const char*, float& parameter, const awmr::LawParameter&) { parameter = *next++; }
};
}  // namespace

__attribute__((noinline)) void awmr_follow_line_by(const awmr_point* corners, int16_t count,
                                                   const float* parameters, float corner_m,
                                                   uint8_t sideslip_compensation) {
  __asm__ volatile("" ::: "memory");
  awmr::Polyline<float, LineLaw> line = {reinterpret_cast<const awmr::Position<float>*>(corners),
                                         count, corner_m, LineLaw()};
  LineLaw::parameters(line.law, NextParameter{parameters});
  line.law.sideslip_compensation = sideslip_compensation != 0;
  awmr::follow_line(autopilot, line, AWMR_SAMPLE_TIME_S);
}
#if AWMR_LINE_LAW == 0
void awmr_follow_line(const awmr_point* corners, int16_t count, const awmr_line_law* law) {
  const float parameters[] = {law->delta_rad, law->width_m};
  awmr_follow_line_by(corners, count, parameters, law->corner_m, law->sideslip_compensation);
}
#endif
#endif

#if AWMR_WITH_PATH
void awmr_follow_path(const awmr_path* path) {
  const awmr::Lissajous<float> figure = {path->amplitude_x_m, path->amplitude_y_m,
                                         path->rate_x_radps, path->rate_y_radps};
  awmr::follow_path(autopilot, figure, path->gain_per_s);
}
#endif

#if AWMR_WITH_SLOW_DOWN
void awmr_slow_down(float distance_m) {
  awmr::part_of<awmr::SlowDown<float>>(autopilot).distance_m = distance_m;
}
#endif

#if AWMR_WITH_AVOIDANCE
static_assert(sizeof(awmr_obstacle) == sizeof(awmr::Obstacle<float>), "");
static_assert(sizeof(awmr_sector) == sizeof(awmr::Sector<float>), "");
static_assert(sizeof(awmr_avoidance) == sizeof(awmr::Avoidance<float>), "");

__attribute__((noinline)) void awmr_avoid(const awmr_avoidance* avoidance,
                                          const awmr_obstacle* obstacles, awmr_sector* sectors,
                                          int16_t count) {
  __asm__ volatile("" ::: "memory");
  awmr::avoid_obstacles(autopilot, *reinterpret_cast<const awmr::Avoidance<float>*>(avoidance),
                        reinterpret_cast<const awmr::Obstacle<float>*>(obstacles),
                        reinterpret_cast<awmr::Sector<float>*>(sectors), count);
}
#endif

#if AWMR_WITH_SHAPING
void awmr_shape(const awmr_shaping* shaping) {
  if (shaping == 0) return awmr::part_of<awmr::Shaper<float>>(autopilot).disable();
  const awmr::HeadingShaping<float> filter = {shaping->omega_radps, shaping->rate_max_radps,
                                              shaping->accel_max_radps2};
  awmr::shape_headings(autopilot, filter, AWMR_SAMPLE_TIME_S);
}
#endif

#if AWMR_WITH_OBSERVER
void awmr_observe(const awmr_observer* observer) {
  if (observer == 0) return awmr::part_of<awmr::Observer>(autopilot).disable();
  const awmr::Observers<float> observers = {{observer->bandwidth_radps, observer->yaw_max_m},
                                            {observer->bandwidth_radps, observer->surge_max},
                                            observer->anti_windup != 0};
  awmr::observe_disturbance(autopilot, observers, AWMR_SAMPLE_TIME_S);
}
#endif
