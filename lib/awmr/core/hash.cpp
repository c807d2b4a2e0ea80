#include "awmr/core/hash.h"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "awmr/core/file.h"

namespace awmr {

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("OpenSSL gives no SHA-256");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(path));
  return sha256_hex(bytes);
}

}  // namespace awmr
