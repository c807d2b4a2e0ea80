/* The on-board log: one row of 64 bytes per step, through a ring buffer, to a file for `awmr log`
   and `awmr identify --log`. C++11; include it only where it is used, because the ring needs RAM.

     control step (an interrupt):  awmr_log::put(ring, input, output, step, reset_cause);
     idle loop:                    awmr_log::drain(ring, file);

   The step copies 56 bytes and never waits. The loop computes check sums and writes to the card. If
   the card blocks the loop for too long, the ring is full and rows are lost. `awmr log` reports
   this, because their sequence numbers are missing in the file. */
#ifndef AWMR_LOG_H
#define AWMR_LOG_H

#include "awmr.h"
#include "awmr/control/flash.h"
#include "awmr/emit/board/log_ring.h"

namespace awmr_log {

/* Eight blocks of 512 bytes: 4 KiB of a Mega's 8 KiB of RAM. They hold the rows of 56 sample times,
   0.56 s at 10 ms. The SD standard permits a card to be busy for 0.25 s. */
typedef awmr::LogRing<8> Ring;

#define AWMR_LOG_COLUMN(name, type, scale) \
  ",{\"name\":\"" name "\",\"type\":\"" type "\",\"scale\":" scale "}"
const char kHeaderText[] AWMR_IN_FLASH =
    "{\"schema\":\"awmr.awl/1\",\"parameters_sha256\":\"" AWMR_PARAMS_SHA256 "\",\"row_bytes\":64,"
    "\"columns\":[{\"name\":\"t_s\",\"type\":\"u32\",\"scale\":" AWMR_SAMPLE_TIME_TEXT "}"
    AWMR_LOG_COLUMN("force_left", "f32", "1")
    AWMR_LOG_COLUMN("force_right", "f32", "1")
    AWMR_LOG_COLUMN("steering_cmd_deg", "f32", "57.29577951308232")
    AWMR_LOG_COLUMN("x_m", "f32", "1")
    AWMR_LOG_COLUMN("y_m", "f32", "1")
    AWMR_LOG_COLUMN("heading_deg", "f32", "57.29577951308232")
    AWMR_LOG_COLUMN("speed_mps", "f32", "1")
    AWMR_LOG_COLUMN("yaw_rate_radps", "f32", "1")
    AWMR_LOG_COLUMN("heading_ref_deg", "f32", "57.29577951308232")
    AWMR_LOG_COLUMN("speed_ref_mps", "f32", "1")
    AWMR_LOG_COLUMN("tau_speed", "f32", "1")
    AWMR_LOG_COLUMN("tau_turn_m", "f32", "1")
    AWMR_LOG_COLUMN("mode", "u8", "1")
    AWMR_LOG_COLUMN("fault", "u8", "1")
    AWMR_LOG_COLUMN("limits", "u8", "1")
    AWMR_LOG_COLUMN("reset_cause", "u8", "1") "]}";
#undef AWMR_LOG_COLUMN
static_assert(sizeof kHeaderText <= awmr::kLogHeaderBytes - 8, "");

/* Adds one row; if the ring is full, the row is lost. `sensor_fault` is an awmr::SensorFault. */
template <uint8_t kBlocks>
inline void put(awmr::LogRing<kBlocks>& ring, const awmr_input& in, const awmr_output& out,
                uint32_t step, uint8_t reset_cause, uint8_t sensor_fault = 0) {
  awmr::LogRow* row = ring.begin_row();
  if (row == 0) return;
  row->step = step;
  row->force_left = out.force_left;
  row->force_right = out.force_right;
  row->steering_rad = out.steering_rad;
  row->x_m = in.x_m;
  row->y_m = in.y_m;
  row->psi_rad = in.psi_rad;
  row->u_mps = in.u_mps;
  row->r_radps = in.r_radps;
  row->psi_ref_rad = out.psi_ref_rad;
  row->u_ref_mps = in.u_ref_mps;
  row->tau_speed = out.tau_speed;
  row->tau_turn_m = out.tau_turn_m;
  row->mode = in.mode;
  row->fault = out.fault;
  row->limits = static_cast<uint8_t>(out.speed_limited | out.steering_limited << 1 |
                                     out.force_limited << 2 | out.steering_powerless << 3 | sensor_fault << 4);
  row->reset_cause = static_cast<uint8_t>(reset_cause | (sensor_fault & 16) << 3);
  ring.end_row();
}

/* Writes a header. Call it twice: with two headers, one damaged byte does not make the file
   unreadable. A sink has size_t write(const uint8_t*, size_t), like Arduino's File and Serial.
   False: the sink accepted fewer bytes. */
template <class Sink>
bool write_header(Sink& sink) {
  bool good = true;
  uint32_t crc = awmr::kCrc32Start;
  const uint8_t* text = reinterpret_cast<const uint8_t*>(kHeaderText);
  for (size_t at = 0; at < awmr::kLogHeaderBytes;) {
    uint8_t chunk[64];
    for (uint8_t i = 0; i < sizeof chunk; ++i, ++at) {
      const size_t in_text = at - sizeof awmr::kLogMagic;
      if (at < sizeof awmr::kLogMagic) {
        chunk[i] = awmr::kLogMagic[at];
      } else if (at >= awmr::kLogHeaderBytes - 4) {
        chunk[i] = static_cast<uint8_t>(~crc >> 8 * (at - (awmr::kLogHeaderBytes - 4)));
        continue;
      } else {
        chunk[i] = in_text < sizeof kHeaderText - 1 ? awmr::flash_byte(text + in_text) : ' ';
      }
      crc = awmr::crc32_with(crc, chunk[i]);
    }
    good = sink.write(static_cast<const uint8_t*>(chunk), sizeof chunk) == sizeof chunk && good;
  }
  return good;
}

enum Drained { kNothing, kWritten, kFailed };

/* Writes the oldest block of the ring if it is complete. Before the file is closed, `rest` also
   writes an incomplete block. If the sink does not accept a block, its rows are lost and the result
   is kFailed. */
template <uint8_t kBlocks, class Sink>
Drained drain(awmr::LogRing<kBlocks>& ring, Sink& sink, bool rest = false) {
  const uint8_t rows = ring.ready(rest);
  if (rows == 0) return kNothing;
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(ring.sealed(rows));
  const size_t size = rows * sizeof(awmr::LogRow);
  const bool good = sink.write(bytes, size) == size;
  ring.release(rows);
  return good ? kWritten : kFailed;
}

}  // namespace awmr_log

#endif /* AWMR_LOG_H */
