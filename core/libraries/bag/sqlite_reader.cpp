#include "bag/sqlite_reader.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace stillpoint::bag {
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;

/// With the characters that mean something in a URI escaped.
std::string uri_of(const std::filesystem::path& file, const char* parameters) {
  std::string uri = "file:";
  for (const char letter : file.string()) {
    if (letter == '%' || letter == '?' || letter == '#') {
      constexpr char kDigits[] = "0123456789abcdef";
      uri += {'%', kDigits[letter >> 4], kDigits[letter & 15]};
    } else {
      uri += letter;
    }
  }
  return uri + parameters;
}

/// Whether something can be read of it, with `parameters` of SQLite's URIs.
Database opened(const std::filesystem::path& file, const char* parameters) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(uri_of(file, parameters).c_str(), &handle,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database(handle, &sqlite3_close);
  if (code != SQLITE_OK) return {nullptr, &sqlite3_close};
  for (const auto& [setting, on] : {std::pair{SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                    {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                                    {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                    // Files that are shorter than they say are opened, too.
                                    {SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1}})
    sqlite3_db_config(handle, setting, on, nullptr);
  if (sqlite3_exec(handle, "SELECT 1 FROM sqlite_master", nullptr, nullptr, nullptr) != SQLITE_OK)
    return {nullptr, &sqlite3_close};
  return database;
}

}  // namespace

SqliteReader::SqliteReader(const std::filesystem::path& file)
    : file_(file), database_(opened(file, "")), blob_(nullptr, &sqlite3_blob_close) {
  // A recorder that was interrupted leaves a write-ahead log, which needs a folder that can be
  // written; without one it is left out.
  if (!database_) database_ = opened(file, "?immutable=1");
  if (!database_) throw Error(Fault::kData, "is damaged, or no SQLite database", file.string());
}

std::int64_t SqliteReader::Row::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string SqliteReader::Row::text(int column) const {
  const auto* letters = sqlite3_column_text(statement_, column);
  return letters ? reinterpret_cast<const char*>(letters) : "";
}

std::string SqliteReader::for_each(const std::string& query,
                                   const std::function<bool(const Row&)>& use) {
  sqlite3_stmt* prepared = nullptr;
  const int made = sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &prepared, nullptr);
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(prepared,
                                                                        &sqlite3_finalize);
  if (made != SQLITE_OK) return sqlite3_errmsg(database_.get());
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(prepared)) == SQLITE_ROW)
    if (!use(Row(prepared))) return {};
  return code == SQLITE_DONE ? "" : sqlite3_errmsg(database_.get());
}

ByteSpan SqliteReader::blob(const char* table, const char* column, std::int64_t row,
                            std::size_t at_most) {
  const auto check = [&](int code) {
    if (code != SQLITE_OK)
      throw Error(Fault::kData,
                  "row " + std::to_string(row) + ": " + sqlite3_errmsg(database_.get()),
                  file_.string());
  };
  if (!blob_ || sqlite3_blob_reopen(blob_.get(), row) != SQLITE_OK) {
    sqlite3_blob* handle = nullptr;
    blob_.reset();
    const int code = sqlite3_blob_open(database_.get(), "main", table, column, row, 0, &handle);
    blob_.reset(handle);
    check(code);
  }
  const auto size = static_cast<std::size_t>(sqlite3_blob_bytes(blob_.get()));
  bytes_.resize(std::min(size, at_most));
  check(sqlite3_blob_read(blob_.get(), bytes_.data(), static_cast<int>(bytes_.size()), 0));
  return bytes_;
}

}  // namespace stillpoint::bag
