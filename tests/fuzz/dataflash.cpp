/// A DataFlash log is read according to its records, or refused. Memory is bounded.
#include "awmr/trials/dataflash.h"

#include "fuzz/signals.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto all = [](const std::string&) { return true; };
  awmr::fuzz::check(awmr::read_dataflash(awmr::fuzz::text_of(data, size), "a.bin", all), size);
  return 0;
}
