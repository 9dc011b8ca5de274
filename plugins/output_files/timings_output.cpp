#include "output_files/timings_output.hpp"

#include <array>
#include <cstdio>

namespace stillpoint::output_files {

TimingsOutput::TimingsOutput(const Options& options, const StageContext& context)
    : file_(context.output_directory / options.file) {
  file_.stream() << "frame,stage,wall_ms,cpu_ms\n";
}

void TimingsOutput::finish(const RunSummary& summary) {
  write(summary.times);
  file_.commit();
}

void TimingsOutput::write(std::span<const StageTime> times) {
  for (const StageTime& time : times) {
    std::array<char, 64> numbers{};
    std::snprintf(numbers.data(), numbers.size(), ",%.4f,%.4f\n", time.wall_ms, time.cpu_ms);
    file_.stream() << time.frame << ',' << time.stage << numbers.data();
  }
}

}  // namespace stillpoint::output_files
