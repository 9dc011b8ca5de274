#include "study/cell_result.hpp"

#include <nlohmann/json.hpp>

#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFile = "result.json";

}  // namespace

void write_result(const std::filesystem::path& run, const CellResult& result) {
  Json values = Json::object();
  for (std::size_t i = 0; i < kMetricCount; ++i)
    if (result.values[i]) values[metrics()[i].key] = *result.values[i];
  const Origin& origin = result.origin;
  const Json json = {{"fingerprint", result.fingerprint}, {"program", result.program},
                     {"version", origin.version},         {"commit", origin.commit},
                     {"machine", origin.machine},         {"date", origin.date},
                     {"exit_code", result.exit_code},     {"message", result.message},
                     {"seconds", result.seconds},         {"values", values}};
  // A message may hold what another program has written.
  write_text(run / kFile, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<CellResult> read_result(const std::filesystem::path& run) {
  try {
    const Json json = Json::parse(read_text(run / kFile));
    CellResult result{.fingerprint = json.at("fingerprint"),
                      .program = json.at("program"),
                      .origin = {.version = json.value("version", ""),
                                 .commit = json.value("commit", ""),
                                 .machine = json.value("machine", ""),
                                 .date = json.value("date", "")},
                      .exit_code = json.at("exit_code"),
                      .message = json.at("message"),
                      .seconds = json.at("seconds")};
    const Json& values = json.at("values");
    for (std::size_t i = 0; i < kMetricCount; ++i)
      if (const char* key = metrics()[i].key; values.contains(key))
        result.values[i] = values.at(key).get<double>();
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

bool has_foreign_result(const std::filesystem::path& run) {
  return Json::parse(read_text(run / kFile), nullptr, false).is_object() && !read_result(run);
}

}  // namespace stillpoint::study
