/* Timer interrupt that calls the sketch's control step periodically and reads the serial lines in
   between; watchdog for a step that does not end; cause of the last reset. */
#ifndef AWMR_BOARD_STEPS_H
#define AWMR_BOARD_STEPS_H

#include <avr/interrupt.h>
#include <avr/wdt.h>

#include "../awmr_params.h"
#include "ticks.h"

namespace awmr_board {

/* Bits of reset_cause(), as in MCUSR. 0: the bootloader cleared them. */
const uint8_t kSwitchedOn = 1, kResetButton = 2, kBrownOut = 4, kWatchdog = 8;

static uint8_t kept_reset_cause __attribute__((section(".noinit")));

/* Stores the reset cause and switches the watchdog off, before main() and before RAM is cleared.
   The watchdog is still active after a watchdog reset, and would reset the chip again. */
static void keep_reset_cause() __attribute__((naked, used, section(".init3")));
static void keep_reset_cause() {
  kept_reset_cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

inline uint8_t reset_cause() { return kept_reset_cause; }

typedef void (*Function)();
static Function the_receive, the_step;
static volatile bool is_busy;
static volatile bool is_due;
static volatile uint32_t sample_time_count; /* sample times since begin_steps() */
static volatile uint32_t the_step_number;
static uint16_t ticks_left; /* timer ticks until the next sample time */
static uint16_t ticks_per_step;

/* Returns the time after which the watchdog resets the chip: at least 250 ms and at least four
   sample times, so that a single skipped step causes no reset; at most 4 s. */
inline uint8_t watchdog_time() {
  return 4.0f * AWMR_SAMPLE_TIME_S <= 0.25f  ? WDTO_250MS
         : 4.0f * AWMR_SAMPLE_TIME_S <= 0.5f ? WDTO_500MS
         : 4.0f * AWMR_SAMPLE_TIME_S <= 1.0f ? WDTO_1S
         : 4.0f * AWMR_SAMPLE_TIME_S <= 2.0f ? WDTO_2S
                                             : WDTO_4S;
}

/* Starts the timer interrupt. Every few ms, it calls `receive`, which must read the serial lines
   before their buffers overflow. Every AWMR_SAMPLE_TIME_S, it then calls `step`. Other interrupts
   stay enabled for the sensor bus, the serial lines and millis(). If a step is still running when
   the next one is due, the next one is skipped. The watchdog resets a chip on which no step ends. */
inline void begin_steps(Function receive, Function step) {
  the_receive = receive;
  the_step = step;
  cli();
  ticks_left = ticks_per_step = begin_ticks(AWMR_SAMPLE_TIME_S);
  sei();
  wdt_enable(watchdog_time());
}

/* Number of the sample time to which the running step belongs, from 1; skipped steps count. Call
   only in the step. */
inline uint32_t step_number() { return the_step_number; }

}  // namespace awmr_board

ISR(AWMR_BOARD_TICK) {
  if (--awmr_board::ticks_left == 0) {
    awmr_board::ticks_left = awmr_board::ticks_per_step;
    ++awmr_board::sample_time_count;
    awmr_board::is_due = true;
  }
  if (awmr_board::is_busy) return;
  awmr_board::is_busy = true;
  sei();
  awmr_board::the_receive();
  if (awmr_board::is_due) {
    cli();
    awmr_board::the_step_number = awmr_board::sample_time_count;
    sei();
    awmr_board::the_step();
    wdt_reset();
    awmr_board::is_due = false;
  }
  cli();
  awmr_board::is_busy = false;
}

#endif /* AWMR_BOARD_STEPS_H */
