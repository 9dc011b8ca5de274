#include "stillpoint/runtime/sqlite_file.hpp"

#include <sqlite3.h>

#include <cctype>
#include <string_view>
#include <utility>

namespace stillpoint {
namespace {

// As a URI for which SQLite neither reads nor makes other files beside it: no journal, no log.
std::string immutable(const std::filesystem::path& file) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : file.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '/' || c == '.' || c == '-' || c == '_')
      uri += c;
    else
      uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
  }
  return uri + "?immutable=1";
}

}  // namespace

SqliteStatement::SqliteStatement(sqlite3_stmt* statement)
    : statement_(statement, &sqlite3_finalize) {}

void SqliteStatement::check(int code) const {
  if (code != SQLITE_OK) throw SqliteFault(sqlite3_errmsg(sqlite3_db_handle(statement_.get())));
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(double value) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(const std::string& text) {
  check(sqlite3_bind_text(statement_.get(), ++bound_, text.c_str(), static_cast<int>(text.size()),
                          SQLITE_TRANSIENT));
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::span<const std::byte> bytes) {
  check(sqlite3_bind_blob64(statement_.get(), ++bound_, bytes.data(), bytes.size(),
                            SQLITE_TRANSIENT));
  return *this;
}

void SqliteStatement::run() {
  step();
  check(sqlite3_reset(statement_.get()));
  bound_ = 0;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  throw SqliteFault(sqlite3_errmsg(sqlite3_db_handle(statement_.get())));
}

int SqliteStatement::columns() const { return sqlite3_column_count(statement_.get()); }

bool SqliteStatement::is_number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  return type == SQLITE_INTEGER || type == SQLITE_FLOAT;
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string SqliteStatement::text(int column) const {
  const auto* text = sqlite3_column_text(statement_.get(), column);
  return text ? reinterpret_cast<const char*>(text) : "";
}

std::span<const std::byte> SqliteStatement::bytes(int column) const {
  const auto* first = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
  return {first, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

SqliteFile::SqliteFile(const std::filesystem::path& file, Mode mode)
    : database_(nullptr, &sqlite3_close) {
  sqlite3* opened = nullptr;
  int code = SQLITE_OK;
  if (mode == Mode::kRead) {
    code = sqlite3_open_v2(immutable(std::filesystem::absolute(file)).c_str(), &opened,
                           SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  } else {
    std::filesystem::remove(file);
    code =
        sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  }
  database_.reset(opened);
  if (code != SQLITE_OK) throw SqliteFault(sqlite3_errmsg(opened));
  // No SQL of the file itself is run.
  for (const auto& [setting, on] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                    {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                    {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                                    {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}})
    sqlite3_db_config(opened, setting, on, nullptr);
}

void SqliteFile::execute(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    throw SqliteFault(sqlite3_errmsg(database_.get()));
}

SqliteStatement SqliteFile::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    throw SqliteFault(sqlite3_errmsg(database_.get()));
  return SqliteStatement(statement);
}

void SqliteFile::close() {
  sqlite3* database = database_.get();
  if (sqlite3_close(database) != SQLITE_OK) throw SqliteFault(sqlite3_errmsg(database));
  static_cast<void>(database_.release());
}

}  // namespace stillpoint
