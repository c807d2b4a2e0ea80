/// A ULog is read according to its topics, or refused. Memory is bounded.
#include "awmr/trials/ulog.h"

#include "fuzz/signals.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto all = [](const std::string&) { return true; };
  awmr::fuzz::check(awmr::read_ulog(awmr::fuzz::text_of(data, size), "a.ulg", all), size);
  return 0;
}
