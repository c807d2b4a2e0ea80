/// Derives a JSON Schema from a reader. In this mode a JsonObject reads no document: it records
/// each key that the reader requests, with the allowed values. Private to this folder.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/json.h"

namespace awmr {

/// One path through a reader: which optional keys are present, and which name each choice has, by
/// the choice's position. Choices without an entry have their first name.
struct Way {
  bool present = true;
  std::map<std::string, std::size_t> picks = {};
};

/// A choice that was found, and the way on which it was found.
struct MetChoice {
  std::size_t count = 0;  ///< number of names
  std::map<std::string, std::size_t> on = {};
};

/// State shared by all objects of one description.
struct Exploration {
  Way way = {};
  std::map<std::string, MetChoice> met = {};  ///< by position
};

class JsonShape {
 public:
  JsonShape(Exploration& exploration, std::string place);

  void begin();  ///< starts a new way; keys recorded on earlier ways are kept
  void requested(std::string_view key, bool required);
  bool has(std::string_view key);
  void type(std::string_view key, const Json& schema);
  std::size_t choice(std::string_view key, std::span<const std::string> choices);
  JsonShape& object(std::string_view key);
  JsonShape& element(std::string_view key);  ///< of an array of objects
  void close() { closed_ = true; }           ///< no other keys are allowed

  Json schema() const;

 private:
  struct Property {
    std::vector<Json> types;
    std::unique_ptr<JsonShape> object;
    std::unique_ptr<JsonShape> element;
  };
  /// Keys requested on one way.
  struct RequestedKeys {
    Way way;
    std::set<std::string> keys;
    std::set<std::string> required;
    std::set<std::string> optional;
  };
  /// Keys requested on several ways.
  struct Keys {
    std::set<std::string> all;
    std::set<std::string> present;   ///< if optional keys are present
    std::set<std::string> required;  ///< on at least one way
  };
  Property& property(std::string_view key);
  RequestedKeys& now();
  Json property_schema(const Property& property) const;
  Keys with_any_name(const std::string& key) const;
  Json names_of(const std::map<std::string, std::size_t>& picks) const;
  Json variant(const std::string& key, std::size_t pick, const Json& name) const;
  Json variant_without(const std::string& key) const;
  void add_variants(Json& schema) const;

  Exploration* exploration_;
  std::string place_;
  std::vector<std::pair<std::string, Property>> properties_;  ///< in the order of the requests
  std::vector<RequestedKeys> ways_;
  bool fresh_ = true;
  bool closed_ = false;
};

// Schemas of values that are not objects.
Json schema_of(const NumberRule& rule);
Json schema_of(long min, long max);
Json array_schema(Json items);
Json interval_schema();
Json or_null(const Json& schema);

}  // namespace awmr
