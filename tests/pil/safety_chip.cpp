// Runs the sequence of safety_sequence.h on the chip, for safety_chip_test.cpp, and counts the
// cycles of each step.
#include <avr/io.h>

#include "awmr.cpp"
#include "safety_sequence.h"

namespace {

safety_sequence::Sequence sequence;
const awmr_point kPoints[] = {{10.0f, 2.0f}, {100.0f, -5.0f}};

uint16_t since(uint16_t start) { return static_cast<uint16_t>(TCNT1 - start); }
void keep_most(volatile uint16_t& most, uint16_t cycles) {
  if (cycles > most) most = cycles;
}

}  // namespace

extern "C" {
// Maximum clock cycles, measured by timer 1: of awmr_step(), of a complete step, and of steps that
// read a sentence and process its fix.
volatile uint16_t safety_step_cycles, safety_whole_cycles, safety_fix_cycles;
volatile uint32_t safety_hash;
volatile uint8_t safety_causes[awmr::kSensorFaultCount], safety_disarmed;
volatile uint8_t log_done;
}

int main() {
  TCCR1B = _BV(CS10);
  safety_sequence::begin(sequence);
  awmr_init();
  awmr_follow(kPoints, 2, 1.0f);
  for (uint16_t number = 0; number < safety_sequence::kSteps; ++number) {
    safety_sequence::prepare(sequence, number);
    const uint16_t whole = TCNT1;
    safety_sequence::step(sequence, number);
    const uint16_t step = TCNT1;
    awmr_step(&sequence.input, &sequence.output);
    keep_most(safety_step_cycles, since(step));
    keep_most(number % 20 < 9 ? safety_fix_cycles : safety_whole_cycles, since(whole));
    safety_sequence::finish(sequence);
  }
  safety_hash = sequence.hash;
  for (uint8_t i = 0; i < awmr::kSensorFaultCount; ++i) safety_causes[i] = sequence.causes[i];
  safety_disarmed = sequence.disarmed;
  log_done = 1;
  // Loops instead of sleeping, because simavr ends when the chip sleeps with interrupts off.
  for (;;) {
  }
}
