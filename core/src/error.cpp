#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

std::string compose(const std::string& problem, const std::string& where,
                    const std::string& remedy) {
  std::string text = where.empty() ? problem : where + ": " + problem;
  return remedy.empty() ? text : text + "; " + remedy;
}

}  // namespace

Error::Error(Fault fault, const std::string& problem, const std::string& where,
             const std::string& remedy)
    : std::runtime_error(compose(problem, where, remedy)), fault_(fault) {}

Error::~Error() = default;

}  // namespace stillpoint
