// Text that a shell takes as one word.
#pragma once

#include <string>

namespace stillpoint {

std::string shell_word(const std::string& text);

}  // namespace stillpoint
