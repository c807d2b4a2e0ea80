/* When a step is due, what happens if it does not end, and why the chip began. */
#ifndef AWMR_BOARD_STEPS_H
#define AWMR_BOARD_STEPS_H

#include <avr/interrupt.h>
#include <avr/wdt.h>

#include "../awmr_params.h"
#include "ticks.h"

namespace awmr_board {

/* Bits of reset_cause(), those of MCUSR. 0: the bootloader took them. */
const uint8_t kSwitchedOn = 1, kResetButton = 2, kBrownOut = 4, kWatchdog = 8;

static uint8_t kept_reset_cause __attribute__((section(".noinit")));

/* Before main() and before RAM is cleared; a watchdog that bit goes on, and would bite again. */
static void keep_reset_cause() __attribute__((naked, used, section(".init3")));
static void keep_reset_cause() {
  kept_reset_cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

inline uint8_t reset_cause() { return kept_reset_cause; }

typedef void (*Step)();
static Step the_step;
static volatile bool is_in_step;
static volatile uint32_t sample_time_count; /* sample times since begin_steps() */
static volatile uint32_t the_step_number;
static uint16_t ticks_left; /* of the board's timer, until the next sample time */
static uint16_t ticks_per_step;

/* The shortest time of the watchdog that is at least 250 ms and four sample times: a step that was
   left out as the one before took too long resets nothing. */
inline uint8_t watchdog_time() {
  return 4.0f * AWMR_SAMPLE_TIME_S <= 0.25f  ? WDTO_250MS
         : 4.0f * AWMR_SAMPLE_TIME_S <= 0.5f ? WDTO_500MS
         : 4.0f * AWMR_SAMPLE_TIME_S <= 1.0f ? WDTO_1S
         : 4.0f * AWMR_SAMPLE_TIME_S <= 2.0f ? WDTO_2S
                                             : WDTO_4S;
}

/* Calls `step` every AWMR_SAMPLE_TIME_S from the interrupt of the board's timer, other interrupts
   allowed: the bus of the sensors, the serial lines and millis() need theirs. A step that is not
   over when the next one is due goes on, and that one is left out. The watchdog resets a chip on
   which no step ends. */
inline void begin_steps(Step step) {
  the_step = step;
  cli();
  ticks_left = ticks_per_step = begin_ticks(AWMR_SAMPLE_TIME_S);
  sei();
  wdt_enable(watchdog_time());
}

/* The sample time, from 1, at which the step that runs began. To be asked for in the step. */
inline uint32_t step_number() { return the_step_number; }

}  // namespace awmr_board

ISR(AWMR_BOARD_TICK) {
  if (--awmr_board::ticks_left > 0) return;
  awmr_board::ticks_left = awmr_board::ticks_per_step;
  ++awmr_board::sample_time_count;
  if (awmr_board::is_in_step) return;
  awmr_board::is_in_step = true;
  awmr_board::the_step_number = awmr_board::sample_time_count;
  sei();
  awmr_board::the_step();
  wdt_reset();
  cli();
  awmr_board::is_in_step = false;
}

#endif /* AWMR_BOARD_STEPS_H */
