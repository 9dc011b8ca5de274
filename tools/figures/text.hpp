// Text of figures: names come from file names and studies, and may be anything.
#pragma once

#include <string>

namespace stillpoint::figures {

/// UTF-8 without control characters; what is no UTF-8 becomes replacement characters.
std::string valid_text(const std::string& text);

/// Of valid UTF-8 that is not empty.
void remove_last_letter(std::string& text);

/// An SVG file of Cairo's with a title for screen readers and lists of files, and without the
/// number that Cairo gives to each page of a process. Letters are outlines in it.
std::string with_title(const std::string& svg, const std::string& title);

}  // namespace stillpoint::figures
