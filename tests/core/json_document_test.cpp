/// JSON documents: syntax, duplicate keys, and numbers that read back the same.
#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "awmr/core/json/json.h"
#include "core/any_finite.h"
#include "core/faults.h"
#include "support/scratch_file.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Result<Json> read_text(std::string_view text) {
  const ScratchFile file("a.json", text);
  return read_json_file(file.path());
}

TEST(JsonDocument, SyntaxFaultHasLineAndColumn) {
  EXPECT_THAT(
      faults_of(read_text("{\n  \"a\": 1,\n  \"b\": ]\n}\n")),
      ElementsAre(AllOf(StartsWith("a.json:3:8: this is not valid JSON: "), HasSubstr("']'"))));
}

TEST(JsonDocument, SyntaxFaultCountsCharactersAndNotTheByteOrderMark) {
  EXPECT_THAT(faults_of(read_text("\xEF\xBB\xBF{\"\xC3\xBC\": ]}")),
              ElementsAre(StartsWith("a.json:1:7: ")));
}

TEST(JsonDocument, EveryTruncationIsAFaultWithAPlace) {
  const std::string whole = "{\"a\": [1, -2.5e3, true], \"b\": {\"c\": \"x\\n\", \"d\": null}}";
  ASSERT_TRUE(read_text(whole));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto json = read_text(std::string_view(whole).substr(0, length));
    ASSERT_FALSE(json) << length;
    EXPECT_EQ(json.error().kind, ErrorKind::kInput);
    EXPECT_THAT(faults_of(json), ElementsAre(StartsWith(length == 0 ? "a.json: " : "a.json:1:")));
  }
}

TEST(JsonDocument, RefusesInvalidJson) {
  for (const char* text :
       {"{'a': 1}", "{\"a\": 1,}", "[1,]", "{\"a\": NaN}", "{\"a\": Infinity}", "{\"a\": .5}",
        "{\"a\": 0x10}", "{\"a\": +1}", "{\"a\": 01}", "{} {}", "{\"a\": 1} x", "// c\n{}",
        "{\"a\" 1}", "{a: 1}", "{\"a\": \"\xFF\"}", "{\"a\": \"\n\"}", "{\"a\": nan}"}) {
    EXPECT_THAT(faults_of(read_text(text)), ElementsAre(HasSubstr("this is not valid JSON: ")))
        << text;
  }
}

TEST(JsonDocument, EmptyFileMissingFileAndDirectory) {
  EXPECT_THAT(faults_of(read_text("")), ElementsAre(HasSubstr("the file is empty")));
  EXPECT_THAT(faults_of(read_text(" \n")), ElementsAre(HasSubstr("the file is empty")));
  EXPECT_THAT(faults_of(read_json_file("/no/such/a.json")), ElementsAre(HasSubstr("No such file")));
  EXPECT_THAT(faults_of(read_json_file("/tmp")), ElementsAre(HasSubstr("is a directory")));
}

TEST(JsonDocument, NumberTooLargeIsPlaced) {
  EXPECT_THAT(faults_of(read_text("{\n \"a\": 1e999}")),
              ElementsAre(AllOf(StartsWith("a.json:2:7: "), HasSubstr("out of range"),
                                HasSubstr("1e999"))));
}

TEST(JsonDocument, DuplicateKeysAreNamedByPointerAllAtOnce) {
  EXPECT_THAT(
      faults_of(read_text(
          R"({"a": {"b": 1, "b": 2}, "l": [0, [], {"x/y": 1, "c": {"q": 1}, "x/y": 2}], "a": 3})")),
      ElementsAre(StartsWith("a.json:/a/b: "), StartsWith("a.json:/l/2/x~1y: "),
                  StartsWith("a.json:/a: ")));
}

TEST(JsonDocument, TheSameKeyInTwoObjectsIsNoDuplicate) {
  EXPECT_TRUE(read_text(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})"));
}

TEST(JsonDocument, KeepsTheOrderOfKeys) {
  const auto json = read_text(R"({"z": 1, "a": 2, "m": 3})");
  ASSERT_TRUE(json);
  EXPECT_EQ(json->dump(), R"({"z":1,"a":2,"m":3})");
}

TEST(JsonDocument, TextIsIndentedAndEndsWithANewline) {
  EXPECT_EQ(to_text(Json{{"a", 0.1}, {"b", nullptr}}), "{\n  \"a\": 0.1,\n  \"b\": null\n}\n");
}

TEST(JsonDocument, TextOfANumberThatIsNotFiniteIsAFaultOfTheProgram) {
  Json json;
  json["a"] = Json::array({1.0, std::nan("")});
  try {
    (void)to_text(json);
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/a/1"));
  }
}

TEST(JsonDocument, ANameThatIsNoUtf8IsWrittenAsOne) {
  EXPECT_EQ(to_text(Json("a\xFFz")), "\"a\xEF\xBF\xBDz\"\n");
}

RC_GTEST_PROP(JsonDocument, NumbersReadBackTheSameBits, ()) {
  const double value = *any_finite();
  const auto json = read_text(to_text(Json{{"a", value}}));
  RC_ASSERT(json.has_value());
  RC_ASSERT(std::bit_cast<std::uint64_t>((*json)["a"].get<double>()) ==
            std::bit_cast<std::uint64_t>(value));
}

TEST(Provenance, IsWrittenAndReadBack) {
  const Provenance origin{
      "tune", {{"seed", "7"}, {"fit", "a"}, {"fit", "b"}}, {{"m.json", "00ff"}}};
  Json json;
  put_provenance(json, origin);
  EXPECT_EQ(json["version"], version());
  EXPECT_EQ(json["options"]["fit"], "a, b");
  std::vector<Fault> faults;
  JsonObject object(json, "a.json", "", faults);
  const Provenance back = read_provenance(object);
  object.reject_unknown_keys();
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(back.command, "tune");
  ASSERT_EQ(back.options.size(), 2U);
  EXPECT_EQ(back.options[0], (std::pair<std::string, std::string>("seed", "7")));
  ASSERT_EQ(back.inputs.size(), 1U);
  EXPECT_EQ(back.inputs[0].name, "m.json");
  EXPECT_EQ(back.inputs[0].sha256, "00ff");
}

}  // namespace
}  // namespace awmr::testing
