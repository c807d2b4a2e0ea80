#pragma once
// Sends the log through USART0 of the chip instead of writing it to an SD card, for the programs of
// log_chip_test.cpp.
#include <avr/io.h>
#include <stddef.h>
#include <stdint.h>

/// Sends bytes, and waits until each is transmitted.
struct Uart {
  void begin() {
    UCSR0A = _BV(U2X0);
    UBRR0 = 3;  // 500,000 baud at 16 MHz
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(TXEN0);
  }
  size_t write(const uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
      while ((UCSR0A & _BV(UDRE0)) == 0) {
      }
      UDR0 = bytes[i];
    }
    return size;
  }
};
