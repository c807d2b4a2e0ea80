/// Generates on-board logs (AWL files) with the chip's own code, or with arbitrary headers.
#pragma once

#include <cstring>
#include <string>

#include "awmr/trials/awl_row.h"
#include "binary_text.h"

namespace awmr::testing {

/// JSON text that describes the columns of LogRow, as awmr_log.h writes it.
inline std::string awl_json(const std::string& time_scale = "0.01") {
  std::string json =
      R"({"schema":"awmr.awl/1","parameters_sha256":"abc","row_bytes":64,"columns":[)"
      R"({"name":"t_s","type":"u32","scale":)" +
      time_scale + "}";
  for (const char* name :
       {"force_left", "force_right", "steering_cmd_deg", "x_m", "y_m", "heading_deg", "speed_mps",
        "yaw_rate_radps", "heading_ref_deg", "speed_ref_mps", "tau_speed", "tau_turn_m"}) {
    json += std::string(R"(,{"name":")") + name + R"(","type":"f32","scale":1})";
  }
  for (const char* name : {"mode", "fault", "limits", "reset_cause"}) {
    json += std::string(R"(,{"name":")") + name + R"(","type":"u8","scale":1})";
  }
  return json + "]}";
}

/// Returns the header of an on-board log with this text and a valid checksum.
inline std::string awl_header(const std::string& json) {
  std::string bytes(reinterpret_cast<const char*>(kLogMagic), sizeof kLogMagic);
  bytes += json;
  bytes.resize(kLogHeaderBytes - 4, ' ');
  std::uint32_t crc = kCrc32Start;
  for (const char c : bytes) crc = crc32_with(crc, static_cast<std::uint8_t>(c));
  return bytes + le(~crc);
}

/// A row, still without checksum, of a vehicle that accelerates and turns.
inline LogRow awl_row(std::uint32_t sequence) {
  const float t_s = 0.01F * static_cast<float>(sequence);
  LogRow row{};
  row.sequence = sequence;
  row.step = sequence;
  row.force_left = 0.25F + 0.01F * static_cast<float>(sequence % 7);
  row.force_right = 0.5F;
  row.steering_rad = 0.125F;
  row.psi_rad = 0.5F * t_s * t_s;
  row.u_mps = t_s;
  row.r_radps = t_s;
  return row;
}
inline std::string awl_bytes(LogRow row) {
  seal(row);
  std::string bytes(sizeof row, '\0');
  std::memcpy(bytes.data(), &row, sizeof row);
  return bytes;
}

/// Bytes of the rows with the numbers [from, to), without the log's header.
inline std::string awl_rows(std::uint32_t from, std::uint32_t to) {
  std::string bytes;
  for (std::uint32_t i = from; i < to; ++i) bytes += awl_bytes(awl_row(i));
  return bytes;
}
inline std::string awl_log(std::uint32_t rows) {
  return awl_header(awl_json()) + awl_rows(0, rows);
}

}  // namespace awmr::testing
