#include "study_list.hpp"

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "evaluation/format.hpp"
#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/error.hpp"
#include "study/matrix.hpp"
#include "study_file.hpp"

namespace stillpoint {
namespace {

struct ListedStudy {
  std::string name, runs, question;
};

ListedStudy listed(const std::string& name) {
  try {
    const study::Study study = read_study(find_config(name, "studies"));
    return {name, std::to_string(study::cells_of(study).size()), study.question};
  } catch (const Error& error) {
    return {name, "?", error.what()};
  }
}

}  // namespace

void list_studies(std::ostream& out) {
  std::vector<ListedStudy> studies = {{"study", "runs", "question"}};
  for (const std::string& name : config_names("studies")) studies.push_back(listed(name));
  std::size_t name_width = 0, runs_width = 0;
  for (const ListedStudy& study : studies) {
    name_width = std::max(name_width, evaluation::width_of(study.name));
    runs_width = std::max(runs_width, study.runs.size());
  }
  for (const ListedStudy& study : studies)
    out << study.name << std::string(name_width - evaluation::width_of(study.name) + 2, ' ')
        << std::string(runs_width - study.runs.size(), ' ') << study.runs << "  " << study.question
        << '\n';
}

}  // namespace stillpoint
