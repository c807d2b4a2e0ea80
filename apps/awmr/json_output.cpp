#include "json_output.h"

#include <algorithm>
#include <string_view>

#include "awmr/core/json/json.h"
#include "awmr/core/option_text.h"
#include "awmr/core/provenance.h"
#include "awmr/core/text.h"
#include "awmr/model/findings_json.h"

namespace awmr::cli {

std::string result_text(const JsonResult& result) {
  Json json;
  json["schema"] = kResultSchema;
  json["command"] = result.command;
  json["version"] = version();
  json["exit_code"] = result.exit_code;
  json["written"] = Json::array();
  for (const std::filesystem::path& path : result.written) json["written"].push_back(path.string());
  json["findings"] = findings_to_json(result.findings);
  json["result"] = result.document.empty() ? Json(nullptr) : Json::parse(result.document);
  return awmr::to_text(json);
}

std::string error_text(const Error& error) {
  Json json;
  json["schema"] = kErrorSchema;
  json["version"] = version();
  json["exit_code"] = exit_code(error);
  json["errors"] = Json::array();
  const auto plain = [](const std::string& text) { return printable(spell_options(text, "--")); };
  for (const Fault& fault : shown_faults(error.faults)) {
    json["errors"].push_back({{"code", name_in(kErrorCodeNames, fault.code)},
                              {"place", plain(fault.place)},
                              {"message", plain(fault.message)}});
  }
  return awmr::to_text(json);
}

std::string result_schema() {
  return json_schema_text(kResultSchema, "Output of a command with --json", [](JsonObject& json) {
    json.schema(kResultSchema);
    json.string("command");
    json.string("version");
    json.integer("exit_code", 0, 1);
    json.strings("written");
    describe_findings(json);
    json.ignore("result");
    json.reject_unknown_keys();
  });
}

std::string error_schema() {
  return json_schema_text(kErrorSchema, "Output of a failed command with --json",
                          [](JsonObject& json) {
                            json.schema(kErrorSchema);
                            json.string("version");
                            json.integer("exit_code", 1, 3);
                            json.objects("errors", [](JsonObject& fault) {
                              fault.choice("code", kErrorCodeNames);
                              fault.string("place");
                              fault.string("message");
                            });
                            json.reject_unknown_keys();
                          });
}

std::string joined(const std::vector<std::pair<std::string, std::string>>& documents) {
  Json json = Json::object();
  for (const auto& [name, text] : documents) {
    if (!text.empty()) json[name] = Json::parse(text);
  }
  return awmr::to_text(json);
}

bool requests_json(int argc, char** argv) {
  return std::any_of(argv + std::min(argc, 1), argv + argc,
                     [](const char* word) { return std::string_view(word) == "--json"; });
}

}  // namespace awmr::cli
