/// Fuzz target: reads the bytes as GPS sentences. Every fix has a valid position, speed and time of
/// day.
#include "awmr/emit/board/gps_sentence.h"

#include <cmath>
#include <string>

#include "fuzz/target.h"

using awmr::fuzz::require;

namespace {

void take(awmr::RmcReader& reader, char c) {
  if (!reader.take(c) || reader.kind() != awmr::GpsSentence::kFix) return;
  const awmr::GpsFix fix = awmr::to_fix(reader.numbers());
  require(fix.utc_ms < awmr::kDay_ms, "the time of day is valid");
  require(fix.lat_e7 >= -900000000 && fix.lat_e7 <= 900000000, "the latitude is valid");
  require(fix.lon_e7 >= -1800000000 && fix.lon_e7 <= 1800000000, "the longitude is valid");
  require(std::isfinite(fix.speed_mps) && fix.speed_mps >= 0.0F, "the speed is finite and >= 0");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  awmr::RmcReader reader;
  for (std::size_t i = 0; i < size; ++i) take(reader, static_cast<char>(data[i]));
  // The same bytes as a sentence with a correct checksum, so that mutations reach the parsing of
  // the fields.
  std::string line = "$";
  unsigned sum = 0;
  for (std::size_t i = 0; i < size && data[i] != '*' && data[i] != 0; ++i) {
    if (data[i] == '$' || data[i] == '\r' || data[i] == '\n') continue;
    line += static_cast<char>(data[i]);
    sum ^= data[i];
  }
  constexpr const char* kDigits = "0123456789ABCDEF";
  line += '*';
  line += kDigits[sum >> 4U & 15U];
  line += kDigits[sum & 15U];
  for (const char c : line + '\n') take(reader, c);
  return 0;
}
