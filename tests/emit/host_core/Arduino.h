// Arduino's core for the host: the functions that the emitted sketches use, on a simulated Mega
// 2560 with its sensors and vehicle (world.h).
#pragma once
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <deque>
#include <string>

#define HIGH 1
#define LOW 0
#define OUTPUT 1
#define F(text) text
#define _BV(bit) (1 << (bit))
#define F_CPU 16000000L
#define constrain(x, lo, hi) ((x) < (lo) ? (lo) : ((x) > (hi) ? (hi) : (x)))
typedef char __FlashStringHelper;

uint32_t millis();
void delay(uint32_t ms);
void pinMode(uint8_t pin, uint8_t mode);
void digitalWrite(uint8_t pin, uint8_t level);
int digitalRead(uint8_t pin);
void analogWrite(uint8_t pin, int duty);
inline void cli() {}
inline void sei() {}
inline void noInterrupts() {}
inline void interrupts() {}

class Print {
 public:
  virtual ~Print() {}
  virtual size_t write(uint8_t byte) = 0;
  virtual size_t write(const uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) write(bytes[i]);
    return size;
  }
  void print(const char* text) { write(reinterpret_cast<const uint8_t*>(text), strlen(text)); }
  void print(char c) { write(static_cast<uint8_t>(c)); }
  void print(int value) { print(std::to_string(value).c_str()); }
  void print(unsigned value) { print(std::to_string(value).c_str()); }
  void print(double value, int digits = 2) {
    char text[64];
    snprintf(text, sizeof text, "%.*f", digits, value);
    print(text);
  }
  void println() { print("\r\n"); }
  template <class V>
  void println(V value) {
    print(value);
    println();
  }
  void println(double value, int digits) {
    print(value, digits);
    println();
  }
};

class Stream : public Print {
 public:
  std::deque<char> incoming;  // characters on the line, not yet received
  std::deque<char> received;  // characters in the receive buffer
  std::string outgoing;
  double characters_per_ms = 0, due = 0;
  int lost = 0;  // characters lost because the buffer was full
  void begin(unsigned long baud) { characters_per_ms = static_cast<double>(baud) / 1e4; }
  int available() { return static_cast<int>(received.size()); }
  int read() {
    if (received.empty()) return -1;
    const char c = received.front();
    received.pop_front();
    return static_cast<unsigned char>(c);
  }
  // Receives the characters that arrive in `ms` milliseconds. A full buffer loses them, as
  // Arduino's does.
  void pass(double ms) {
    for (due += ms * characters_per_ms; due >= 1; due -= 1) {
      if (incoming.empty()) {
        due = 0;
        return;
      }
      if (received.size() < 63) {
        received.push_back(incoming.front());
      } else {
        ++lost;
      }
      incoming.pop_front();
    }
  }
  using Print::write;
  size_t write(uint8_t byte) override {
    outgoing.push_back(static_cast<char>(byte));
    return 1;
  }
};
extern Stream Serial, Serial1;

extern uint16_t OCR4A, ICR4, TCNT3, OCR3A;
extern uint8_t TCCR4A, TCCR4B, TCCR3A, TCCR3B, TIMSK3, MCUSR;
enum {
  COM4A1 = 7,
  WGM41 = 1,
  WGM43 = 4,
  WGM42 = 3,
  CS41 = 1,
  WGM32 = 3,
  CS32 = 2,
  CS31 = 1,
  OCIE3A = 1
};
// Weak, because sketch and test case both define the interrupt: both include the board's header.
#define ISR(vector) extern "C" __attribute__((weak)) void vector()
