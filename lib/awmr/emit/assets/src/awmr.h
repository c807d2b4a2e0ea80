/* C interface of the autopilot for one vehicle. C99 and C++11. Angles are in rad, counter-clockwise
   positive; x is forward, y left. Forces are divided by F_max, the largest force of one motor. The
   autopilot allocates no memory. There is only one: call all functions from the same thread or
   interrupt.

     awmr_init();
     every AWMR_SAMPLE_TIME_S: fill an awmr_input; awmr_step(&input, &output); drive the motors. */
#ifndef AWMR_H
#define AWMR_H

#include <stdint.h>

#include "awmr_autopilot_params.h"
#include "awmr_params.h"

/* 1: the autopilot can estimate the position from the fixes of a GPS receiver
   (awmr_input.position_is_fix); this needs 2.9 kB of flash and 140 bytes of RAM. 0, the default of
   the Uno, whose flash is too small: an input with position_is_fix 1 gives AWMR_FAULT_RANGE. */
#ifndef AWMR_WITH_POSITION_ESTIMATE
#ifdef __AVR_ATmega328P__
#define AWMR_WITH_POSITION_ESTIMATE 0
#else
#define AWMR_WITH_POSITION_ESTIMATE 1
#endif
#endif

/* awmr_input.mode: the actuators that make the yaw moment */
#define AWMR_DIFFERENTIAL 0 /* left and right wheel forces, wheels straight */
#define AWMR_STEERING 1     /* the front wheels, equal forces on both sides */
#define AWMR_COMBINED 2     /* both: each makes half of the moment. With AWMR_FIXED_HALF 0, if one
                               reaches its limit, the other makes the rest */

/* awmr_output.fault: reasons for the safe command (forces 0, wheels straight), one bit each.
   AWMR_FAULT_PARAMETERS is set until reset; the others last as long as their cause. */
#define AWMR_FAULT_NONE 0x00
#define AWMR_FAULT_PARAMETERS 0x01      /* the parameters in flash fail their check sum */
#define AWMR_FAULT_NOT_FINITE 0x02      /* an input is infinite or NaN */
#define AWMR_FAULT_RANGE 0x04           /* an input is out of range, or the mode unknown */
#define AWMR_FAULT_HEADING_STALE 0x08   /* heading_ms is older than AWMR_HEADING_TIMEOUT_MS */
#define AWMR_FAULT_SPEED_STALE 0x10     /* speed_ms is older than AWMR_SPEED_TIMEOUT_MS */
#define AWMR_FAULT_COMMAND_TIMEOUT 0x20 /* command_ms is older than AWMR_COMMAND_TIMEOUT_MS */
#define AWMR_FAULT_STEP_LATE 0x40       /* the last step was more than AWMR_STEP_TIMEOUT_MS ago */
#define AWMR_FAULT_OUTPUT 0x80          /* a computed command was outside its limits, or not
                                           finite */

typedef struct awmr_input {
  uint8_t mode;            /* AWMR_DIFFERENTIAL, AWMR_STEERING or AWMR_COMBINED */
  float psi_rad;           /* heading, wrapped or not, |psi| <= 4096 */
  float u_mps;             /* forward speed */
  float v_mps;             /* speed to the left; 0 if not measured */
  float r_radps;           /* yaw rate */
  float x_m;               /* position: needed by guidance, by avoidance and if
                              speed_unsigned is 1 */
  float y_m;
  float psi_ref_rad;       /* heading to hold; guidance (awmr_follow, ...) replaces it */
  float psi_ref_rate_radps;
  float psi_ref_accel_radps2;
  float u_ref_mps;         /* speed to hold */
  float u_ref_accel_mps2;
  uint32_t now_ms;         /* present time of a clock in ms, which may wrap */
  uint32_t heading_ms;     /* time on this clock at which psi_rad and r_radps were measured */
  uint32_t speed_ms;       /* time on this clock at which u_mps, x_m and y_m were measured */
  uint32_t command_ms;     /* time on this clock of the last command */
  uint8_t speed_unsigned;  /* 1: u_mps is the magnitude of the speed, as from a GPS; the
                              autopilot computes the direction from x_m, y_m and the commands.
                              0: u_mps has a sign */
  uint8_t position_is_fix; /* 1: x_m, y_m are the last fix of a receiver, taken at fix_ms; the
                              autopilot estimates the present position from it, heading and
                              speed. 0: x_m, y_m are the present position */
  uint32_t fix_ms;
} awmr_input;

typedef struct awmr_output {
  float force_left;        /* force of each left wheel, AWMR_WHEEL_FORCE_MIN to _MAX */
  float force_right;
  float steering_rad;      /* angle of the front wheels, left positive */
  uint8_t speed_limited;   /* 1: tau_speed was clipped */
  uint8_t steering_limited;   /* 1: the steering angle was clipped */
  uint8_t force_limited;      /* 1: a force was clipped */
  uint8_t steering_powerless; /* 1: the wheel forces are too small to turn the vehicle by
                                 steering */
  float tau_speed;         /* force of all wheels that the speed law requests, before any limit */
  float tau_turn_m;        /* yaw moment that the heading law requests, m, before any limit */
  float psi_ref_rad;       /* heading reference in use, from the input or the guidance */
  uint8_t arrived;         /* 1: the route is finished: set u_ref_mps to 0 to stop */
  uint8_t fault;           /* AWMR_FAULT_...; if not 0, this output is the safe command */
} awmr_output;

typedef struct awmr_point {
  float x_m;
  float y_m;
} awmr_point;

/* Optional parts in addition to heading hold and waypoints. Each needs flash and RAM only if
   awmr_autopilot_params.h has it compiled in (awmr emit --with NAME). */

#if AWMR_WITH_LINE && AWMR_LINE_LAW == 0
typedef struct awmr_line_law {
  float delta_rad;         /* angle of approach to the line, in (0, pi/2] */
  float width_m;           /* half width of the lane around the line in which the angle of approach
                              is proportional to the distance from the line, > 0 */
  float corner_m;          /* the next segment starts this far before a corner, >= 0 */
  uint8_t sideslip_compensation; /* 1: the autopilot controls the course over ground instead of the
                                    heading; only if v_mps is measured */
} awmr_line_law;
#endif

#if AWMR_WITH_PATH
/* x = amplitude_x_m cos(rate_x_radps t), y = amplitude_y_m sin(rate_y_radps t); t is 0 at the first
   step along the path */
typedef struct awmr_path {
  float amplitude_x_m;
  float amplitude_y_m;
  float rate_x_radps;
  float rate_y_radps;
  float gain_per_s;        /* gain of the position feedback; 0: the vehicle takes direction and
                              speed of the path, without correcting its position */
} awmr_path;
#endif

#if AWMR_WITH_AVOIDANCE
typedef struct awmr_obstacle {
  float x_m;
  float y_m;
  float radius_m;          /* radius of the obstacle, > 0 */
} awmr_obstacle;
typedef struct awmr_sector { /* working memory of the avoidance: nothing to fill in */
  float bearing_rad;
  float half_rad;
  uint8_t counts;
} awmr_sector;
typedef struct awmr_avoidance {
  float mmd_base_m;        /* manoeuvring distance at rest, > 0, at least the turning radius. The
                              vehicle avoids obstacles nearer than the manoeuvring distance */
  float mmd_per_speed_s;   /* increase of the manoeuvring distance per m/s of speed, >= 0 */
  float sigma_rad;         /* angle by which the blocked sector is wider than the tangents to the
                              obstacle, in [0, pi/2) */
  float vehicle_radius_m;  /* radius of the circle that encloses the vehicle */
  float clearance_m;       /* free distance between this circle and an obstacle, > 0 */
  float hysteresis_m;      /* avoidance ends this far beyond the manoeuvring distance, >= 0 */
  float side_hysteresis_rad; /* the side on which an obstacle is passed changes only if the turn
                                to the other side is smaller by this angle, >= 0 */
  float brake_m;           /* free distance ahead below which the speed is reduced, > 0 */
} awmr_avoidance;
#endif

#if AWMR_WITH_SHAPING
typedef struct awmr_shaping {
  float omega_radps;       /* bandwidth of the filter of the reference, > 0; above
                              0.5/AWMR_SAMPLE_TIME_S the reference overshoots */
  float rate_max_radps;    /* largest rate of the reference, > 0 */
  float accel_max_radps2;  /* largest acceleration of the reference, > 0 */
} awmr_shaping;
#endif

#if AWMR_WITH_OBSERVER
typedef struct awmr_observer {
  float bandwidth_radps;   /* bandwidth of the observer, > 0, below 1/AWMR_SAMPLE_TIME_S */
  float yaw_max_m;         /* largest yaw moment, m, that is compensated, divided by F_max */
  float surge_max;         /* largest surge force that is compensated, divided by F_max */
  uint8_t anti_windup;     /* 1: on, the usual choice; 0: off, to see its effect in a test */
} awmr_observer;
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Reads the parameters in flash and compares them with their check sum. Returns AWMR_FAULT_NONE if
   they agree. Else returns AWMR_FAULT_PARAMETERS, and awmr_step gives only the safe command. */
uint8_t awmr_init(void);

/* Runs one control step. */
void awmr_step(const awmr_input* input, awmr_output* output);

/* Follows `count` waypoints in order from the next step on. A waypoint is reached at a distance of
   acceptance_m. The points are not copied: keep them unchanged. count 0 ends the guidance, and the
   vehicle holds psi_ref_rad again. */
void awmr_follow(const awmr_point* points, int16_t count, float acceptance_m);

/* Follows waypoints as awmr_follow, but skips a waypoint that the vehicle passes without reaching
   it. Meant for vehicles that cannot turn back to a waypoint. */
void awmr_follow_skipping(const awmr_point* points, int16_t count, float acceptance_m);

#if AWMR_WITH_POSITION_ESTIMATE
/* Returns the number of resets of the position estimate to a fix since the start, at most 255. A
   reset follows five fixes in a row that are too far from the estimate. */
uint8_t awmr_position_resets(void);
#endif

#if AWMR_WITH_LINE
/* Follows the line through `count` corners from the next step on, instead of waypoints. The corners
   are not copied: keep them unchanged. `parameters`: those of the law given to awmr emit
   --line-law, in the order and units (rad, m, s) of its header in src/awmr/control/guidance.
   corner_m: distance before a corner at which the next segment starts; 0 for pure_pursuit.
   sideslip_compensation: 1: controls the course over ground instead of the heading; only if v_mps
   is measured. */
void awmr_follow_line_by(const awmr_point* corners, int16_t count, const float* parameters,
                         float corner_m, uint8_t sideslip_compensation);
#if AWMR_LINE_LAW == 0
/* Follows the line as awmr_follow_line_by, with the paper's guidance law (los). */
void awmr_follow_line(const awmr_point* corners, int16_t count, const awmr_line_law* law);
#endif
#endif

#if AWMR_WITH_PATH
/* Follows a timed path from the next step on, at the speed u_ref_mps. If u_ref_mps is 0, the speed
   is that of the moving point of the path. */
void awmr_follow_path(const awmr_path* path);
#endif

#if AWMR_WITH_SLOW_DOWN
/* Slows the vehicle down near the last waypoint or the end of the line. Within distance_m of this
   point the speed is reduced in proportion to the distance, down to a tenth. 0: off. */
void awmr_slow_down(float distance_m);
#endif

#if AWMR_WITH_AVOIDANCE
/* Avoids `count` obstacles, with any guidance. `sectors`: working memory for `count` elements. Keep
   both arrays: they are not copied. count 0: off. */
void awmr_avoid(const awmr_avoidance* avoidance, const awmr_obstacle* obstacles, awmr_sector* sectors,
                int16_t count);
#endif

#if AWMR_WITH_SHAPING
/* Limits rate and acceleration of the heading reference. NULL: off. */
void awmr_shape(const awmr_shaping* shaping);
#endif

#if AWMR_WITH_OBSERVER
/* Estimates a constant disturbance (slope, unequal motors) and compensates it. NULL: off. If the
   gains were tuned with an observer (AWMR_OBSERVER_... in awmr_params.h), awmr_init() already
   switches this observer on. */
void awmr_observe(const awmr_observer* observer);
#endif

#ifdef __cplusplus
}
#endif

#endif /* AWMR_H */
