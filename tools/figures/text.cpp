#include "figures/text.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace stillpoint::figures {
namespace {

std::string as_xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string valid_text(const std::string& text) {
  using Json = nlohmann::json;
  // Its writer replaces what is no UTF-8.
  auto valid = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace))
                   .get<std::string>();
  constexpr unsigned char kDelete = 0x7F;
  std::ranges::replace_if(
      valid, [](unsigned char c) { return c < ' ' || c == kDelete; }, ' ');
  return valid;
}

void remove_last_letter(std::string& text) {
  const auto continues = [](char c) { return (c & 0xC0) == 0x80; };
  while (continues(text.back())) text.pop_back();
  text.pop_back();
}

std::string with_title(const std::string& svg, const std::string& title) {
  const std::string page = "<g id=\"surface";
  const std::size_t first_tag = svg.find("<svg"), tag_end = svg.find(">\n", first_tag) + 1;
  const std::size_t number = svg.find(page) + page.size(), number_end = svg.find('"', number);
  return svg.substr(0, tag_end) + "\n<title>" + as_xml(title) + "</title>" +
         svg.substr(tag_end, number - tag_end) + svg.substr(number_end);
}

}  // namespace stillpoint::figures
