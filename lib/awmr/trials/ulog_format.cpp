#include "ulog_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "awmr/core/name_table.h"
#include "awmr/core/text.h"
#include "byte_reader.h"

namespace awmr::ulog {
namespace {

constexpr int kDeepest = 8;  ///< maximum nesting of types

constexpr NameTable<Basic, 12> kBasicNames{{{"int8_t", Basic::kI8},
                                            {"uint8_t", Basic::kU8},
                                            {"int16_t", Basic::kI16},
                                            {"uint16_t", Basic::kU16},
                                            {"int32_t", Basic::kI32},
                                            {"uint32_t", Basic::kU32},
                                            {"int64_t", Basic::kI64},
                                            {"uint64_t", Basic::kU64},
                                            {"float", Basic::kFloat},
                                            {"double", Basic::kDouble},
                                            {"bool", Basic::kBool},
                                            {"char", Basic::kChar}}};

std::size_t size_of(Basic type) {
  switch (type) {
    case Basic::kI16:
    case Basic::kU16:
      return 2;
    case Basic::kI32:
    case Basic::kU32:
    case Basic::kFloat:
      return 4;
    case Basic::kI64:
    case Basic::kU64:
    case Basic::kDouble:
      return 8;
    default:
      return 1;
  }
}

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
    const auto basic = value_in(kBasicNames, std::string_view(field.type));
    const bool is_padding = field.name.starts_with("_padding");
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name =
          prefix + field.name + (field.is_array ? fmt::format("[{}]", i) : std::string());
      if (!basic) {
        auto inner = lay_out(field.type, name + ".", depth + 1, formats, layout);
        if (!inner) return inner;
      } else {
        const bool is_number = *basic != Basic::kChar && !is_padding;
        if (is_number) layout.leaves.push_back({name, *basic, layout.bytes});
        layout.bytes += size_of(*basic);
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

double value_in(std::string_view bytes, Basic type) {
  switch (type) {
    case Basic::kI8:
      return number_in<std::int8_t>(bytes);
    case Basic::kI16:
      return number_in<std::int16_t>(bytes);
    case Basic::kU16:
      return number_in<std::uint16_t>(bytes);
    case Basic::kI32:
      return number_in<std::int32_t>(bytes);
    case Basic::kU32:
      return number_in<std::uint32_t>(bytes);
    case Basic::kI64:
      return static_cast<double>(number_in<std::int64_t>(bytes));
    case Basic::kU64:
      return static_cast<double>(number_in<std::uint64_t>(bytes));
    case Basic::kFloat:
      return static_cast<double>(number_in<float>(bytes));
    case Basic::kDouble:
      return number_in<double>(bytes);
    default:
      return number_in<std::uint8_t>(bytes);
  }
}

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
