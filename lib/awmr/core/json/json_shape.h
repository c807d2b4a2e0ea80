/// Derives the JSON Schema of a file from the function that reads it (the reader), for
/// json_schema_text(). The reader runs several times on JsonObjects without a document, which
/// record in a JsonShape each key that it requests, with the permitted values. A choice is a key
/// whose value is one of several names (JsonObject::choice()). The runs try all names, because the
/// name can decide which other keys exist. Private to core/.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/json/json.h"

namespace awmr {

/// Settings of one run of the reader: the kind of document that the run assumes.
struct Way {
  bool present = true;  ///< true: all optional keys are present; false: none is
  /// For each choice, by its JSON pointer: the index of the name that JsonObject::choice() returns
  /// in this run. A choice that is not in the map gets its first name.
  std::map<std::string, std::size_t> picks = {};
};

/// A choice that the reader requested.
struct MetChoice {
  std::size_t count = 0;  ///< number of its names
  /// Names of the other choices (as in Way::picks) in the run that first requested this choice.
  std::map<std::string, std::size_t> on = {};
};

/// State of the search for all keys of a schema, shared by the JsonShapes of its objects.
struct Exploration {
  Way way = {};                               ///< settings of the current run of the reader
  std::map<std::string, MetChoice> met = {};  ///< choices requested so far, by JSON pointer
};

/// Records the keys that a reader requests from one JSON object.
class JsonShape {
 public:
  JsonShape(Exploration& exploration, std::string place);

  void begin();  ///< starts a new run of the reader; the keys of earlier runs are kept
  void requested(std::string_view key, bool required);
  bool has(std::string_view key);
  void type(std::string_view key, const Json& schema);
  std::size_t choice(std::string_view key, std::span<const std::string> choices);
  JsonShape& object(std::string_view key);
  JsonShape& element(std::string_view key);  ///< shape of the elements of an array of objects
  void close() { closed_ = true; }           ///< no other keys are allowed

  Json schema() const;

 private:
  struct Property {
    std::vector<Json> types;
    std::unique_ptr<JsonShape> object;
    std::unique_ptr<JsonShape> element;
  };
  /// Keys requested in one run: all, those that must be present, and those that may be absent.
  struct RequestedKeys {
    Way way;
    std::set<std::string> keys;
    std::set<std::string> required;
    std::set<std::string> optional;
  };
  /// Keys requested in several runs.
  struct Keys {
    std::set<std::string> all;
    /// Keys requested in the runs with optional keys.
    std::set<std::string> present;
    std::set<std::string> required;  ///< keys that are required in at least one run
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

// JSON Schemas of numbers, whole numbers, arrays, intervals and nullable values.
Json schema_of(const NumberRule& rule);
Json schema_of(long min, long max);
Json array_schema(Json items);
Json interval_schema(const NumberRule& rule);
Json or_null(const Json& schema);

}  // namespace awmr
