#include "json_shape.h"

#include <algorithm>
#include <utility>

#include "awmr/core/containers.h"

namespace awmr {
namespace {

/// Key under which a JsonShape records an object whose keys are arbitrary.
constexpr std::string_view kAnyKey = "*";

/// True if the choices in `picks` had the given names (indices) in the run `way` of the reader. A
/// choice that is not in Way::picks had its first name (index 0).
bool takes(const Way& way, const std::map<std::string, std::size_t>& picks) {
  return std::all_of(picks.begin(), picks.end(), [&](const auto& pick) {
    const auto taken = way.picks.find(pick.first);
    return taken == way.picks.end() ? pick.second == 0 : taken->second == pick.second;
  });
}

/// JSON Schema that forbids every key in `keys` that is not in `allowed`; an empty object if all
/// are allowed.
Json forbidding(const std::set<std::string>& keys, const std::set<std::string>& allowed) {
  Json rule = Json::object();
  for (const std::string& key : keys) {
    if (!allowed.contains(key)) rule["properties"][key] = false;
  }
  return rule;
}

}  // namespace

Json schema_of(const NumberRule& rule) {
  Json schema{{"type", "number"}};
  if (rule.min > kAnyNumber.min)
    schema[rule.min_excluded ? "exclusiveMinimum" : "minimum"] = rule.min;
  if (rule.max < kAnyNumber.max) {
    schema[rule.max_excluded ? "exclusiveMaximum" : "maximum"] = rule.max;
  }
  return schema;
}

Json schema_of(long min, long max) {
  return {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
}

Json array_schema(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json interval_schema(const NumberRule& rule) {
  Json schema = array_schema(schema_of(rule));
  schema["minItems"] = 2;
  schema["maxItems"] = 2;
  return schema;
}

Json or_null(const Json& schema) { return {{"anyOf", {schema, {{"type", "null"}}}}}; }

JsonShape::JsonShape(Exploration& exploration, std::string place)
    : exploration_(&exploration), place_(std::move(place)) {}

void JsonShape::begin() {
  fresh_ = true;
  for (auto& [key, property] : properties_) {
    if (property.object) property.object->begin();
    if (property.element) property.element->begin();
  }
}

JsonShape::RequestedKeys& JsonShape::now() {
  if (std::exchange(fresh_, false)) ways_.push_back({exploration_->way, {}, {}, {}});
  return ways_.back();
}

JsonShape::Property& JsonShape::property(std::string_view key) {
  for (auto& [name, property] : properties_) {
    if (name == key) return property;
  }
  properties_.emplace_back(std::string(key), Property{});
  return properties_.back().second;
}

void JsonShape::requested(std::string_view key, bool required) {
  property(key);
  RequestedKeys& requested = now();
  requested.keys.emplace(key);
  // The first request of a key decides whether it is optional. For example, a reader asks has()
  // before it reads an optional key.
  if (!required && !requested.required.contains(std::string(key))) requested.optional.emplace(key);
  if (required && !requested.optional.contains(std::string(key))) requested.required.emplace(key);
}

bool JsonShape::has(std::string_view key) {
  requested(key, false);
  return exploration_->way.present;
}

void JsonShape::type(std::string_view key, const Json& schema) {
  std::vector<Json>& types = property(key).types;
  if (!contains(types, schema)) types.push_back(schema);
}

std::size_t JsonShape::choice(std::string_view key, std::span<const std::string> choices) {
  type(key, {{"enum", std::vector<std::string>(choices.begin(), choices.end())}});
  const std::string place = place_ + "/" + std::string(key);
  exploration_->met.try_emplace(place, MetChoice{choices.size(), exploration_->way.picks});
  const auto pick = exploration_->way.picks.find(place);
  return pick == exploration_->way.picks.end() ? 0 : pick->second;
}

JsonShape& JsonShape::object(std::string_view key) {
  std::unique_ptr<JsonShape>& object = property(key).object;
  if (!object) {
    object = std::make_unique<JsonShape>(*exploration_, place_ + "/" + std::string(key));
  }
  object->now();
  return *object;
}

JsonShape& JsonShape::element(std::string_view key) {
  std::unique_ptr<JsonShape>& element = property(key).element;
  if (!element) {
    element = std::make_unique<JsonShape>(*exploration_, place_ + "/" + std::string(key) + "/0");
  }
  element->now();
  return *element;
}

Json JsonShape::property_schema(const Property& property) const {
  std::vector<Json> kinds = property.types;
  if (property.object) kinds.push_back(property.object->schema());
  if (property.element) kinds.push_back({{"type", "array"}, {"items", property.element->schema()}});
  if (kinds.empty()) return true;
  return kinds.size() == 1 ? kinds.front() : Json{{"anyOf", kinds}};
}

/// Collects the keys requested in all runs that differ only in the name of the choice `key`.
JsonShape::Keys JsonShape::with_any_name(const std::string& key) const {
  const std::string place = place_ + "/" + key;
  Keys keys;
  for (const RequestedKeys& one : ways_) {
    auto without = one.way.picks;
    without.erase(place);
    if (without != exploration_->met.at(place).on) continue;
    keys.all.insert(one.keys.begin(), one.keys.end());
    if (!one.way.present) continue;
    keys.present.insert(one.keys.begin(), one.keys.end());
    keys.required.insert(one.required.begin(), one.required.end());
  }
  return keys;
}

/// Rule of the JSON Schema for the documents in which the choice `key` has the value `name`:
/// requires the keys that always occur with this name, and forbids keys that occur only with other
/// names.
Json JsonShape::variant(const std::string& key, std::size_t pick, const Json& name) const {
  const std::string place = place_ + "/" + key;
  const auto& on = exploration_->met.at(place).on;
  auto at_least = on;
  at_least[place] = pick;
  std::set<std::string> allowed;
  std::set<std::string> required;
  bool first = true;
  const Keys keys = with_any_name(key);
  for (const RequestedKeys& one : ways_) {
    if (!takes(one.way, at_least)) continue;
    if (!one.way.present && one.optional.contains(key)) {
      // This run has no optional keys, so also not this choice. Keys requested only in such runs
      // are allowed with every name of the choice.
      for (const std::string& other : one.keys) {
        if (!keys.present.contains(other)) allowed.insert(other);
      }
      continue;
    }
    allowed.insert(one.keys.begin(), one.keys.end());
    // A key is required if the reader requires it in every run with this name.
    if (std::exchange(first, false)) required = one.required;
    std::erase_if(required, [&](const std::string& k) { return !one.required.contains(k); });
  }
  Json then = forbidding(keys.all, allowed);
  if (!required.empty()) then["required"] = required;
  return {{"if", {{"properties", {{key, {{"const", name}}}}}, {"required", {key}}}},
          {"then", then}};
}

/// JSON Schema that accepts a document if the choices of this object have the given names. `picks`:
/// the index of the name of each choice, by JSON pointer.
Json JsonShape::names_of(const std::map<std::string, std::size_t>& picks) const {
  Json rule = Json::object();
  for (const auto& [key, property] : properties_) {
    const auto pick = picks.find(place_ + "/" + key);
    if (pick == picks.end()) continue;
    rule["properties"][key] = {{"const", property.types.front().at("enum")[pick->second]}};
    rule["required"].push_back(key);
  }
  return rule;
}

/// Rule of the JSON Schema for documents without the optional choice `key`, which then has its
/// default name: requires the keys that this name requires, and forbids keys that occur only with
/// other names. Empty if the choice is not optional.
Json JsonShape::variant_without(const std::string& key) const {
  const auto& on = exploration_->met.at(place_ + "/" + key).on;
  const RequestedKeys* absent = nullptr;
  std::set<std::string> allowed;
  for (const RequestedKeys& one : ways_) {
    if (one.way.picks != on || !one.optional.contains(key)) continue;
    allowed.insert(one.keys.begin(), one.keys.end());
    if (!one.way.present && absent == nullptr) absent = &one;
  }
  if (absent == nullptr) return Json::object();
  const Keys keys = with_any_name(key);
  Json then = forbidding(keys.all, allowed);
  std::set<std::string> required = absent->required;
  // Drop keys that the reader requires only in runs without optional keys: they do not depend on
  // this choice.
  std::erase_if(required, [&](const std::string& k) { return !keys.required.contains(k); });
  then["required"] = required;
  Json where = names_of(on);
  where["not"] = {{"required", {key}}};
  return {{"if", where}, {"then", then}};
}

/// Adds the rules of variant() and variant_without() to the schema, for each choice whose value
/// decides which other keys are allowed.
void JsonShape::add_variants(Json& schema) const {
  for (const auto& [key, property] : properties_) {
    const auto met = exploration_->met.find(place_ + "/" + key);
    if (met == exploration_->met.end() || key == kAnyKey) continue;
    std::vector<Json> rules;
    const Json& names = property.types.front().at("enum");
    for (std::size_t pick = 0; pick < met->second.count; ++pick) {
      rules.push_back(variant(key, pick, names[pick]));
    }
    const bool decides = std::any_of(rules.begin(), rules.end(), [&](const Json& rule) {
      return rule.at("then") != rules.front().at("then");
    });
    if (const Json absent = variant_without(key); decides && !absent.empty()) {
      rules.push_back(absent);
    }
    for (const Json& rule : rules) {
      if (decides && !rule.at("then").empty()) schema["allOf"].push_back(rule);
    }
  }
}

Json JsonShape::schema() const {
  Json schema{{"type", "object"}};
  std::set<std::string> required;
  for (const RequestedKeys& one : ways_) {
    if (&one == &ways_.front()) required = one.required;
    std::erase_if(required, [&](const std::string& key) { return !one.required.contains(key); });
  }
  required.erase(std::string(kAnyKey));
  if (closed_) schema["additionalProperties"] = false;
  for (const auto& [key, property] : properties_) {
    if (key == kAnyKey) {
      schema["additionalProperties"] = property_schema(property);
    } else {
      schema["properties"][key] = property_schema(property);
    }
  }
  if (!required.empty()) schema["required"] = required;
  add_variants(schema);
  return schema;
}

std::string json_schema_text(std::string_view format, std::string_view title,
                             const std::function<void(JsonObject&)>& read) {
  Exploration exploration;
  JsonShape root(exploration, "");
  std::vector<Way> ways{{}};
  std::set<std::string> followed;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (const bool present : {true, false}) {
      exploration.way = {present, ways[i].picks};
      root.begin();
      std::vector<Fault> ignored;
      JsonObject json(root, ignored);
      read(json);
    }
    for (const auto& [place, choice] : exploration.met) {
      if (!followed.insert(place).second) continue;
      for (std::size_t pick = 1; pick < choice.count; ++pick) {
        ways.push_back({true, choice.on});
        ways.back().picks[place] = pick;
      }
    }
  }
  Json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["$id"] = format;
  schema["title"] = title;
  schema.update(root.schema());
  return to_text(schema);
}

}  // namespace awmr
