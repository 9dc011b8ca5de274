#include "stillpoint/options.hpp"

namespace stillpoint {

OptionVisitor::~OptionVisitor() = default;

void OptionVisitor::require(bool, std::string_view) {}

}  // namespace stillpoint
