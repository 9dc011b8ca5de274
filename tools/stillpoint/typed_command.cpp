#include "typed_command.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "commit.hpp"
#include "evaluation/origin.hpp"
#include "shell_word.hpp"

namespace stillpoint {

std::string typed_command() {
  std::ifstream words("/proc/self/cmdline", std::ios::binary);
  std::string command = "stillpoint", word;
  std::getline(words, word, '\0');  // the path of the program, which others do not have
  while (std::getline(words, word, '\0')) command += ' ' + shell_word(word);
  return command;
}

evaluation::Origin origin_here() {
  return evaluation::origin_of({.version = STILLPOINT_VERSION, .commit = built_from_commit()});
}

std::string made_by() { return typed_command() + '\n' + origin_text(origin_here()) + '\n'; }

nlohmann::ordered_json made_by_json() {
  const evaluation::Origin here = origin_here();
  return {{"command", typed_command()},
          {"version", here.version},
          {"commit", here.commit},
          {"machine", here.machine},
          {"date", here.date}};
}

}  // namespace stillpoint
