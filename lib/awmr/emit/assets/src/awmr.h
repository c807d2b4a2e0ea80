/* awmr: the autopilot of one vehicle as a C interface. C99 and C++11.
   Angles in rad, counter-clockwise positive, x forward, y left; forces over F_max, the largest force
   of one motor. Nothing is allocated; there is one autopilot. Call from one thread (or one interrupt).

     awmr_init();
     every AWMR_SAMPLE_TIME_S: fill an awmr_input; awmr_step(&input, &output); drive the motors. */
#ifndef AWMR_H
#define AWMR_H

#include <stdint.h>

#include "awmr_autopilot_params.h"
#include "awmr_params.h"

/* mode: how a yaw moment is made */
#define AWMR_DIFFERENTIAL 0 /* by the sides' forces, wheels straight */
#define AWMR_STEERING 1     /* by the front wheels, sides alike */
#define AWMR_COMBINED 2     /* by both; what one cannot deliver goes to the other */

/* fault: why the safe command (forces 0, wheels straight) was given. Bits, several may be set.
   AWMR_FAULT_PARAMETERS stays until reset; the others last as long as their cause. */
#define AWMR_FAULT_NONE 0x00
#define AWMR_FAULT_PARAMETERS 0x01      /* the parameters in flash fail their check sum */
#define AWMR_FAULT_NOT_FINITE 0x02      /* an input is infinite or NaN */
#define AWMR_FAULT_RANGE 0x04           /* an input is out of range, or the mode unknown */
#define AWMR_FAULT_HEADING_STALE 0x08   /* heading_ms too old: AWMR_HEADING_TIMEOUT_MS */
#define AWMR_FAULT_SPEED_STALE 0x10     /* speed_ms too old: AWMR_SPEED_TIMEOUT_MS */
#define AWMR_FAULT_COMMAND_TIMEOUT 0x20 /* command_ms too old: AWMR_COMMAND_TIMEOUT_MS */
#define AWMR_FAULT_STEP_LATE 0x40       /* the step before too long ago: AWMR_STEP_TIMEOUT_MS */
#define AWMR_FAULT_OUTPUT 0x80          /* the command would have been outside its limits */

typedef struct awmr_input {
  uint8_t mode;            /* AWMR_DIFFERENTIAL, AWMR_STEERING or AWMR_COMBINED */
  float psi_rad;           /* heading, wrapped or not, |psi| <= 4096 */
  float u_mps;             /* speed ahead */
  float v_mps;             /* speed to the left; 0 where it is not measured */
  float r_radps;           /* yaw rate */
  float x_m;               /* position, read while following waypoints only */
  float y_m;
  float psi_ref_rad;       /* heading to hold; not read while following waypoints */
  float psi_ref_rate_radps;
  float psi_ref_accel_radps2;
  float u_ref_mps;         /* speed to hold */
  float u_ref_accel_mps2;
  uint32_t now_ms;         /* a clock in ms that may wrap around, and by it when ... */
  uint32_t heading_ms;     /* ... psi_rad and r_radps were measured, */
  uint32_t speed_ms;       /* ... u_mps, x_m and y_m were measured, */
  uint32_t command_ms;     /* ... whoever commands was last heard of */
} awmr_input;

typedef struct awmr_output {
  float force_left;        /* of each wheel of the side, AWMR_WHEEL_FORCE_MIN to _MAX */
  float force_right;
  float steering_rad;      /* of the front wheels, left positive */
  uint8_t speed_limited;   /* 1: tau_speed was clipped */
  uint8_t steering_limited;   /* 1: the steering angle was clipped */
  uint8_t force_limited;      /* 1: a force was clipped */
  uint8_t steering_powerless; /* 1: too little force to steer with */
  float tau_speed;         /* asked for by the speed law, before any limit */
  float tau_turn_m;        /* asked for by the heading law, m, before any limit */
  float psi_ref_rad;       /* the heading held or led to */
  uint8_t arrived;         /* 1: no waypoint is left */
  uint8_t fault;           /* AWMR_FAULT_...; not 0: the safe command */
} awmr_output;

typedef struct awmr_point {
  float x_m;
  float y_m;
} awmr_point;

#ifdef __cplusplus
extern "C" {
#endif

/* Reads and checks the parameters. AWMR_FAULT_NONE, or AWMR_FAULT_PARAMETERS: awmr_step then gives
   the safe command only. */
uint8_t awmr_init(void);

/* One control step. */
void awmr_step(const awmr_input* input, awmr_output* output);

/* Goes to `count` points one after the other from the next step on; a point is reached within
   acceptance_m. The points are not copied. count 0: back to holding psi_ref_rad. */
void awmr_follow(const awmr_point* points, int16_t count, float acceptance_m);

#ifdef __cplusplus
}
#endif

#endif /* AWMR_H */
