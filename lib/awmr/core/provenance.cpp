#include "awmr/core/provenance.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/json/json.h"
#include "awmr/core/version_number.h"

namespace awmr {

const char* version() { return AWMR_VERSION; }

void put_provenance(Json& json, const Provenance& provenance) {
  json["command"] = provenance.command;
  json["version"] = version();
  Json options = Json::object();
  for (const auto& [name, value] : provenance.options) {
    if (!options.contains(name)) {
      options[name] = value;
    } else {  // an option that was given more than once: its values are joined
      options[name] = options[name].get<std::string>() + ", " + value;
    }
  }
  json["options"] = options;
  json["inputs"] = Json::array();
  for (const InputFile& input : provenance.inputs) {
    json["inputs"].push_back({{"name", input.name}, {"sha256", input.sha256}});
  }
}

Json output_document(std::string_view schema, const Provenance& provenance) {
  Json json;
  json["schema"] = schema;
  put_provenance(json, provenance);
  return json;
}

Provenance read_provenance(JsonObject& json) {
  Provenance provenance;
  provenance.command = json.optional_string("command").value_or("");
  json.ignore("version");
  if (auto options = json.optional_object("options")) {
    for (const std::string& name : options->keys()) {
      provenance.options.emplace_back(name, options->string(name));
    }
  }
  for (JsonObject& input : json.optional_objects("inputs")) {
    provenance.inputs.push_back({input.string("name"), input.string("sha256")});
    input.reject_unknown_keys();
  }
  return provenance;
}

std::optional<bool> is_made_from(const Json& document, std::string_view sha256) {
  const auto inputs = document.find("inputs");
  if (inputs == document.end() || !inputs->is_array() || inputs->empty()) return std::nullopt;
  return std::ranges::any_of(*inputs, [&](const Json& input) {
    return input.is_object() && input.value("sha256", Json()) == sha256;
  });
}

}  // namespace awmr
