/// Fuzz target: reads the bytes as a DataFlash log. The reader returns consistent signals or an
/// error. Memory is bounded.
#include "awmr/trials/formats/log_formats.h"

#include "fuzz/signals.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto all = [](const std::string&) { return true; };
  awmr::fuzz::check(awmr::read_dataflash(awmr::fuzz::text_of(data, size), "a.bin", all), size);
  return 0;
}
