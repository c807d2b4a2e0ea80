#include "ulog_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr::ulog {
namespace {

constexpr int kDeepest = 8;  ///< maximum nesting of types

template <class T>
constexpr Basic basic(std::string_view name) {
  return {name, sizeof(T), read_number<T>};
}

constexpr std::array<Basic, 12> kBasics{
    basic<std::int8_t>("int8_t"),   basic<std::uint8_t>("uint8_t"),
    basic<std::int16_t>("int16_t"), basic<std::uint16_t>("uint16_t"),
    basic<std::int32_t>("int32_t"), basic<std::uint32_t>("uint32_t"),
    basic<std::int64_t>("int64_t"), basic<std::uint64_t>("uint64_t"),
    basic<float>("float"),          basic<double>("double"),
    basic<std::uint8_t>("bool"),    basic<std::uint8_t>("char")};

std::optional<Field> field_of(std::string_view text) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space == 0 || space + 1 == text.size())
    return std::nullopt;
  Field field{.type = std::string(text.substr(0, space)),
              .name = std::string(text.substr(space + 1))};
  const std::size_t open = field.type.find('[');
  if (open == std::string::npos) return field;
  const char* end = field.type.data() + field.type.size();
  const auto [stop, error] = std::from_chars(field.type.data() + open + 1, end, field.count);
  if (error != std::errc() || stop + 1 != end || *stop != ']') return std::nullopt;
  if (field.count == 0 || field.count > kLongestMessage) return std::nullopt;
  field.is_array = true;
  field.type.resize(open);
  return field;
}

/// Adds the numbers of a format to the layout, with `prefix` before their names. Errors: those of
/// layout_of().
tl::expected<void, std::string> lay_out(std::string_view format, const std::string& prefix,
                                        int depth, const Formats& formats, Layout& layout) {
  const auto found = formats.find(format);
  if (found == formats.end() || depth > kDeepest) {
    return tl::unexpected(fmt::format("\"{}\" is {}", shown(format),
                                      depth > kDeepest ? "nested too deep" : "an unknown type"));
  }
  for (const Field& field : found->second) {
    const auto* type = std::ranges::find(kBasics, field.type, &Basic::name);
    const bool is_padding = field.name.starts_with("_padding");
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name =
          prefix + field.name + (field.is_array ? fmt::format("[{}]", i) : std::string());
      if (type == kBasics.end()) {
        auto inner = lay_out(field.type, name + ".", depth + 1, formats, layout);
        if (!inner) return inner;
      } else {
        const bool is_number = type->name != "char" && !is_padding;
        if (is_number) layout.leaves.push_back({name, type, layout.bytes});
        layout.bytes += type->bytes;
        if (!is_padding) layout.needed = layout.bytes;
      }
      if (layout.bytes > kLongestMessage) {
        return tl::unexpected(
            fmt::format("the format \"{}\" is longer than any message", shown(format)));
      }
    }
  }
  return {};
}

}  // namespace

std::string shown(std::string_view text) { return printable(shortened(text, 60)); }

tl::expected<void, std::string> add_format(std::string_view text, Formats& formats) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) {
    return tl::unexpected(fmt::format("\"{}\" is not a format", shown(text)));
  }
  std::vector<Field> fields;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    if (one.empty()) continue;
    auto field = field_of(one);
    if (!field) return tl::unexpected(fmt::format("\"{}\" is not a field of a format", shown(one)));
    fields.push_back(*std::move(field));
  }
  if (fields.empty()) return tl::unexpected(fmt::format("\"{}\" has no fields", shown(text)));
  formats.insert_or_assign(std::string(text.substr(0, colon)), std::move(fields));
  return {};
}

tl::expected<Layout, std::string> layout_of(std::string_view format, const Formats& formats) {
  Layout layout;
  if (auto laid = lay_out(format, "", 0, formats, layout); !laid) {
    return tl::unexpected(std::move(laid.error()));
  }
  return layout;
}

}  // namespace awmr::ulog
