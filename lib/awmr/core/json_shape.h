/// What a reader asks of a JSON object, as a JSON Schema. A JsonObject that describes, instead of
/// reading a document, notes here each key that the reader asks for, with what its value may be.
/// Private to this folder.
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

/// Which of a reader's ways is taken: whether optional keys are there, and which of its names a
/// choice has, by the choice's place; those without an entry have their first.
struct Way {
  bool present = true;
  std::map<std::string, std::size_t> picks = {};
};

/// A choice that was met, and the way on which it was.
struct MetChoice {
  std::size_t count = 0;  ///< names it has
  std::map<std::string, std::size_t> on = {};
};

/// What all objects of one description share.
struct Exploration {
  Way way = {};
  std::map<std::string, MetChoice> met = {};  ///< by place
};

class JsonShape {
 public:
  JsonShape(Exploration& exploration, std::string place);

  void begin();  ///< a new way; what was asked for on the last one is kept
  void asked(std::string_view key, bool required);
  bool has(std::string_view key);
  void type(std::string_view key, const Json& schema);
  std::size_t choice(std::string_view key, std::span<const std::string> choices);
  JsonShape& object(std::string_view key);
  JsonShape& element(std::string_view key);  ///< of an array of objects
  void close() { closed_ = true; }           ///< no other keys

  Json schema() const;

 private:
  struct Property {
    std::vector<Json> types;
    std::unique_ptr<JsonShape> object;
    std::unique_ptr<JsonShape> element;
  };
  /// What was asked for on one way.
  struct Asked {
    Way way;
    std::set<std::string> keys;
    std::set<std::string> required;
    std::set<std::string> optional;
  };
  /// What is asked for on several ways.
  struct Keys {
    std::set<std::string> all;
    std::set<std::string> present;   ///< where optional keys are there
    std::set<std::string> required;  ///< there, on one way or another
  };
  Property& property(std::string_view key);
  Asked& now();
  Json property_schema(const Property& property) const;
  Keys with_any_name(const std::string& key) const;
  Json names_of(const std::map<std::string, std::size_t>& picks) const;
  Json variant(const std::string& key, std::size_t pick, const Json& name) const;
  Json variant_without(const std::string& key) const;
  void add_variants(Json& schema) const;

  Exploration* exploration_;
  std::string place_;
  std::vector<std::pair<std::string, Property>> properties_;  ///< in the order they were asked for
  std::vector<Asked> ways_;
  bool fresh_ = true;
  bool closed_ = false;
};

// Schemas of what is no object.
Json schema_of(const NumberRule& rule);
Json schema_of(long min, long max);
Json array_schema(Json items);
Json interval_schema();
Json or_null(const Json& schema);

}  // namespace awmr
