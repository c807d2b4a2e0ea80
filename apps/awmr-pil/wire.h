// Conversion between the host's structs for input and output of a control step and the bytes of the
// chip's structs awmr_input and awmr_output (little-endian, without padding).
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "awmr/control/autopilot.h"

namespace awmr::pil {

inline constexpr std::size_t kInputBytes = 67;
inline constexpr std::size_t kOutputBytes = 30;

class Writer {
 public:
  template <class V>
  Writer& put(V value) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof value);
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <class V>
  V get() {
    V value{};
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

inline std::vector<std::uint8_t> pack(const AutopilotInput& in) {
  Writer writer;
  writer.put(in.mode);
  for (const float value :
       {in.measured.psi_rad, in.measured.u_mps, in.measured.v_mps, in.measured.r_radps,
        in.position_m.x_m, in.position_m.y_m, in.reference.psi_rad, in.reference.psi_rate_radps,
        in.reference.psi_accel_radps2, in.reference.speed_mps, in.reference.accel_mps2}) {
    writer.put(value);
  }
  writer.put(in.times.now_ms).put(in.times.heading_ms);
  writer.put(in.times.speed_ms).put(in.times.command_ms);
  writer.put(in.speed_unsigned).put(in.position_is_fix).put(in.fix_ms);
  return writer.bytes();
}

inline AutopilotOutput unpack(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  AutopilotOutput out{};
  out.command.force.left = reader.get<float>();
  out.command.force.right = reader.get<float>();
  out.command.steering_rad = reader.get<float>();
  out.command.speed_limited = reader.get<std::uint8_t>() != 0;
  out.command.steering_limited = reader.get<std::uint8_t>() != 0;
  out.command.force_limited = reader.get<std::uint8_t>() != 0;
  out.command.steering_powerless = reader.get<std::uint8_t>() != 0;
  out.tau_speed = reader.get<float>();
  out.tau_turn_m = reader.get<float>();
  out.psi_ref_rad = reader.get<float>();
  out.arrived = reader.get<std::uint8_t>() != 0;
  out.fault = reader.get<std::uint8_t>();
  return out;
}

}  // namespace awmr::pil
