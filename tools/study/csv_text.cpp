#include "study/csv_text.hpp"

#include <array>
#include <charconv>

namespace stillpoint::study {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_number(const std::optional<double>& value) {
  if (!value) return {};
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), *value, std::chars_format::general, 9);
  return {text.data(), end.ptr};
}

}  // namespace stillpoint::study
