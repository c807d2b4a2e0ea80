/// A row of the on-board log (file extension `.awl`). The control step writes it, and the idle loop
/// stores it on the card. trials/awl.h reads the file. Freestanding C++11.
///
///     file = headers and rows in any order, the first header before the first row
///     header = kLogHeaderBytes: kLogMagic, JSON padded with spaces, CRC-32 of the bytes before it
///     row = sync, CRC-16 of all bytes after it, sequence, the columns as the header lists them
///
/// All numbers are little-endian.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "awmr/control/crc.h"

namespace awmr {

/// First bytes of a header. The first byte is not valid in UTF-8, so no text file starts like this.
constexpr uint8_t kLogMagic[4] = {0xA7, 'A', 'W', 'L'};
/// Size of a header: four blocks of a card.
constexpr size_t kLogHeaderBytes = 2048;

/// Start of a row.
constexpr uint8_t kLogSync[2] = {0xB5, 0x62};
/// Number of bytes of a row before its columns: sync, CRC and sequence number.
constexpr size_t kLogRowHead = 8;
/// Offset in a row of the first byte that the row's CRC covers.
constexpr size_t kLogRowCovered = 4;

/// Inputs and outputs of the control step. Members are ordered so that no compiler adds padding.
struct LogRow {
  uint8_t sync[2];
  uint16_t crc;       ///< CRC-16; seal() computes it later, outside of the control step
  uint32_t sequence;  ///< number of this row since the start, from 0; also counts lost rows
  uint32_t step;      ///< time since the start, in sample times
  float force_left;   ///< command of each motor on the left, divided by F_max
  float force_right;  ///< command of each motor on the right, divided by F_max
  float steering_rad;
  float x_m;
  float y_m;
  float psi_rad;
  float u_mps;
  float r_radps;
  float psi_ref_rad;  ///< heading reference
  float u_ref_mps;
  float tau_speed;
  float tau_turn_m;
  uint8_t mode;   ///< a YawMode
  uint8_t fault;  ///< SafetyFault bits
  /// Limits and fault of this step. Bit 0: tau_speed was limited; bit 1: the steering angle was
  /// limited; bit 2: a wheel force was limited; bit 3: tau_speed was too small to steer. Bits 4 to
  /// 7: SensorFault (emit/board/sensor_fault.h) modulo 16.
  uint8_t limits;
  /// Bits 0 to 4: cause of the last reset of the board, the same in every row. Bit 7: the
  /// SensorFault in `limits` is 16 or more.
  uint8_t reset_cause;
};
static_assert(sizeof(LogRow) == 64, "eight rows fill a block of 512 bytes");

/// Sets sync and check sum of a row, which is then complete. Precondition: a little-endian machine.
inline void seal(LogRow& row) {
  uint8_t* bytes = reinterpret_cast<uint8_t*>(&row);
  row.sync[0] = kLogSync[0];
  row.sync[1] = kLogSync[1];
  row.crc = crc16_of(bytes + kLogRowCovered, sizeof row - kLogRowCovered);
}

}  // namespace awmr
