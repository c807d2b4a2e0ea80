/// Runs a fuzz target without libFuzzer: on the files of a directory, then on mutations of them.
///
///   replay DIR MUTATIONS LAST_INPUT
///
/// The mutations have a fixed seed, so that runs are reproducible. LAST_INPUT is a file with the
/// current input; after a crash it contains the input that caused it.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/target.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Random = std::minstd_rand;

constexpr std::size_t kLongest = 4096;

/// Keywords of the file formats, which mutations insert.
constexpr std::array<std::string_view, 24> kWords = {
    "0",  "-",    "1e308",       "1e-320", "nan",  "inf", "99999999999999999999",
    "\"", "\\",   "\n",          "\r\n",   ",",    ";",   "{",
    "}",  "[",    "]",           "null",   "true", ":",   "`",
    "(",  "\xff", "\xEF\xBB\xBF"};

std::size_t below(std::size_t end, Random& random) { return random() % end; }

void put(Bytes& input, std::size_t place, const std::uint8_t* from, std::size_t count) {
  input.insert(input.begin() + static_cast<std::ptrdiff_t>(place), from, from + count);
}

/// Makes one small random change: a bit, a byte, a piece deleted, duplicated or taken from another
/// file, or an inserted keyword.
void change(Bytes& input, const Bytes& other, Random& random) {
  const std::size_t place = below(input.size() + 1, random);
  const std::size_t length = 1 + below(16, random);
  const std::size_t kind = below(6, random);
  if (kind == 0 && place < input.size()) {
    input[place] ^= static_cast<std::uint8_t>(1U << below(8, random));
  } else if (kind == 1 && place < input.size()) {
    input[place] = static_cast<std::uint8_t>(below(256, random));
  } else if (kind == 2) {
    const auto begin = input.begin() + static_cast<std::ptrdiff_t>(place);
    const std::size_t left = input.size() - place;
    input.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(length, left)));
  } else if (kind == 3) {
    const Bytes piece(
        input.begin() + static_cast<std::ptrdiff_t>(place),
        input.begin() + static_cast<std::ptrdiff_t>(std::min(input.size(), place + 8 * length)));
    put(input, below(input.size() + 1, random), piece.data(), piece.size());
  } else if (kind == 4 && !other.empty()) {
    const std::size_t from = below(other.size(), random);
    put(input, place, other.data() + from, std::min(8 * length, other.size() - from));
  } else {
    const std::string_view word = kWords[below(kWords.size(), random)];
    put(input, place, reinterpret_cast<const std::uint8_t*>(word.data()), word.size());
  }
  if (input.size() > kLongest) input.resize(kLongest);
}

/// File with the bytes of the current input. After a crash, it still exists.
class LastInput {
 public:
  explicit LastInput(const char* path) : path_{path} {
    const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || ftruncate(file, kLongest) != 0) return;
    void* at = mmap(nullptr, kLongest, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (at != MAP_FAILED) bytes_ = static_cast<std::uint8_t*>(at);
    close(file);
  }
  LastInput(const LastInput&) = delete;
  LastInput& operator=(const LastInput&) = delete;
  ~LastInput() { (void)std::remove(path_); }

  [[nodiscard]] bool open_for_writing() const { return bytes_ != nullptr; }
  /// Stores the input, or its first kLongest bytes if it is longer.
  void hold(const Bytes& input) {
    const std::size_t count = std::min(input.size(), kLongest);
    std::memcpy(bytes_, input.data(), count);
    std::memset(bytes_ + count, 0, kLongest - count);
  }

 private:
  const char* path_;
  std::uint8_t* bytes_ = nullptr;
};

std::vector<Bytes> files_of(const char* directory) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> files;
  for (const std::filesystem::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    files.emplace_back(bytes.begin(), bytes.end());
  }
  return files;
}

void run_mutations(const std::vector<Bytes>& seeds, std::size_t count, LastInput& last) {
  Random random(20261122);
  for (std::size_t i = 0; i < count; ++i) {
    Bytes input = seeds[i % seeds.size()];
    for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) {
      change(input, seeds[below(seeds.size(), random)], random);
    }
    last.hold(input);
    (void)LLVMFuzzerTestOneInput(input.data(), input.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 0;
  if (argc != 4 ||
      std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), count).ec != std::errc{}) {
    return 1;
  }
  const std::vector<Bytes> seeds = files_of(argv[1]);
  LastInput last(argv[3]);
  if (seeds.empty() || !last.open_for_writing()) return 1;
  for (const Bytes& seed : seeds) {
    last.hold(seed);
    (void)LLVMFuzzerTestOneInput(seed.data(), seed.size());
  }
  run_mutations(seeds, count, last);
  std::printf("%zu seeds, %zu mutations\n", seeds.size(), count);
  return 0;
}
