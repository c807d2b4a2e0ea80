/// Strict reading of the keys of one JSON object.
#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "awmr/core/json/json.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Fixture with a document; faults() returns the faults of reading it as `PLACE: MESSAGE`.
class JsonObjectTest : public ::testing::Test {
 protected:
  JsonObject root(const char* text) {
    json_ = Json::parse(text);
    return {json_, "a.json", "", faults_};
  }
  std::vector<std::string> faults() const {
    std::vector<std::string> texts;
    for (const Fault& fault : faults_) texts.push_back(fault.place + ": " + fault.message);
    return texts;
  }
  Json json_;
  std::vector<Fault> faults_;
};

TEST_F(JsonObjectTest, ReadsEveryKindOfValue) {
  JsonObject object = root(
      R"({"n": 1.5, "i": -3, "b": true, "s": "x", "c": "two", "v": [1, 2], "l": [1, 2.5],
          "t": ["p", "q"], "o": {"k": 1}, "e": [{"k": 2}, {"k": 3}], "z": null, "y": null, "f": {}})");
  EXPECT_EQ(object.number("n"), 1.5);
  EXPECT_EQ(object.integer("i", -5, 5), -3);
  EXPECT_TRUE(object.boolean("b"));
  EXPECT_EQ(object.string("s"), "x");
  EXPECT_EQ(object.choice("c", std::array<std::string, 2>{"one", "two"}), 1U);
  EXPECT_EQ(object.interval("v").hi, 2.0);
  EXPECT_THAT(object.numbers("l"), ElementsAre(1.0, 2.5));
  EXPECT_THAT(object.strings("t"), ElementsAre("p", "q"));
  EXPECT_EQ(object.object("o").number("k"), 1.0);
  auto elements = object.objects("e");
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[1].number("k"), 3.0);
  EXPECT_EQ(object.nullable_number("z"), std::nullopt);
  EXPECT_FALSE(object.nullable_interval("y"));
  object.ignore("f");
  object.reject_unknown_keys();
  EXPECT_THAT(faults(), IsEmpty());
}

TEST_F(JsonObjectTest, CountsElementsWithFaults) {
  JsonObject object = root(R"({"empty": [], "bad": [0, "x"], "object": {"a": 1}, "text": "abc"})");
  EXPECT_EQ(object.size("empty"), 0U);
  EXPECT_EQ(object.size("bad"), 2U);
  EXPECT_THAT(object.numbers("bad"), ElementsAre(0.0));
  EXPECT_EQ(object.size("object"), 1U);
  EXPECT_FALSE(object.size("text"));
  EXPECT_FALSE(object.size("missing"));
}

TEST_F(JsonObjectTest, OptionalKeysMayBeAbsent) {
  JsonObject object = root("{}");
  EXPECT_FALSE(object.has("a"));
  EXPECT_FALSE(object.optional_number("a"));
  EXPECT_FALSE(object.optional_integer("a", 0, 1));
  EXPECT_FALSE(object.optional_boolean("a"));
  EXPECT_FALSE(object.optional_string("a"));
  EXPECT_FALSE(object.optional_interval("a"));
  EXPECT_FALSE(object.optional_object("a"));
  EXPECT_THAT(object.optional_objects("a"), IsEmpty());
  object.schema("awmr.model/1");
  EXPECT_THAT(faults(), IsEmpty());
}

TEST_F(JsonObjectTest, AReaderOfAnObjectRejectsItsUnknownKeys) {
  const auto read = [](JsonObject& json) { return json.number("k"); };
  JsonObject object = root(R"({"o": {"k": 1}, "e": [{"k": 2}, {"k": 3, "x": 0}], "p": {"y": 0}})");
  EXPECT_EQ(object.object("o", read), 1.0);
  EXPECT_EQ(object.optional_object("o", read), 1.0);
  EXPECT_FALSE(object.optional_object("absent", read));
  EXPECT_THAT(object.objects("e", read), ElementsAre(2.0, 3.0));
  EXPECT_THAT(object.optional_objects("absent", read), IsEmpty());
  EXPECT_TRUE(std::isnan(object.object("p", read)));
  EXPECT_TRUE(std::isnan(object.object("missing", read)));
  std::vector<std::string> places;
  for (const Fault& fault : faults_) places.push_back(fault.place);
  EXPECT_THAT(places,
              ElementsAre("a.json:/e/1/x", "a.json:/p/k", "a.json:/p/y", "a.json:/missing"));
}

TEST_F(JsonObjectTest, AReaderWithoutAValueRejectsUnknownKeys) {
  double sum = 0.0;
  const auto read = [&](JsonObject& json) { sum += json.number("k"); };
  JsonObject object = root(R"({"o": {"k": 1, "x": 0}, "e": [{"k": 2}, {"k": 3, "x": 0}]})");
  object.object("o", read);
  object.optional_object("absent", read);
  object.objects("e", read);
  EXPECT_EQ(sum, 6.0);
  std::vector<std::string> places;
  for (const Fault& fault : faults_) places.push_back(fault.place);
  EXPECT_THAT(places, ElementsAre("a.json:/o/x", "a.json:/e/1/x"));
}

TEST_F(JsonObjectTest, MissingKeysAreAllNamed) {
  JsonObject object = root("{}");
  EXPECT_TRUE(std::isnan(object.number("a")));
  (void)object.integer("b", 0, 1);
  (void)object.boolean("c");
  (void)object.string("d");
  (void)object.choice("e", std::array<std::string, 1>{"x"});
  (void)object.interval("f");
  (void)object.numbers("g");
  (void)object.strings("h");
  (void)object.objects("i");
  (void)object.nullable_number("j");
  (void)object.nullable_interval("k");
  ASSERT_EQ(faults_.size(), 11U);
  EXPECT_EQ(faults()[0], "a.json:/a: this key is missing; add it");
}

TEST_F(JsonObjectTest, AFileOfAnotherKindIsOneFault) {
  JsonObject object = root(R"({"schema": "awmr.gains/1", "heading": 1, "speed": 2})");
  object.schema("awmr.model/1");
  EXPECT_TRUE(std::isnan(object.number("mass")));
  EXPECT_TRUE(std::isnan(object.object("surge").number("alpha")));
  object.fault(ErrorCode::kMissing, "vehicle", "is empty");
  object.reject_unknown_keys();
  ASSERT_EQ(faults_.size(), 1U);
  EXPECT_EQ(faults_.front().code, ErrorCode::kWrongFile);
  EXPECT_EQ(faults_.front().place, "a.json:/schema");
}

TEST_F(JsonObjectTest, TheKnownKeysAreListedOnce) {
  JsonObject object = root(R"({"first": 1, "zzzzz": 2, "qqqqq": 3})");
  (void)object.number("first");
  object.reject_unknown_keys();
  EXPECT_THAT(faults(), ElementsAre("a.json:/zzzzz: unknown key; the keys here are first",
                                    "a.json:/qqqqq: unknown key"));
}

TEST_F(JsonObjectTest, AMissingObjectIsOneFaultAndItsReadsAreSilent) {
  JsonObject object = root("{}");
  JsonObject absent = object.object("o");
  EXPECT_TRUE(std::isnan(absent.number("k")));
  EXPECT_TRUE(std::isnan(absent.object("p").number("q")));
  absent.reject_unknown_keys();
  ASSERT_GE(faults_.size(), 1U);
  EXPECT_THAT(faults(), ElementsAre("a.json:/o: this key is missing; add it"));
}

TEST_F(JsonObjectTest, WrongTypesSayWhatWasFoundAndWhatIsExpected) {
  JsonObject object =
      root(R"({"a": "x", "b": 1, "c": [1, "y"], "d": 5, "e": null, "f": 1.5, "g": [1]})");
  (void)object.number("a");
  (void)object.boolean("b");
  (void)object.numbers("c");
  (void)object.object("d");
  (void)object.string("e");
  (void)object.integer("f", 0, 9);
  (void)object.objects("g");
  EXPECT_THAT(faults(),
              ElementsAre("a.json:/a: expected a number, found string \"x\"",
                          "a.json:/b: expected true or false, found number 1",
                          "a.json:/c/1: expected a number, found string \"y\"",
                          "a.json:/d: expected an object, found number 5",
                          "a.json:/e: expected a string, found null",
                          "a.json:/f: expected a whole number from 0 to 9, found number 1.5",
                          "a.json:/g/0: expected an object, found number 1"));
}

TEST_F(JsonObjectTest, ADocumentThatIsNoObjectIsNamedByItsFile) {
  JsonObject object = root("[1]");
  EXPECT_TRUE(std::isnan(object.number("a")));
  object.reject_unknown_keys();
  EXPECT_THAT(faults(), ElementsAre("a.json: expected an object, found array [1]"));
}

TEST_F(JsonObjectTest, RangesAreStatedAndTheirEndsAreAllowedOrNot) {
  JsonObject object = root(R"({"zero": 0, "one": 1, "two": 2, "minus": -1, "list": [1, -1]})");
  EXPECT_TRUE(std::isnan(object.number("zero", kPositive)));
  EXPECT_EQ(object.number("zero", kNonNegative), 0.0);
  EXPECT_EQ(object.number("one", {.min = 0.0, .max = 1.0}), 1.0);
  EXPECT_TRUE(std::isnan(object.number("two", {.min = 0.0, .max = 1.0})));
  (void)object.number("minus", kNonNegative);
  (void)object.number("two", {.max = 1.0});
  (void)object.numbers("list", kPositive);
  EXPECT_THAT(faults(),
              ElementsAre("a.json:/zero: expected a number above 0, found number 0",
                          "a.json:/two: expected a number at least 0 and at most 1, found number 2",
                          "a.json:/minus: expected a number at least 0, found number -1",
                          "a.json:/two: expected a number at most 1, found number 2",
                          "a.json:/list/1: expected a number above 0, found number -1"));
}

TEST_F(JsonObjectTest, WholeNumbersBeyondTheirRange) {
  JsonObject object = root(R"({"a": 18446744073709551615, "b": -9223372036854775808, "c": 3})");
  (void)object.integer("a", -10, -1);  // 2^64 - 1, which would be -1 if read as signed
  EXPECT_EQ(object.integer("b", std::numeric_limits<long>::min(), 0),
            std::numeric_limits<long>::min());
  (void)object.integer("c", 4, 9);
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("a.json:/a: "), HasSubstr("a.json:/c: ")));
}

TEST_F(JsonObjectTest, IntervalsHaveTwoEndsInOrder) {
  JsonObject object = root(R"({"a": [2, 1], "b": [1], "c": [1, "x"], "d": [1, 1]})");
  for (const char* key : {"a", "b", "c", "d"}) (void)object.interval(key);
  ASSERT_EQ(faults_.size(), 3U);
  EXPECT_EQ(faults()[0], "a.json:/a: expected [lo, hi] with lo <= hi, found array [2,1]");
}

TEST_F(JsonObjectTest, AChoiceNamesTheNearestOne) {
  JsonObject object = root(R"({"mode": "stearing", "other": "xyz", "number": 1})");
  const std::array<std::string, 3> modes{"differential", "steering", "combined"};
  for (const char* key : {"mode", "other", "number"}) (void)object.choice(key, modes);
  EXPECT_THAT(faults(),
              ElementsAre("a.json:/mode: expected one of differential, steering, combined, "
                          "found string \"stearing\"; did you mean steering?",
                          HasSubstr("found string \"xyz\""), HasSubstr("found number 1")));
}

TEST_F(JsonObjectTest, UnknownKeysNameTheNearestKnownOne) {
  JsonObject object = root(R"({"mass_kq": 37, "mass_kg": 1, "colour/paint~": "red"})");
  (void)object.number("mass_kg");
  (void)object.optional_number("length_m");
  object.reject_unknown_keys();
  EXPECT_THAT(
      faults(),
      ElementsAre("a.json:/mass_kq: unknown key; did you mean \"mass_kg\"?",
                  "a.json:/colour~1paint~0: unknown key; the keys here are length_m, mass_kg"));
}

TEST_F(JsonObjectTest, PointersGoThroughObjectsAndArrays) {
  JsonObject object = root(R"({"o": {"a/b": [{"k": "x"}]}})");
  JsonObject inner = object.object("o");
  (void)inner.objects("a/b")[0].number("k");
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("a.json:/o/a~1b/0/k: ")));
}

TEST_F(JsonObjectTest, AnotherSchemaIsNamed) {
  JsonObject object = root(R"({"schema": "awmr.gains/1"})");
  object.schema("awmr.model/1");
  EXPECT_THAT(faults(),
              ElementsAre("a.json:/schema: expected \"awmr.model/1\", found \"awmr.gains/1\": "
                          "give a file of the expected kind"));
}

TEST_F(JsonObjectTest, ALongValueIsCutBetweenCharacters) {
  std::string umlauts;
  for (int i = 0; i < 40; ++i) umlauts += "\xC3\xBC";
  JsonObject object = root(("{\"a\": \"" + umlauts + "\"}").c_str());
  (void)object.number("a");
  // The quote and 18 umlauts are 37 bytes.
  EXPECT_THAT(faults(), ElementsAre("a.json:/a: expected a number, found string \"" +
                                    umlauts.substr(0, 36) + "..."));
}

}  // namespace
}  // namespace awmr::testing
