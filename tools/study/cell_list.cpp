#include "study/cell_list.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "stillpoint/error.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

using Json = nlohmann::ordered_json;

ListedCell parse_cell(const std::string& line, const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(line);
    return {.cell = {.cell = {},
                     .command = json.at("command"),
                     .run = json.at("run").get<std::string>(),
                     .recording = json.at("recording").get<std::string>(),
                     .fingerprint = json.at("fingerprint"),
                     .time_limit = json.at("time_limit")},
            .program = json.at("program")};
  } catch (const Json::exception& error) {
    throw Error(Fault::kData, std::string("is no list of cells: ") + error.what(), file.string());
  }
}

std::ifstream open_list(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream)
    throw Error(Fault::kData, "cannot be read", file.string(),
                "the folder of the study must be the same on every machine of the cluster");
  return stream;
}

}  // namespace

void write_cells(const std::filesystem::path& file, const std::vector<ListedCell>& cells) {
  std::string text;
  for (const auto& [cell, program] : cells) {
    const Json json = {{"command", cell.command},
                       {"run", cell.run.string()},
                       {"recording", cell.recording.string()},
                       {"fingerprint", cell.fingerprint},
                       {"time_limit", cell.time_limit},
                       {"program", program}};
    text += json.dump() + "\n";
  }
  write_text(file, text);
}

std::vector<ListedCell> read_cells(const std::filesystem::path& file) {
  std::ifstream stream = open_list(file);
  std::vector<ListedCell> cells;
  for (std::string line; std::getline(stream, line);) cells.push_back(parse_cell(line, file));
  return cells;
}

ListedCell read_cell(const std::filesystem::path& file, std::size_t line) {
  std::ifstream stream = open_list(file);
  std::string text;
  for (std::size_t i = 0; i <= line; ++i)
    if (!std::getline(stream, text))
      throw Error(Fault::kData, "has no cell " + std::to_string(line), file.string());
  return parse_cell(text, file);
}

}  // namespace stillpoint::study
