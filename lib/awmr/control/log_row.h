/// A row of the on-board log (`.awl`), as the control step leaves it and the card keeps it. The
/// chip writes what trials/awl.h reads. Freestanding C++11.
///
///     file = headers and rows in any order, the first header before the first row
///     header = kLogHeaderBytes: kLogMagic, JSON padded with spaces, CRC-32 of all before it
///     row = sync, CRC-16 of what follows, sequence, the columns as the header lists them
///
/// All numbers have their least significant byte first.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "awmr/control/crc.h"

namespace awmr {

/// How a header begins; the first byte is no UTF-8, so that no text begins like it.
constexpr uint8_t kLogMagic[4] = {0xA7, 'A', 'W', 'L'};
/// Four blocks of a card.
constexpr size_t kLogHeaderBytes = 2048;

/// How a row begins.
constexpr uint8_t kLogSync[2] = {0xB5, 0x62};
/// Sync, CRC and sequence, before a row's columns.
constexpr size_t kLogRowHead = 8;
/// Where the bytes begin that a row's CRC covers.
constexpr size_t kLogRowCovered = 4;

/// What the control step knew and did. Members stand where no compiler has to pad.
struct LogRow {
  uint8_t sync[2];
  uint16_t crc;       ///< written by seal(), outside of the control step
  uint32_t sequence;  ///< of the rows since the start, those that were lost counted
  uint32_t step;      ///< sample times since the start
  float force_left;   ///< of each wheel of the side, over F_max
  float force_right;
  float steering_rad;
  float x_m;
  float y_m;
  float psi_rad;
  float u_mps;
  float r_radps;
  float psi_ref_rad;  ///< the heading held or led to
  float u_ref_mps;
  float tau_speed;
  float tau_turn_m;
  uint8_t mode;         ///< a YawMode
  uint8_t fault;        ///< SafetyFault bits
  uint8_t limits;       ///< 1: speed, 2: steering, 4: force, 8: too little force to steer with;
                        ///< the upper four bits are a SensorFault (sensor_fault.h)
  uint8_t reset_cause;  ///< as the board says; the same in every row
};
static_assert(sizeof(LogRow) == 64, "eight rows fill a block of 512 bytes");

/// Makes a row that lies in memory as it lies in a file. Precondition: a little-endian machine.
inline void seal(LogRow& row) {
  uint8_t* bytes = reinterpret_cast<uint8_t*>(&row);
  row.sync[0] = kLogSync[0];
  row.sync[1] = kLogSync[1];
  row.crc = crc16_of(bytes + kLogRowCovered, sizeof row - kLogRowCovered);
}

}  // namespace awmr
