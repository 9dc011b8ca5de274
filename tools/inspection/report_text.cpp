#include "inspection/report_text.hpp"

#include <algorithm>

#include "inspection/number_text.hpp"

namespace stillpoint::inspection {

std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

void row(std::ostream& out, const std::string& name, const std::string& value) {
  out << "  " << name << std::string(18 - name.size(), ' ') << value << '\n';
}

std::string milliseconds(double seconds, int digits) {
  return fixed(1e3 * seconds, digits) + " ms";
}

std::string stream_text(const StreamAudit& stream, double start) {
  constexpr std::size_t kListedGaps = 3;
  std::string text = std::to_string(stream.images) + " images";
  if (stream.interval <= 0) return text;
  text += " in " + fixed(stream.duration, 2) + " s, " + fixed(1 / stream.interval, 1) + " Hz, ";
  if (stream.gaps.empty()) return text + "no gaps";
  text += std::to_string(stream.gaps.size()) + (stream.gaps.size() == 1 ? " gap: " : " gaps: ");
  for (std::size_t i = 0; i < std::min(kListedGaps, stream.gaps.size()); ++i)
    text += std::string(i > 0 ? ", " : "") + milliseconds(stream.gaps[i].length) + " at " +
            fixed(stream.gaps[i].begin - start, 2) + " s";
  return text + (stream.gaps.size() > kListedGaps ? " …" : "");
}

}  // namespace stillpoint::inspection
