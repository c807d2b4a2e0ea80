#include "awmr/core/files/hash.h"

#include <gmock/gmock.h>

#include "awmr/core/input_file.h"
#include "awmr/core/provenance.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

// Examples of FIPS 180-2, appendix B, and the empty message of the NIST SHA vectors.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(InputFile, HasTheNameWithoutItsDirectoryAndTheDigest) {
  const ScratchFile file("a.txt", "abc");
  const auto input = input_file(file.path());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->name, "a.txt");
  EXPECT_EQ(input->sha256, sha256_hex("abc"));
  EXPECT_FALSE(input_file("/no/such/file"));
}

TEST(Version, IsThreeNumbers) {
  EXPECT_THAT(version(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace awmr::testing
