// I2C bus of the simulated sensors.
#pragma once
#include <Arduino.h>
class TwoWire {
 public:
  void begin() {}
  void setClock(uint32_t) {}
  void beginTransmission(uint8_t device);
  size_t write(uint8_t byte);
  uint8_t endTransmission(bool stop = true);
  uint8_t requestFrom(uint8_t device, uint8_t count);
  int read();
};
extern TwoWire Wire;
