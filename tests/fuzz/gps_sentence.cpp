/// For arbitrary bytes from the GPS: reading ends, and a fix is on the Earth and has a valid time
/// of day.
#include "awmr/control/gps_sentence.h"

#include <cmath>
#include <string>

#include "fuzz/target.h"

using awmr::fuzz::require;

namespace {

void take(awmr::RmcReader& reader, char c) {
  if (!reader.take(c) || reader.kind() != awmr::GpsSentence::kFix) return;
  const awmr::GpsFix fix = awmr::to_fix(reader.numbers());
  require(fix.utc_ms < awmr::kDay_ms, "time of day");
  require(fix.lat_e7 >= -900000000 && fix.lat_e7 <= 900000000, "latitude");
  require(fix.lon_e7 >= -1800000000 && fix.lon_e7 <= 1800000000, "longitude");
  require(std::isfinite(fix.speed_mps) && fix.speed_mps >= 0.0F, "speed");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  awmr::RmcReader reader;
  for (std::size_t i = 0; i < size; ++i) take(reader, static_cast<char>(data[i]));
  // With a corrected checksum, mutations reach the fields.
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
