// JSON as it goes into messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace stillpoint::output_web {

/// In one line; bytes that are no UTF-8 are replaced.
inline std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace stillpoint::output_web
