// A thin wrapper around SQLite: every failure is an exception, nothing is left open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace stillpoint {

/// What SQLite says went wrong.
class SqliteFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class SqliteStatement {
 public:
  /// Values are bound in order, from the first on.
  SqliteStatement& bind(std::int64_t value);
  SqliteStatement& bind(double value);
  SqliteStatement& bind(const std::string& text);
  SqliteStatement& bind(std::span<const std::byte> bytes);

  /// Runs it and makes it ready for the next values.
  void run();
  /// The next row; false after the last.
  bool step();
  int columns() const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  /// A blob, or a text. Valid until the next step.
  std::span<const std::byte> bytes(int column) const;
  bool is_number(int column) const;

 private:
  friend class SqliteFile;
  explicit SqliteStatement(sqlite3_stmt* statement);
  void check(int code) const;

  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
  int bound_ = 0;
};

/// Functions throw SqliteFault.
class SqliteFile {
 public:
  enum class Mode { kRead, kCreate };

  /// kRead neither reads nor makes other files beside this one, such as journals. kCreate replaces
  /// what is there.
  SqliteFile(const std::filesystem::path& file, Mode mode);

  void execute(const std::string& sql);
  SqliteStatement prepare(const std::string& sql);
  /// Reports what could not be written until now.
  void close();

 private:
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

}  // namespace stillpoint
