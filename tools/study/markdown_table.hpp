// A table that reads well both as Markdown and on a terminal.
#pragma once

#include <string>
#include <vector>

namespace stillpoint::study {

/// All rows as long as the header; columns are padded to equal width. UTF-8.
std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows);

}  // namespace stillpoint::study
