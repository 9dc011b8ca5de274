#include "typed_command.hpp"

#include <fstream>

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

std::string made_by() {
  const evaluation::Origin here =
      evaluation::origin_of({.version = STILLPOINT_VERSION, .commit = built_from_commit()});
  return typed_command() + '\n' + origin_text(here) + '\n';
}

}  // namespace stillpoint
