#include "awmr/identify/planning/recover_shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "awmr/core/hash.h"
#include "awmr/core/index.h"
#include "awmr/core/json_document.h"
#include "awmr/core/name_table.h"
#include "awmr/core/rounding.h"
#include "awmr/core/shard_file.h"
#include "awmr/identify/planning/recover_table.h"

namespace awmr {
namespace {

/// Runs of a recovery at the most, and how far from 1 a true value may lie.
constexpr long kMostRecoverRuns = std::numeric_limits<int>::max();
constexpr double kLargestTruth = 1e100;
constexpr double kSmallestTruth = 1e-100;

constexpr NameTable<ErrorKind, 3> kErrorKindNames{
    {{"input", ErrorKind::kInput}, {"refused", ErrorKind::kRefused}, {"fault", ErrorKind::kFault}}};

/// One directory's part; its runs lie in the table.
struct RecoverShardFile {
  ShardOrigin origin;
  RecoverPart part;
};

Json error_json(const Error& error) {
  Json json;
  json["kind"] = name_in(kErrorKindNames, error.kind);
  json["faults"] = Json::array();
  for (const Fault& fault : error.faults) {
    json["faults"].push_back({{"place", fault.place}, {"message", fault.message}});
  }
  return json;
}

Error read_error(JsonObject json) {
  Error error{.kind = json.choice("kind", kErrorKindNames), .faults = {}};
  for (JsonObject& fault : json.objects("faults")) {
    error.faults.push_back({fault.string("place"), fault.string("message")});
    fault.reject_unknown_keys();
  }
  if (error.faults.empty()) json.fault("faults", "is empty: an error names what is wrong");
  json.reject_unknown_keys();
  return error;
}

/// None, with a fault, where no parameter has this name.
std::optional<ParameterId> read_parameter(JsonObject& json, const std::string& key,
                                          const std::string& name) {
  const auto id = parameter_by_name(name);
  if (!id) json.fault(key, fmt::format("no parameter is called '{}'", name));
  return id;
}

std::vector<RecoverTruth> read_truths(JsonObject json) {
  std::vector<RecoverTruth> truths;
  for (const std::string& name : json.keys()) {
    const double value = json.number(name, {.min = -kLargestTruth, .max = kLargestTruth});
    if (value != 0.0 && std::abs(value) < kSmallestTruth) {
      json.fault(name, fmt::format("expected 0 or a number not below {:g} in size, found {:g}",
                                   kSmallestTruth, value));
    }
    if (const auto id = read_parameter(json, name, name)) truths.push_back({*id, value});
  }
  return truths;
}

RecoverRefusal read_refusal(JsonObject json) {
  RecoverRefusal refusal{.run = static_cast<int>(json.integer("run", 0, kMostRecoverRuns)),
                         .message = json.string("message")};
  json.reject_unknown_keys();
  return refusal;
}

RecoverShardFile shard_file_from_json(JsonObject& json) {
  RecoverShardFile file{.origin = read_shard_origin(json, kRecoverShardSchema), .part = {}};
  RecoverPart& part = file.part;
  part.all_runs = static_cast<int>(json.integer("runs", 2, kMostRecoverRuns));
  part.noise_text = json.string("noise");
  for (const std::string& name : json.strings("asked")) {
    if (const auto id = read_parameter(json, "asked", name)) part.requested.push_back(*id);
  }
  part.truths = read_truths(json.object("truths"));
  if (auto refusal = json.optional_object("refusal")) part.refusal = read_refusal(*refusal);
  if (auto error = json.optional_object("error")) part.error = read_error(*error);
  json.reject_unknown_keys();
  return file;
}

/// Why a part is not of the same recovery as the first; empty where it is.
std::string other_recovery(const RecoverShardFile& first, const RecoverShardFile& file) {
  const RecoverPart& a = first.part;
  const RecoverPart& b = file.part;
  if (a.all_runs != b.all_runs || a.noise_text != b.noise_text || a.requested != b.requested ||
      a.truths != b.truths) {
    return made_with_other_options(first.origin);
  }
  return other_arithmetic(first.origin, file.origin,
                          "run all parts on processors of one kind, with the same C library");
}

/// The part's own runs, each once. Errors (input): a run that is not one of them, or appears
/// twice; one that is missing.
Status check_runs(const std::vector<RecoverRun>& runs, const RecoverShardFile& file) {
  const std::string place = (file.origin.directory / kRecoverTable).string();
  const Shard& shard = file.origin.shard;
  int before = -1;
  for (const RecoverRun& run : runs) {
    if (!shard.has(run.index) || run.index >= file.part.all_runs) {
      return input_error(place, fmt::format("run {} is none of part {} of {}", run.index,
                                            shard.index, shard.count));
    }
    if (run.index <= before) {
      return input_error(place, fmt::format("run {} comes after run {}", run.index, before));
    }
    before = run.index;
  }
  const int expected = shard.share_of(file.part.all_runs);
  if (std::ssize(runs) != expected) {
    return input_error(
        place, fmt::format("has {} runs, part {} of {} of {} runs has {}: run it "
                           "again",
                           runs.size(), shard.index, shard.count, file.part.all_runs, expected));
  }
  return {};
}

Result<std::vector<RecoverRun>> read_runs(const RecoverShardFile& file) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_shard_table(file.origin, kRecoverTable));
  const std::string place = (file.origin.directory / kRecoverTable).string();
  AWMR_ASSIGN_OR_RETURN(std::vector<RecoverRun> runs, recover_runs(text, place, file.part.truths));
  AWMR_RETURN_IF_ERROR(check_runs(runs, file));
  return runs;
}

/// Report of the parts in addition to their runs: the refusal of the smallest run; an error where
/// all have one, that of the first part, which has the first run.
void take_words(const std::vector<RecoverShardFile>& files, RecoverPart& whole) {
  whole.refusal.reset();
  whole.error.reset();
  for (const RecoverShardFile& file : files) {
    const auto& refusal = file.part.refusal;
    if (refusal && (!whole.refusal || refusal->run < whole.refusal->run)) whole.refusal = refusal;
  }
  const auto fails = [](const RecoverShardFile& file) { return file.part.error.has_value(); };
  if (std::ranges::all_of(files, fails)) whole.error = files.front().part.error;
}

}  // namespace

std::string recover_shard_text(const RecoverPart& part, const Shard& shard,
                               const Provenance& provenance) {
  Json json = shard_document(kRecoverShardSchema, {.provenance = provenance,
                                                   .shard = shard,
                                                   .arithmetic = rounding_of_functions(),
                                                   .csv_sha256 = sha256_hex(recover_csv(part))});
  json["runs"] = part.all_runs;
  json["noise"] = part.noise_text;
  json["asked"] = Json::array();
  for (const ParameterId id : part.requested) json["asked"].push_back(info(id).name);
  json["truths"] = Json::object();
  for (const RecoverTruth& truth : part.truths) {
    json["truths"][std::string(info(truth.id).name)] = truth.value;
  }
  if (part.refusal) {
    json["refusal"] = {{"run", part.refusal->run}, {"message", part.refusal->message}};
  }
  if (part.error) json["error"] = error_json(*part.error);
  return to_text(json);
}

bool is_finished_recover_shard(const std::filesystem::path& directory, const Shard& shard,
                               const Provenance& provenance) {
  return is_finished_part(
      directory, kRecoverShardSchema,
      {.provenance = provenance, .shard = shard, .arithmetic = rounding_of_functions()},
      kRecoverTable);
}

Status check_recover_csv(std::string_view text, const std::string& file, const RecoverPart& part) {
  AWMR_RETURN_IF_ERROR(recover_runs(text, file, part.truths));
  return {};
}

Status check_recover_shard_text(std::string_view text, const std::string& file) {
  return check_json_object(text, file, shard_file_from_json);
}

std::string recover_shard_schema() {
  return json_schema_text(kRecoverShardSchema, "A part of a recovery",
                          [](JsonObject& json) { shard_file_from_json(json); });
}

Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(
      const std::vector<RecoverShardFile> files,
      read_parts(directories, kRecoverShardSchema, shard_file_from_json, other_recovery));
  MergedRecovery merged{.whole = files.front().part, .provenance = files.front().origin.provenance};
  std::vector<RecoverRun>& all = merged.whole.runs;
  for (const RecoverShardFile& file : files) {
    AWMR_ASSIGN_OR_RETURN(std::vector<RecoverRun> runs, read_runs(file));
    all.insert(all.end(), std::make_move_iterator(runs.begin()),
               std::make_move_iterator(runs.end()));
  }
  std::ranges::sort(all, {}, &RecoverRun::index);
  take_words(files, merged.whole);
  return merged;
}

}  // namespace awmr
