// A SQLite file that others wrote, read only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bag/byte_reader.hpp"

struct sqlite3;
struct sqlite3_blob;
struct sqlite3_stmt;

namespace stillpoint::bag {

/// No SQL of the file itself is run. One per thread.
class SqliteReader {
 public:
  /// Throws Error(kData) when it cannot be opened.
  explicit SqliteReader(const std::filesystem::path& file);

  class Row {
   public:
    std::int64_t integer(int column) const;
    std::string text(int column) const;

   private:
    friend class SqliteReader;
    explicit Row(sqlite3_stmt* statement) : statement_(statement) {}
    sqlite3_stmt* statement_;
  };

  /// Calls `use` with each row until it returns false. Returns what went wrong, or nothing.
  std::string for_each(const std::string& query, const std::function<bool(const Row&)>& use);

  /// The first `at_most` bytes of a blob; valid until the next call. Throws Error(kData).
  ByteSpan blob(const char* table, const char* column, std::int64_t row, std::size_t at_most);

 private:
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
  std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace stillpoint::bag
