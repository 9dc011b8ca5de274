// Tables that the program has written itself: commas, no quotes.
#pragma once

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/error.hpp"

namespace stillpoint::report {

class CsvReader {
 public:
  /// Throws Error(kData) when the first line is not `header`.
  CsvReader(const std::filesystem::path& file, std::string_view header)
      : name_(file.string()), columns_(count(header)) {
    std::error_code none;
    if (std::filesystem::is_regular_file(file, none)) stream_.open(file);  // no pipe
    if (!std::getline(stream_, line_) || line_ != header)
      fail("the columns are not '" + std::string(header) + "'");
  }

  /// False at the end of the file.
  bool next() {
    if (!std::getline(stream_, line_)) return false;
    ++number_;
    fields_.clear();
    for (std::string_view rest = line_;;) {
      const std::size_t comma = rest.find(',');
      fields_.push_back(rest.substr(0, comma));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    if (fields_.size() != columns_) fail("there are not as many fields as columns");
    return true;
  }

  std::string_view text(std::size_t column) const { return fields_[column]; }

  template <class Number>
  Number number(std::size_t column) const {
    Number value{};
    const std::string_view field = fields_[column];
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size())
      fail("'" + std::string(field) + "' is not a number");
    return value;
  }

 private:
  static std::size_t count(std::string_view header) {
    std::size_t columns = 1;
    for (const char c : header) columns += c == ',' ? 1 : 0;
    return columns;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Fault::kData, what, name_ + ":" + std::to_string(number_));
  }

  std::string name_;
  std::size_t columns_, number_ = 1;
  std::ifstream stream_;
  std::string line_;
  std::vector<std::string_view> fields_;
};

}  // namespace stillpoint::report
