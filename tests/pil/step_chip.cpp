// Chip program whose steps come from the board's timer interrupt and write rows of the log. The
// 100th step hangs, once after power-on. For log_chip_test.cpp.
#include <avr/io.h>
#include <avr/sleep.h>

#include "awmr_board/steps.h"
#include "awmr_log.h"
#include "chip_uart.h"

namespace {

awmr_log::Ring ring;
awmr_input input;
awmr_output output;

Uart uart;

void step() {
  const bool has_to_hang = awmr_board::reset_cause() == awmr_board::kSwitchedOn;
  while (has_to_hang && awmr_board::step_number() == 100) {
  }
  awmr_log::put(ring, input, output, awmr_board::step_number(), awmr_board::reset_cause());
}

}  // namespace

extern "C" {
volatile uint8_t log_done;
volatile uint16_t receive_calls;
}

static void receive() { ++receive_calls; }

int main() {
  uart.begin();
  awmr_log::write_header(uart);
  awmr_log::write_header(uart);
  awmr_board::begin_steps(receive, step);
  sei();
  while (awmr_board::step_number() < 200) awmr_log::drain(ring, uart);
  log_done = 1;
  for (;;) sleep_cpu();
}
