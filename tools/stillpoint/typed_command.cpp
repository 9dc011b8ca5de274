#include "typed_command.hpp"

#include <fstream>

#include "shell_word.hpp"

namespace stillpoint {

std::string typed_command() {
  std::ifstream words("/proc/self/cmdline", std::ios::binary);
  std::string command = "stillpoint", word;
  std::getline(words, word, '\0');  // the path of the program, which others do not have
  while (std::getline(words, word, '\0')) command += ' ' + shell_word(word);
  return command;
}

}  // namespace stillpoint
