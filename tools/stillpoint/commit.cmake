# Writes FILE, a source file with the commit of SOURCE_DIR; left alone where it has not changed.
execute_process(
  COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${FILE} @ONLY CONTENT [[
#include "commit.hpp"

namespace stillpoint {

std::string built_from_commit() { return "@commit@"; }

}  // namespace stillpoint
]])
