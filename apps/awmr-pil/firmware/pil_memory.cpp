// Firmware for `awmr pil --link memory`. The control step runs in a timer interrupt, and the chip
// sleeps in between. The host reads and writes inputs and outputs in RAM, where it finds them by
// the names of the variables below.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "awmr.h"
#include "mission.h"

extern "C" {
awmr_input pil_input;
awmr_output pil_output;
awmr_point pil_points[kPilPoints];
int16_t pil_point_count;  // number of new points to follow from the next step on; 0: none
float pil_acceptance_m;
uint8_t pil_init_fault;
volatile uint8_t pil_steps;  // steps executed, modulo 256
}

namespace {

// Sample time in counts of timer 1. The timer counts at F_CPU/8 and has 16 bits, which limits the
// sample time to 32 ms.
const uint32_t kTimerCounts = static_cast<uint32_t>(AWMR_SAMPLE_TIME_S * (F_CPU / 8) + 0.5f);
static_assert(kTimerCounts >= 2 && kTimerCounts <= 65536,
              "the sample time has to be between 1 us and 32 ms");

}  // namespace

ISR(TIMER1_COMPA_vect) {
  if (pil_point_count > 0) {
    pil_follow(pil_points, pil_point_count, pil_acceptance_m);
    pil_point_count = 0;
  }
  awmr_step(&pil_input, &pil_output);
  ++pil_steps;
}

int main() {
  pil_init_fault = awmr_init();
  pil_set_up();
  OCR1A = static_cast<uint16_t>(kTimerCounts - 1);
  TCCR1B = _BV(WGM12) | _BV(CS11);
  TIMSK1 = _BV(OCIE1A);
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
  for (;;) sleep_cpu();
}
