// stillpoint ablate --list
#pragma once

#include <iosfwd>

namespace stillpoint {

/// A line per study in configs/studies: its name, how many runs it has, and its question.
/// Recordings and pipelines are not looked at; a file that is no study is listed with what is
/// wrong.
void list_studies(std::ostream& out);

}  // namespace stillpoint
