/// Fuzz target for texts and numbers. A number that was written and read again has the same bits; a
/// text read from its CSV cell is unchanged; displayed text has no control characters.
#include <bit>
#include <cmath>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/text.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = awmr::fuzz::text_of(data, size);
  if (const auto number = awmr::number_from_text(text)) {
    require(std::isfinite(*number), "a number is finite");
    const auto again = awmr::number_from_text(awmr::format_number(*number));
    require(again && std::bit_cast<std::uint64_t>(*again) == std::bit_cast<std::uint64_t>(*number),
            "a number read again has the same bits");
  } else {
    require(number.error().size() < 1000, "the error text is short");
  }
  const std::string line = awmr::cell_of_text(text) + ",x\n";
  std::string_view rest = line;
  const auto cells = awmr::take_text_record(rest);
  require(cells.size() == 2 && cells[0] == text && rest.empty(), "a text is unchanged in its cell");
  for (const char c : awmr::printable(text)) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F, "no control character is shown");
  }
  require(awmr::shortened(text, 30).size() <= 35, "a shortened text is short");
  return 0;
}
