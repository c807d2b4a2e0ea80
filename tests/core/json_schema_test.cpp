/// JSON Schemas from the functions that read.
#include <gmock/gmock.h>

#include "awmr/core/json.h"

namespace awmr {
namespace {

Json schema_from(const std::function<void(JsonObject&)>& read) {
  return Json::parse(json_schema_text("test/1", "A test", read));
}

TEST(JsonSchema, HasWhatTheReaderAsksFor) {
  const Json schema = schema_from([](JsonObject& json) {
    json.schema("test/1");
    json.number("mass", {.min = 0.0, .max = 10.0, .min_excluded = true});
    json.optional_integer("count", 1, 5);
    json.nullable_number("maybe");
    json.numbers("list", kNonNegative);
    json.interval("range");
    json.rows("matrix");
    json.ignore("whatever");
    json.reject_unknown_keys();
  });
  const Json& properties = schema.at("properties");
  EXPECT_EQ(schema.at("$id"), "test/1");
  EXPECT_EQ(properties.at("schema"), Json({{"const", "test/1"}}));
  EXPECT_EQ(properties.at("mass"),
            Json({{"type", "number"}, {"exclusiveMinimum", 0.0}, {"maximum", 10.0}}));
  EXPECT_EQ(properties.at("count"), Json({{"type", "integer"}, {"minimum", 1}, {"maximum", 5}}));
  EXPECT_EQ(properties.at("maybe").at("anyOf").size(), 2U);
  EXPECT_EQ(properties.at("list").at("items").at("minimum"), 0.0);
  EXPECT_EQ(properties.at("range").at("maxItems"), 2);
  EXPECT_EQ(properties.at("matrix").at("items").at("type"), "array");
  EXPECT_EQ(properties.at("whatever"), true);
  EXPECT_EQ(schema.at("required"), Json({"list", "mass", "matrix", "maybe", "range"}));
  EXPECT_EQ(schema.at("additionalProperties"), false);
}

TEST(JsonSchema, GoesDownIntoObjectsThatMayBeThere) {
  const Json schema = schema_from([](JsonObject& json) {
    if (auto part = json.optional_object("part")) {
      part->string("name");
      part->reject_unknown_keys();
    }
    for (JsonObject& one : json.objects("all")) one.boolean("good");
    for (const std::string& key : json.object("free").keys()) json.object("free").number(key);
  });
  EXPECT_EQ(schema.at("required"), Json({"all", "free"}));
  EXPECT_EQ(schema.at("/properties/part/required"_json_pointer), Json({"name"}));
  EXPECT_EQ(schema.at("/properties/all/items/properties/good/type"_json_pointer), "boolean");
  EXPECT_EQ(schema.at("/properties/free/additionalProperties/type"_json_pointer), "number");
  EXPECT_FALSE(schema.contains("additionalProperties"));
}

constexpr NameTable<int, 3> kKinds{{{"point", 0}, {"circle", 1}, {"box", 2}}};

TEST(JsonSchema, TellsWhichKeysGoWithWhichName) {
  const Json schema = schema_from([](JsonObject& json) {
    const int kind = json.choice("kind", kKinds);
    json.choice("colour", kKinds);  // decides nothing
    if (kind == 1) json.number("radius");
    if (kind == 2) json.number("width");
    json.reject_unknown_keys();
  });
  ASSERT_EQ(schema.at("allOf").size(), 3U);
  const Json& circle = schema.at("allOf").at(1);
  EXPECT_EQ(circle.at("/if/properties/kind/const"_json_pointer), "circle");
  EXPECT_EQ(circle.at("/then/required"_json_pointer), Json({"colour", "kind", "radius"}));
  EXPECT_EQ(circle.at("/then/properties"_json_pointer), Json({{"width", false}}));
}

TEST(JsonSchema, TellsWhichKeysGoWithAChoiceThatIsNotMade) {
  const Json schema = schema_from([](JsonObject& json) {
    int kind = 1;
    if (json.has("kind")) kind = json.choice("kind", kKinds);
    if (kind == 1) json.number("radius");
    if (kind == 2) json.number("width");
  });
  const Json& absent = schema.at("allOf").back();
  EXPECT_EQ(absent.at("/if/not/required"_json_pointer), Json({"kind"}));
  EXPECT_EQ(absent.at("/then/required"_json_pointer), Json({"radius"}));
  EXPECT_EQ(absent.at("/then/properties"_json_pointer), Json({{"width", false}}));
}

}  // namespace
}  // namespace awmr
