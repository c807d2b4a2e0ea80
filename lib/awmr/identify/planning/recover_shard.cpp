#include "awmr/identify/planning/recover_shard.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "awmr/core/files/hash.h"
#include "awmr/core/files/shard_file.h"
#include "awmr/core/name_table.h"
#include "awmr/identify/planning/recover_table.h"

namespace awmr {
namespace {

/// Limits of the numbers that are accepted in a part's files: number of runs, magnitude of a true
/// value other than 0.
constexpr long kMaxRecoverRuns = std::numeric_limits<int>::max();
constexpr double kLargestTruth = 1e100;
constexpr double kSmallestTruth = 1e-100;

/// Hash (16 hexadecimal digits) of all bits of results of exp, log, pow and other functions on this
/// machine. Two machines give byte-identical results only if their hashes are equal, because the C
/// library has variants of these functions for different processors that round differently.
std::string rounding_of_functions() {
  std::string bits;
  const auto note = [&bits](double value) {
    bits += fmt::format("{:x} ", std::bit_cast<std::uint64_t>(value));
  };
  // Two variants of a function in the C library differ in the last bit for about one argument in a
  // thousand. So 4000 arguments suffice to detect a difference.
  constexpr int kArguments = 4000;
  for (int i = 1; i <= kArguments; ++i) {
    const double x = 0.00271828 * i;
    for (const double value : {std::exp(x), std::log(x), std::pow(x, 0.8841), std::sin(x),
                               std::cos(x), std::tan(x), std::atan(x)}) {
      note(value);
    }
  }
  constexpr std::size_t kDigits = 16;
  return sha256_hex(bits).substr(0, kDigits);
}

constexpr NameTable<ErrorKind, 3> kErrorKindNames{
    {{"input", ErrorKind::kInput}, {"refused", ErrorKind::kRefused}, {"fault", ErrorKind::kFault}}};

Json error_json(const Error& error) {
  Json json;
  json["kind"] = name_in(kErrorKindNames, error.kind);
  json["faults"] = Json::array();
  for (const Fault& fault : error.faults) {
    json["faults"].push_back({{"code", name_in(kErrorCodeNames, fault.code)},
                              {"place", fault.place},
                              {"message", fault.message}});
  }
  return json;
}

Fault read_fault_of_run(JsonObject& json) {
  return {json.choice("code", kErrorCodeNames), json.string("place"), json.string("message")};
}

Error read_error(JsonObject& json) {
  Error error{.kind = json.choice("kind", kErrorKindNames),
              .faults = json.objects("faults", read_fault_of_run)};
  if (error.faults.empty()) {
    json.fault(ErrorCode::kMissing, "faults", "is empty: each error needs a message");
  }
  return error;
}

std::optional<ParameterId> read_parameter(JsonObject& json, const std::string& key,
                                          const std::string& name) {
  const auto id = parameter_by_name(name);
  if (!id) {
    json.fault(ErrorCode::kUnknownName, key, fmt::format("no parameter is called '{}'", name));
  }
  return id;
}

std::vector<RecoverTruth> read_truths(JsonObject json) {
  std::vector<RecoverTruth> truths;
  for (const std::string& name : json.keys()) {
    const double value = json.number(name, {.min = -kLargestTruth, .max = kLargestTruth});
    if (value != 0.0 && std::abs(value) < kSmallestTruth) {
      json.fault(ErrorCode::kOutOfRange, name,
                 fmt::format("expected 0 or an absolute value of at least {:g}, found {:g}",
                             kSmallestTruth, value));
    }
    if (const auto id = read_parameter(json, name, name)) truths.push_back({*id, value});
  }
  return truths;
}

RecoverRefusal read_refusal(JsonObject& json) {
  return {.run = static_cast<int>(json.integer("run", 0, kMaxRecoverRuns)),
          .message = json.string("message")};
}

/// Reads the keys of shard.json that are specific to a recovery. The runs are in recovery.csv.
RecoverPart read_payload(JsonObject& json) {
  RecoverPart part;
  part.all_runs = static_cast<int>(json.integer("runs", 2, kMaxRecoverRuns));
  part.noise_text = json.string("noise");
  for (const std::string& name : json.strings("asked")) {
    if (const auto id = read_parameter(json, "asked", name)) part.requested.push_back(*id);
  }
  part.truths = read_truths(json.object("truths"));
  if (json.has("identified")) {
    for (const std::string& name : json.strings("identified")) {
      if (const auto id = read_parameter(json, "identified", name)) part.identified.push_back(*id);
    }
  }
  part.refusal = json.optional_object("refusal", read_refusal);
  part.error = json.optional_object("error", read_error);
  return part;
}

Status check_runs(std::string_view text, const std::string& file, const std::string& shard_json) {
  const RecoverPart part = payload_of(Json::parse(shard_json), read_payload);
  AWMR_RETURN_IF_ERROR(recover_runs(text, file, part.truths));
  return {};
}

/// Reads the runs of a part. Errors (input): a run that belongs to another part, is out of order or
/// is missing.
Result<std::vector<RecoverRun>> read_runs(const Part& part, const RecoverPart& payload) {
  const ShardKind& kind = recover_shards();
  const std::string table = (part.directory / kind.table).string();
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_table(kind, part));
  AWMR_ASSIGN_OR_RETURN(std::vector<RecoverRun> runs, recover_runs(text, table, payload.truths));
  const Shard& shard = part.origin.shard;
  const int expected = shard.share_of(payload.all_runs);
  if (std::ssize(runs) != expected) {
    return input_error(
        ErrorCode::kStaleResult, table,
        fmt::format(
            "has {} runs, but part {} of {} (of {} runs in all) needs {}; run the part again",
            runs.size(), shard.index, shard.count, payload.all_runs, expected));
  }
  AWMR_RETURN_IF_ERROR(check_items(kind, part, "run", payload.all_runs, runs.size(),
                                   [&](std::size_t i) { return runs[i].index; }));
  return runs;
}

/// Merges refusal and error of a part into `whole`. Keeps the refusal of the run with the smallest
/// index. Keeps the error only if all parts have one.
void take_reasons(const RecoverPart& part, RecoverPart& whole) {
  if (part.refusal && (!whole.refusal || part.refusal->run < whole.refusal->run)) {
    whole.refusal = part.refusal;
  }
  if (!part.error) whole.error.reset();
}

}  // namespace

const ShardKind& recover_shards() {
  static const ShardKind kind{
      .schema = "awmr.recover_shard/1",
      .title = "A part of a recovery",
      .table = "recovery.csv",
      .check = check_runs,
      .own_keys = {"refusal", "error"},
      .arithmetic_advice = "run all parts on processors of one kind, with the same C library",
      .read = [](JsonObject& json) { read_payload(json); }};
  return kind;
}

PartText recover_part_text(const RecoverPart& part, const Shard& shard,
                           const Provenance& provenance) {
  Json json{{"runs", part.all_runs},
            {"noise", part.noise_text},
            {"asked", Json::array()},
            {"truths", Json::object()}};
  for (const ParameterId id : part.requested) json["asked"].push_back(info(id).name);
  for (const RecoverTruth& truth : part.truths) {
    json["truths"][std::string(info(truth.id).name)] = truth.value;
  }
  if (!part.identified.empty()) json["identified"] = Json::array();
  for (const ParameterId id : part.identified) json["identified"].push_back(info(id).name);
  if (part.refusal) {
    json["refusal"] = {{"run", part.refusal->run}, {"message", part.refusal->message}};
  }
  if (part.error) json["error"] = error_json(*part.error);
  return part_text(
      recover_shards(),
      {.provenance = provenance, .shard = shard, .arithmetic = rounding_of_functions()},
      recover_csv(part), json);
}

Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<Part> parts, read_parts(recover_shards(), directories));
  MergedRecovery merged{.whole = payload_of(parts.front().json, read_payload),
                        .provenance = parts.front().origin.provenance};
  std::vector<std::vector<RecoverRun>> runs;
  for (const Part& part : parts) {
    const RecoverPart payload = payload_of(part.json, read_payload);
    AWMR_ASSIGN_OR_RETURN(std::vector<RecoverRun> of_part, read_runs(part, payload));
    runs.push_back(std::move(of_part));
    take_reasons(payload, merged.whole);
  }
  AWMR_ASSIGN_OR_RETURN(merged.whole.runs, in_order_of_items(runs, merged.whole.all_runs));
  return merged;
}

}  // namespace awmr
