#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "awmr/core/text.h"
#include "log_formats.h"
#include "ros_message.h"

namespace awmr {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

tl::unexpected<Error> wrong(const std::string& file, std::string_view what) {
  return input_error(ErrorCode::kBrokenFile, file,
                     fmt::format("this is not a readable bag of ROS 2: {}", what));
}

/// Opens the bytes as a database in memory, so that SQL in the bag cannot access any file.
Result<Database> open(std::string_view bytes, const std::string& file) {
  sqlite3* handle = nullptr;
  const int opened = sqlite3_open(":memory:", &handle);
  Database database(handle);
  if (opened != SQLITE_OK) return program_fault("SQLite does not open a database in memory");
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(bytes.size()));
  if (copy == nullptr) return program_fault("no memory for the bag");
  std::copy(bytes.begin(), bytes.end(), copy);
  // Bytes 18 and 19 of an SQLite file give the journal mode. The value 2 means a write-ahead log,
  // which a database in memory does not support; 1 means a rollback journal.
  if (bytes.size() > 19 && copy[18] == 2 && copy[19] == 2) copy[18] = copy[19] = 1;
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  // SQLite frees `copy`, even if sqlite3_deserialize() fails.
  if (sqlite3_deserialize(handle, "main", copy, size, size,
                          SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_READONLY) !=
      SQLITE_OK) {
    return wrong(file, sqlite3_errmsg(handle));
  }
  return database;
}

/// Calls `take(statement)` for every row.
template <class Take>
Status for_each_row(sqlite3* database, const std::string& sql, const std::string& file,
                    const Take& take) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &handle, nullptr) != SQLITE_OK) {
    return wrong(file, sqlite3_errmsg(database));
  }
  const Statement statement(handle);
  int step = sqlite3_step(handle);
  for (; step == SQLITE_ROW; step = sqlite3_step(handle)) AWMR_RETURN_IF_ERROR(take(handle));
  if (step != SQLITE_DONE) return wrong(file, sqlite3_errmsg(database));
  return {};
}

std::string text_in(sqlite3_stmt* statement, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
  return text == nullptr ? std::string() : std::string(text, size);
}

struct BagTopic {
  std::int64_t id = 0;
  std::string name;
  std::string type;
  std::string format;
};

Result<std::vector<BagTopic>> topics_of(sqlite3* database, const std::string& file) {
  constexpr std::size_t kMaxTopics = 10'000;
  std::vector<BagTopic> topics;
  AWMR_RETURN_IF_ERROR(
      for_each_row(database, "SELECT id, name, type, serialization_format FROM topics ORDER BY id",
                   file, [&](sqlite3_stmt* row) -> Status {
                     if (topics.size() == kMaxTopics)
                       return wrong(file, "it has more than 10000 topics");
                     topics.push_back({sqlite3_column_int64(row, 0), text_in(row, 1),
                                       text_in(row, 2), text_in(row, 3)});
                     if (topics.back().name.starts_with('/')) topics.back().name.erase(0, 1);
                     return {};
                   }));
  return topics;
}

/// Adds a topic and the names of its signals. Returns which numbers of its messages are requested,
/// as indices into `fields`.
std::vector<std::size_t> list(const BagTopic& bag, const std::vector<std::string>& fields,
                              const Wanted& wanted, Signals& signals) {
  signals.topics.push_back({.name = bag.name});
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (add_signal(bag.name + "." + fields[i], wanted, signals)) numbers.push_back(i);
  }
  return numbers;
}

Status read_messages(sqlite3* database, const BagTopic& bag,
                     const std::vector<std::size_t>& numbers, const std::string& file,
                     Topic& topic) {
  const std::string sql = fmt::format(
      "SELECT timestamp, data FROM messages WHERE topic_id = {} ORDER BY timestamp", bag.id);
  return for_each_row(database, sql, file, [&](sqlite3_stmt* row) -> Status {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(row, 1));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 1));
    const auto values = ros_values(bag.type, data == nullptr ? "" : std::string_view(data, size));
    if (!values) {
      return input_error(ErrorCode::kBrokenFile, file,
                         fmt::format("message {} of /{}: its {} bytes are not a {} in CDR",
                                     topic.time_ns.size() + 1, printable(shortened(bag.name, 100)),
                                     size, printable(shortened(bag.type, 100))));
    }
    topic.time_ns.push_back(sqlite3_column_int64(row, 0));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      topic.values[i].push_back((*values)[numbers[i]]);
    }
    return {};
  });
}

}  // namespace

bool is_rosbag(std::string_view bytes) {
  return bytes.starts_with(std::string_view("SQLite format 3\0", 16));
}

Result<Signals> read_rosbag(std::string_view bytes, const std::string& file, const Wanted& wanted) {
  AWMR_ASSIGN_OR_RETURN(const Database database, open(bytes, file));
  AWMR_ASSIGN_OR_RETURN(const std::vector<BagTopic> topics, topics_of(database.get(), file));
  Signals signals;
  std::string unread;
  for (const BagTopic& bag : topics) {
    const auto fields = ros_fields(bag.type);
    if (!fields || bag.format != "cdr") {
      unread += fmt::format("{}/{} ({})", unread.empty() ? "" : ", ", bag.name, bag.type);
      continue;
    }
    const std::vector<std::size_t> numbers = list(bag, *fields, wanted, signals);
    if (numbers.empty()) continue;
    AWMR_RETURN_IF_ERROR(read_messages(database.get(), bag, numbers, file, signals.topics.back()));
  }
  if (!unread.empty()) {
    signals.notes.push_back({0, "topics-unread",
                             "these topics are not read, because their types are not supported or "
                             "their messages are not in CDR: " +
                                 printable(shortened(unread, 500))});
  }
  signals.notes.push_back({0, "bag-time", "t_s is the time at which the bag received a message"});
  return signals;
}

}  // namespace awmr
