#include "awmr/control/crc.h"

#include <gtest/gtest.h>

#include <string>

namespace awmr::testing {
namespace {

TEST(Crc, GivesItsCatalogueValues) {
  std::uint32_t crc = kCrc32Start;
  for (const char c : std::string("123456789")) crc = crc32_with(crc, static_cast<std::uint8_t>(c));
  EXPECT_EQ(~crc, 0xCBF43926U);
  const std::uint8_t bytes[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16_of(bytes, sizeof bytes), 0x29B1);
}

}  // namespace
}  // namespace awmr::testing
