// Where and when a run was made: what a table has to say for others to repeat it.
#pragma once

#include <string>

namespace stillpoint::evaluation {

/// The program that makes the runs.
struct Program {
  std::string fingerprint;  ///< of the files of the program and its plugins
  std::string version;
  std::string commit;  ///< empty: not built from a git repository
};

struct Origin {
  std::string version;
  std::string commit;   ///< may be empty
  std::string machine;  ///< "AMD EPYC 7B13, 2 cores"
  std::string date;     ///< of the end of the run, UTC: "2026-11-26"

  bool operator==(const Origin&) const = default;
};

/// "Stillpoint 0.1.0, commit 4b72915a81c2; AMD EPYC 7B13, 2 cores"; says so where nothing is known.
std::string build_text(const Origin& origin);

/// The same with the date.
std::string origin_text(const Origin& origin);

/// Here and now.
Origin origin_of(const Program& program);

}  // namespace stillpoint::evaluation
