/// Fuzz target: reads the bytes as a JSON document. The reader returns a document or a readable
/// error. A document that was written and read again is unchanged.
#include "awmr/core/json/json_document.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto json = awmr::read_json_text(awmr::fuzz::text_of(data, size), "a.json");
  if (!json) {
    require(!json.error().faults.empty(), "an error has at least one fault");
    require(awmr::to_text(json.error()).size() < 100'000, "the error text is short");
    return 0;
  }
  const auto again = awmr::read_json_text(awmr::to_text(*json), "b.json");
  require(again.has_value() && *again == *json, "a written document is read unchanged");
  std::vector<awmr::Fault> faults;
  awmr::JsonObject object(*json, "a.json", "", faults);
  (void)object.optional_string("schema");
  (void)object.number("a");
  (void)object.nullable_interval("b");
  (void)object.numbers("c");
  (void)object.strings("d");
  object.reject_unknown_keys();
  require(awmr::to_text(awmr::Error{awmr::ErrorKind::kInput, faults}).size() < 100'000,
          "the text of the faults is short");
  return 0;
}
