#include "output_web/page.hpp"

// The assembler takes the file in as it is; a string literal of its size costs the compiler
// seconds.
asm(R"(
  .pushsection .rodata
  .balign 1
stillpoint_live_page:
  .incbin ")" STILLPOINT_LIVE_PAGE R"("
stillpoint_live_page_end:
  .popsection
)");

extern "C" {
__attribute__((visibility("hidden"))) extern const char stillpoint_live_page[];
__attribute__((visibility("hidden"))) extern const char stillpoint_live_page_end[];
}

namespace stillpoint::output_web {

std::string_view page() { return {stillpoint_live_page, stillpoint_live_page_end}; }

}  // namespace stillpoint::output_web
