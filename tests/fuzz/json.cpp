/// A JSON document is read or refused. A document that was read, written and read again is the
/// same.
#include "awmr/core/json_document.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto json = awmr::read_json_text(awmr::fuzz::text_of(data, size), "a.json");
  if (!json) {
    require(!json.error().faults.empty(), "an error names a fault");
    require(awmr::to_text(json.error()).size() < 100'000, "an error can be read");
    return 0;
  }
  const auto again = awmr::read_json_text(awmr::to_text(*json), "b.json");
  require(again.has_value() && *again == *json, "what was written reads back equal");
  std::vector<awmr::Fault> faults;
  awmr::JsonObject object(*json, "a.json", "", faults);
  (void)object.optional_string("schema");
  (void)object.number("a");
  (void)object.nullable_interval("b");
  (void)object.numbers("c");
  (void)object.strings("d");
  object.reject_unknown_keys();
  require(awmr::to_text(awmr::Error{awmr::ErrorKind::kInput, faults}).size() < 100'000,
          "the faults can be read");
  return 0;
}
