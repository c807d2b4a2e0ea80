// A chip whose steps come from the board's timer interrupt and write rows of the log; the 100th does
// not end, once after the chip was switched on. For log_chip_test.cpp.
#include <avr/io.h>
#include <avr/sleep.h>
#include <stddef.h>
#include <stdint.h>

#include "awmr_board/steps.h"
#include "awmr_log.h"

namespace {

awmr_log::Ring ring;
awmr_input input;
awmr_output output;

struct Uart {
  size_t write(const uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
      while ((UCSR0A & _BV(UDRE0)) == 0) {
      }
      UDR0 = bytes[i];
    }
    return size;
  }
} uart;

void step() {
  const bool has_to_hang = awmr_board::reset_cause() == awmr_board::kSwitchedOn;
  while (has_to_hang && awmr_board::step_number() == 100) {
  }
  awmr_log::put(ring, input, output, awmr_board::step_number(), awmr_board::reset_cause());
}

}  // namespace

extern "C" {
volatile uint8_t log_done;
}

int main() {
  UCSR0A = _BV(U2X0);
  UBRR0 = 3;  // 500,000 baud
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(TXEN0);
  awmr_log::write_header(uart);
  awmr_log::write_header(uart);
  awmr_board::begin_steps(step);
  sei();
  while (awmr_board::step_number() < 200) awmr_log::drain(ring, uart);
  log_done = 1;
  for (;;) sleep_cpu();
}
