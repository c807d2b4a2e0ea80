/// Bounds-checked reading of numbers from untrusted bytes. Private to trials/.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

namespace awmr {

/// Returns the number in the first sizeof(T) bytes. `big`: the most significant byte comes first.
/// Precondition: `bytes` has at least sizeof(T) bytes.
template <class T>
T number_in(std::string_view bytes, bool big = false) {
  using Bits = std::conditional_t<
      sizeof(T) == 8, std::uint64_t,
      std::conditional_t<sizeof(T) == 4, std::uint32_t,
                         std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t at = big ? i : sizeof(T) - 1 - i;
    bits = (bits << 8U) | static_cast<unsigned char>(bytes[at]);
  }
  return std::bit_cast<T>(static_cast<Bits>(bits));
}

/// As number_in(), for numbers with the least significant byte first, converted to double.
template <class T>
double read_number(std::string_view bytes) {
  return static_cast<double>(number_in<T>(bytes));
}

/// Bytes with a read position.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t offset() const { return offset_; }
  std::size_t left() const { return bytes_.size() - offset_; }
  /// Returns the next `size` bytes and advances by them. If fewer are left, returns nothing and
  /// does not advance.
  std::optional<std::string_view> take(std::size_t size) {
    if (left() < size) return std::nullopt;
    const std::string_view taken = bytes_.substr(offset_, size);
    offset_ += size;
    return taken;
  }
  /// Returns the next number and advances past it. Returns nothing if fewer bytes are left.
  template <class T>
  std::optional<T> number(bool big = false) {
    const auto taken = take(sizeof(T));
    return taken ? std::optional<T>(number_in<T>(*taken, big)) : std::nullopt;
  }
  /// Moves to the offset, or to the end of the bytes if the offset is larger.
  void seek(std::size_t offset) { offset_ = offset < bytes_.size() ? offset : bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t offset_ = 0;
};

}  // namespace awmr
