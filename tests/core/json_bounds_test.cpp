/// JSON designed to exhaust the reader is refused with a place, in time and memory proportional to
/// its length.
#include <gmock/gmock.h>

#include <ctime>

#include "awmr/core/json/json_document.h"
#include "core/faults.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += part;
  return all;
}

/// Returns a JSON object with many keys: `{"0": 0, "1": 0, ...}`.
std::string object_of(std::size_t keys) {
  std::string text;
  for (std::size_t i = 0; i < keys; ++i) {
    text += i == 0 ? "{\"" : ",\"";
    text += std::to_string(i);
    text += "\":0";
  }
  text += '}';
  return text;
}

/// Returns the processor time of a call, s.
template <class Work>
double seconds(Work work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(JsonBounds, RefusesNestingBeyond64) {
  for (const std::string_view open : {"[", "{\"a\":"}) {
    const std::string bomb = repeated(open, 80000);
    EXPECT_THAT(faults_of(read_json_text(bomb, "a.json")),
                ElementsAre(AllOf(StartsWith("a.json:1:"), HasSubstr("more than 64 deep"))));
  }
}

TEST(JsonBounds, NestingAtTheBoundIsRead) {
  EXPECT_TRUE(read_json_text(repeated("[", 64) + repeated("]", 64), "a.json"));
  EXPECT_THAT(faults_of(read_json_text(joined({"[\n", repeated("[", 64)}), "a.json")),
              ElementsAre(StartsWith("a.json:2:64: ")));
}

TEST(JsonBounds, BracketsAndCommasInTextsAreNoValues) {
  EXPECT_TRUE(read_json_text(joined({"{\"a\\\"", repeated("[{,", 10000), "\": 1}"}), "a.json"));
}

TEST(JsonBounds, RefusesDuplicateKeysNested5000Deep) {
  std::string bomb;
  for (int i = 0; i < 5000; ++i) bomb += R"({"a":1,"a":)";
  EXPECT_THAT(faults_of(read_json_text(bomb, "a.json")), SizeIs(1));
}

TEST(JsonBounds, NamesAHundredDuplicateKeysAtMost) {
  EXPECT_THAT(
      faults_of(read_json_text(joined({"{", repeated("\"a\":1,", 100000), "\"a\":1}"}), "a.json")),
      SizeIs(100));
}

TEST(JsonBounds, ReadsAMillionKeysWithin20Seconds) {
  const std::string text = object_of(1'000'000);
  EXPECT_LT(seconds([&] {
              const auto json = read_json_text(text, "a.json");
              ASSERT_TRUE(json);
              EXPECT_EQ(json->size(), 1'000'000U);
              std::vector<Fault> faults;
              JsonObject object(*json, "a.json", "", faults);
              object.ignore("name");
              object.reject_unknown_keys();
              EXPECT_THAT(faults, SizeIs(100));
            }),
            20.0);
}

TEST(JsonBounds, RefusesMoreThanTwoMillionValues) {
  EXPECT_THAT(faults_of(read_json_text(joined({"[", repeated("0,", 2'000'001), "0]"}), "a.json")),
              ElementsAre(HasSubstr("more than 2000000 values")));
}

TEST(JsonBounds, AFileBeyond64MebibytesIsNotRead) {
  const ScratchFile file("a.json", "{}");
  std::filesystem::resize_file(file.path(), kMaxJsonBytes + 1);
  EXPECT_THAT(faults_of(read_json_file(file.path())), ElementsAre(HasSubstr("longer than 64 MiB")));
  EXPECT_THAT(faults_of(read_json_file("/dev/zero")), ElementsAre(HasSubstr("longer than 64 MiB")));
}

TEST(JsonBounds, ALongTokenIsShownShortened) {
  const auto json =
      read_json_text(joined({"{\"a\": \"", std::string(10'000'000, 'x'), "\n\"}"}), "a.json");
  ASSERT_FALSE(json);
  EXPECT_LT(to_text(json.error()).size(), 2200U);
}

TEST(JsonBounds, ALongUnknownKeyIsShownShortened) {
  const auto json =
      read_json_text(joined({"{\"", std::string(10'000'000, 'x'), "\": 1}"}), "a.json");
  ASSERT_TRUE(json);
  std::vector<Fault> faults;
  JsonObject object(*json, "a.json", "", faults);
  object.ignore("name");
  object.reject_unknown_keys();
  EXPECT_LT(to_text(Error{ErrorKind::kInput, faults}).size(), 2200U);
}

}  // namespace
}  // namespace awmr::testing
