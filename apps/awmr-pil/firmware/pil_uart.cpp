// Firmware for `awmr pil --link uart`, for the emulated chip and for a real board (`--port`).
// Executes a control step whenever a request arrives at USART0 (the USB serial of a Mega 2560), and
// sleeps in between.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <string.h>

#include "awmr.h"
#include "frame.h"
#include "mission.h"

#ifndef PIL_BAUD
#define PIL_BAUD 500000UL
#endif

namespace {

const uint8_t kRingMask = 31;
// Received bytes that main() has not read yet. Bytes are lost if main() does not read a byte before
// 32 more arrive.
volatile uint8_t ring[kRingMask + 1];
volatile uint8_t ring_head;
uint8_t ring_tail;

// Pause on the line after which an incomplete frame is discarded, in counts of timer 3 (F_CPU/64):
// 20 ms plus the time of 20 bytes. It is longer than the pauses that USB makes within a frame, and
// shorter than the time after which the host repeats a request.
const uint16_t kPause =
    static_cast<uint16_t>(F_CPU / 64UL / 50UL + 20UL * 10UL * (F_CPU / 64UL) / PIL_BAUD);

pil::FrameReader reader;
awmr_point points[kPilPoints];

/// The last answer. It is sent again if the host repeats the request.
struct {
  uint8_t type;
  uint8_t sequence;
  uint8_t length;
  uint8_t payload[sizeof(awmr_output) + sizeof(uint16_t)];
} reply;
bool is_answered;  // true: `reply` is the answer to the last request
// True: a start request (kHello) came since the reset. Before that, no other request is answered.
bool is_greeted;

void send(uint8_t byte) {
  while ((UCSR0A & _BV(UDRE0)) == 0) {
  }
  UDR0 = byte;
}

void send_reply() {
  const uint8_t* bytes = &reply.type;
  uint16_t crc = awmr::kCrc16Start;
  send(pil::kFrameStart);
  for (uint8_t i = 0; i < pil::kHeadBytes + reply.length; ++i) {
    crc = awmr::crc16_with(crc, bytes[i]);
    send(bytes[i]);
  }
  send(static_cast<uint8_t>(crc & 0xFFU));
  send(static_cast<uint8_t>(crc >> 8U));
}

void answer(const void* payload, uint8_t length) {
  reply.type = reader.type();
  reply.sequence = reader.sequence();
  reply.length = length;
  memcpy(reply.payload, payload, length);
  // The answer to kHello is not kept, because a repeated kHello must restart the controller.
  is_answered = reply.type != pil::kHello;
  send_reply();
}

void hello() {
  struct {
    uint8_t fault;
    uint32_t crc;
  } found = {awmr_init(), AWMR_PARAMETERS_CRC32 ^ kPilMission};
  pil_set_up();
  is_greeted = true;
  answer(&found, sizeof found);
}

void follow() {
  float acceptance_m;
  if (reader.length() < sizeof acceptance_m) return;
  const uint8_t bytes = static_cast<uint8_t>(reader.length() - sizeof acceptance_m);
  if (bytes > sizeof points || bytes % sizeof points[0] != 0) return;
  memcpy(&acceptance_m, reader.payload(), sizeof acceptance_m);
  memcpy(points, reader.payload() + sizeof acceptance_m, bytes);
  pil_follow(points, static_cast<int16_t>(bytes / sizeof points[0]), acceptance_m);
  answer(points, 0);
}

// Executes a control step and sends its outputs and its clock cycles. Timer 1 (16 bits) counts the
// cycles; if it overflows, 65535 is sent.
void step() {
  awmr_input input;
  struct {
    awmr_output output;
    uint16_t cycles;
  } done;
  if (reader.length() != sizeof input) return;
  memcpy(&input, reader.payload(), sizeof input);
  TCNT1 = 0;
  TIFR1 = _BV(TOV1);  // clears the overflow flag
  awmr_step(&input, &done.output);
  const uint16_t counted = TCNT1;
  done.cycles = (TIFR1 & _BV(TOV1)) != 0 ? 65535U : counted;
  answer(&done, sizeof done);
}

void serve() {
  if (!is_greeted && reader.type() != pil::kHello) return;
  if (is_answered && reader.type() == reply.type && reader.sequence() == reply.sequence) {
    send_reply();
    return;
  }
  switch (reader.type()) {
    case pil::kHello:
      hello();
      break;
    case pil::kFollow:
      follow();
      break;
    case pil::kStep:
      step();
      break;
    default:
      break;
  }
}

/// Processes one byte of the line.
void take(uint8_t byte) {
  static uint16_t last;
  const uint16_t now = TCNT3;
  if (static_cast<uint16_t>(now - last) > kPause) reader.reset();
  last = now;
  if (!reader.take(byte)) return;
  serve();
  last = TCNT3;
}

}  // namespace

ISR(USART0_RX_vect) {
  const uint8_t head = ring_head;
  ring[head] = UDR0;
  ring_head = static_cast<uint8_t>((head + 1) & kRingMask);
}

int main() {
  awmr_init();
  TCCR1B = _BV(CS10);
  TCCR3B = _BV(CS31) | _BV(CS30);
  UCSR0A = _BV(U2X0);
  UBRR0 = static_cast<uint16_t>(F_CPU / 8 / PIL_BAUD - 1);
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  for (;;) {
    cli();
    while (ring_tail == ring_head) {
      sei();
      sleep_cpu();  // the instruction after sei() runs before any interrupt, so none is missed
      cli();
    }
    sei();
    const uint8_t byte = ring[ring_tail];
    ring_tail = static_cast<uint8_t>((ring_tail + 1) & kRingMask);
    take(byte);
  }
}
