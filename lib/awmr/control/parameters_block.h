/// Parameters of the vehicle and the controller for the firmware, as blocks with a common check
/// sum.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "awmr/control/controller.h"
#include "awmr/control/crc.h"
#include "awmr/control/flash.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/safety.h"
#include "awmr/control/yaw_mode.h"

namespace awmr {

/// Size and layout of a ResistanceTable, as 32-bit numbers in flash.
struct TableShape {
  /// Number of lines. 0: there is no table, and the power law is computed by powf.
  uint32_t count;
  uint32_t first;          ///< ResistanceTable::first
  uint32_t mantissa_bits;  ///< ResistanceTable::mantissa_bits
};

/// Parameters that every firmware has. All members have 32 bits, so there is no padding. The bytes
/// and their check sum are therefore the same on every little-endian machine.
struct ParameterBlock {
  float surge_alpha_beta[2];  ///< a1, b1 of g1(u) = a1 u^b1
  float yaw_alpha_beta[2];    ///< a3, b3 of g3(r) = a3 r^b3
  ControlConstants<float> constants;
  SafetyLimits safety;
  TableShape surge_table;  ///< table of g1
  TableShape yaw_table;    ///< table of g3
};

/// Additional parameters for motors with a dead zone or back-EMF, or for friction that jumps at
/// rest. All members have 32 bits.
struct RestBlock {
  float dead_zone;         ///< dead zone F'0 of a motor, divided by F_max; 0: none
  float surge_rest_speed;  ///< RestingTable::rest_speed of g1, m/s; 0: no jump at rest
  float surge_at_rest;     ///< RestingTable::at_rest of g1
  /// RestingTable::rest_speed of the yaw resistance g3, rad/s, for each YawMode
  /// (Gains::friction_width_at()); 0: no jump at rest.
  float yaw_rest_speed[kYawModeCount];
  float yaw_at_rest[kYawModeCount];  ///< RestingTable::at_rest of g3, m, for each YawMode
  float back_emf_s_per_m;            ///< k_e of a motor, s/m; 0: none
};

/// Additional parameters for gains that were tuned with a disturbance observer. All members have 32
/// bits.
struct ObserverBlock {
  float bandwidth_radps;  ///< bandwidth L of DisturbanceObserver, rad/s
  float yaw_max_m;        ///< largest yaw moment that is compensated, divided by F_max
  float surge_max;        ///< largest surge force that is compensated, divided by F_max
  float sample_time_s;    ///< T_s, s: time between two steps
};

/// Gains of one mode, which replace ControlConstants::laws, and the observer of this mode.
struct GainsBlock {
  LawConstants<float> laws;
  float observer_radps;      ///< ObserverBlock::bandwidth_radps; 0: no observer in this mode
  float observer_yaw_max_m;  ///< ObserverBlock::yaw_max_m
  float observer_surge_max;  ///< ObserverBlock::surge_max
};
/// Additional parameters if the modes have gains of their own. All members have 32 bits.
struct ModeGainsBlock {
  GainsBlock in[kYawModeCount];  ///< for each YawMode
  /// T_s, s: time between two steps; 0: no mode has an observer.
  float observer_sample_time_s;
};

/// Continues the CRC-32 `crc` with `size` bytes. On an AVR, `address` is an address in flash.
inline uint32_t crc32_of_flash(uint32_t crc, const void* address, size_t size) {
  const uint8_t* bytes = static_cast<const uint8_t*>(address);
  for (size_t i = 0; i < size; ++i) crc = crc32_with(crc, flash_byte(bytes + i));
  return crc;
}

/// Computes the check sum of the firmware's parameters: CRC-32 of the block, of the lines of the
/// surge table and of the yaw table, then of `rest`, `observer` and `gains` if present.
inline uint32_t crc32_of_parameters(const ParameterBlock* block, const ResistanceLine* surge_lines,
                                    size_t surge_count, const ResistanceLine* yaw_lines,
                                    size_t yaw_count, const RestBlock* rest = 0,
                                    const ObserverBlock* observer = 0,
                                    const ModeGainsBlock* gains = 0) {
  uint32_t crc = crc32_of_flash(kCrc32Start, block, sizeof *block);
  crc = crc32_of_flash(crc, surge_lines, surge_count * sizeof(ResistanceLine));
  crc = crc32_of_flash(crc, yaw_lines, yaw_count * sizeof(ResistanceLine));
  if (rest != 0) crc = crc32_of_flash(crc, rest, sizeof *rest);
  if (observer != 0) crc = crc32_of_flash(crc, observer, sizeof *observer);
  return ~(gains != 0 ? crc32_of_flash(crc, gains, sizeof *gains) : crc);
}

/// Sets a resistance from the parameters in flash. There is one overload for each form that can be
/// compiled in: a table, or the power law with alpha and beta.
inline void set_resistance(const TableShape* shape, const float* /*alpha_beta*/,
                           const ResistanceLine* lines, ResistanceTable& table) {
  TableShape read;
  read_flash(shape, read);
  table.lines = lines;
  table.count = static_cast<uint16_t>(read.count);
  table.first = static_cast<uint16_t>(read.first);
  table.mantissa_bits = static_cast<uint8_t>(read.mantissa_bits);
}
inline void set_resistance(const TableShape* /*shape*/, const float* alpha_beta,
                           const ResistanceLine* /*lines*/, Resistance<float>& law) {
  law.alpha = flash_float(alpha_beta);
  law.beta = flash_float(alpha_beta + 1);
  law.rest_speed = 0.0F;
}

inline void set_resistance(const TableShape* shape, const float* alpha_beta,
                           const ResistanceLine* lines, RestingTable& law) {
  set_resistance(shape, alpha_beta, lines, law.table);
}

/// Sets rest_speed and at_rest from the parameters in flash. No-op if the resistance is not a
/// RestingTable.
template <class G>
void set_rest(const float* /*rest_speed*/, const float* /*at_rest*/, G&) {}
inline void set_rest(const float* rest_speed, const float* at_rest, RestingTable& law) {
  law.rest_speed = flash_float(rest_speed);
  law.at_rest = flash_float(at_rest);
}
/// Sets rest_speed and at_rest of the yaw resistance g3 to the values of the yaw mode. No-op if the
/// resistance is not a RestingTable.
template <class G>
void set_friction_width(const RestBlock* rest, uint8_t mode, G& yaw) {
  set_rest(&rest->yaw_rest_speed[mode], &rest->yaw_at_rest[mode], yaw);
}

}  // namespace awmr
