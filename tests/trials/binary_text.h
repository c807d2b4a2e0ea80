/// Generates minimal ULog, DataFlash and ROS 2 logs from the public format descriptions.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace awmr::testing {

/// Bytes of a number, least significant first (little-endian).
template <class T>
std::string le(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

// ULog

inline std::string ulog_header() {
  return std::string("ULog\x01\x12\x35\x01", 8) + le<std::uint64_t>(0);
}
inline std::string ulog_message(char type, const std::string& body) {
  return le(static_cast<std::uint16_t>(body.size())) + type + body;
}
inline std::string ulog_format(const std::string& text) { return ulog_message('F', text); }
inline std::string ulog_topic(std::uint8_t instance, std::uint16_t id, const std::string& name) {
  return ulog_message('A', le(instance) + le(id) + name);
}
inline std::string ulog_data(std::uint16_t id, std::uint64_t time_us, const std::string& fields) {
  return ulog_message('D', le(id) + le(time_us) + fields);
}

// DataFlash

inline std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}
inline std::string dataflash_format(std::uint8_t type, std::uint8_t length, const std::string& name,
                                    const std::string& format, const std::string& labels) {
  return std::string("\xA3\x95\x80", 3) + le(type) + le(length) + padded(name, 4) +
         padded(format, 16) + padded(labels, 64);
}
inline std::string dataflash_record(std::uint8_t type, const std::string& fields) {
  return std::string("\xA3\x95", 2) + le(type) + fields;
}

// CDR

/// Builds a ROS 2 message in CDR encoding: each number is aligned to a multiple of its size,
/// counted from the end of the header of four bytes.
class Cdr {
 public:
  template <class T>
  Cdr& add(T value) {
    while (body_.size() % sizeof(T) != 0) body_ += '\0';
    body_ += le(value);
    return *this;
  }
  Cdr& text(const std::string& value) {
    add(static_cast<std::uint32_t>(value.size() + 1));
    body_ += value + '\0';
    return *this;
  }
  Cdr& header() { return add(std::int32_t{1}).add(std::uint32_t{2}).text("base_link"); }
  Cdr& zeros(int count) {
    for (int i = 0; i < count; ++i) add(0.0);
    return *this;
  }
  std::string bytes() const { return std::string("\0\1\0\0", 4) + body_; }

 private:
  std::string body_;
};

}  // namespace awmr::testing
