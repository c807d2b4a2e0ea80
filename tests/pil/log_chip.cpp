// Chip program that only logs, for log_chip_test.cpp. A timer interrupt puts generated steps into
// the ring; blocks are sent through USART0 in between. The chip sleeps between interrupts.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "awmr/emit/board/sensor_fault.h"
#include "awmr_log.h"
#include "chip_uart.h"

namespace {

awmr_log::Ring ring;
awmr_input input;
awmr_output output;
volatile uint8_t step;

Uart uart;

const uint8_t kSteps = 250;
const uint8_t kStallFrom = 60, kStallTo = 150;  // longer than the 56 rows that the ring buffers

float number(uint8_t column) { return 0.125f * static_cast<float>(step) + column; }

}  // namespace

extern "C" {
volatile uint16_t log_cycles_max;  // per row; timer 1 counts at the clock's rate
volatile uint8_t log_done;
}

ISR(TIMER3_COMPA_vect) {
  if (step == kSteps) return;
  output.force_left = number(1);
  output.force_right = -number(2);
  output.steering_rad = number(3);
  input.x_m = number(4);
  input.y_m = number(5);
  input.psi_rad = number(6);
  input.u_mps = number(7);
  input.r_radps = number(8);
  output.psi_ref_rad = number(9);
  input.u_ref_mps = number(10);
  output.tau_speed = number(11);
  output.tau_turn_m = number(12);
  input.mode = static_cast<uint8_t>(step % 3);
  output.force_limited = static_cast<uint8_t>(step & 1);
  __asm__ volatile("" ::: "memory");
  const uint16_t start = TCNT1;
  awmr_log::put(ring, input, output, step, 1, static_cast<uint8_t>(step % awmr::kSensorFaultCount));
  const uint16_t cycles = static_cast<uint16_t>(TCNT1 - start);
  if (cycles > log_cycles_max) log_cycles_max = cycles;
  step = static_cast<uint8_t>(step + 1);
}

int main() {
  uart.begin();
  TCCR1B = _BV(CS10);
  awmr_log::write_header(uart);
  awmr_log::write_header(uart);
  OCR3A = static_cast<uint16_t>(F_CPU / 8 / 100 - 1);
  TCCR3B = _BV(WGM32) | _BV(CS31);
  TIMSK3 = _BV(OCIE3A);
  sleep_enable();
  sei();
  while (step < kSteps) {
    if (step < kStallFrom || step >= kStallTo) awmr_log::drain(ring, uart);
    sleep_cpu();
  }
  while (awmr_log::drain(ring, uart, true) == awmr_log::kWritten) {
  }
  log_done = 1;
  for (;;) sleep_cpu();
}
