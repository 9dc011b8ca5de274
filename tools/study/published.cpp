#include "study/published.hpp"

#include <algorithm>

namespace stillpoint::study {
namespace {

/// In the order of error_figures().
const std::vector<double>& list_of(const PublishedErrors& errors, std::size_t kind) {
  if (kind == 0) return errors.ate_m;
  return kind == 1 ? errors.rpe_translation_m : errors.rpe_rotation_deg;
}

}  // namespace

void PublishedErrors::visit(OptionVisitor& v) {
  const OptionInfo info{.min = 0, .help = "[RMSE], or [RMSE, mean, median, S.D.]"};
  v(metrics()[kAte].key, ate_m, info);
  v(metrics()[kRpeTranslation].key, rpe_translation_m, info);
  v(metrics()[kRpeRotation].key, rpe_rotation_deg, info);
  for (std::size_t kind = 0; kind < error_figures().size(); ++kind) {
    const std::size_t size = list_of(*this, kind).size();
    v.require(size <= 1 || size == 4, "an error is [RMSE], or [RMSE, mean, median, S.D.]");
  }
}

void PublishedTimes::visit(OptionVisitor& v) {
  for (std::size_t stage = 0; stage < ms.size(); ++stage)
    v(metrics()[kFirstStage + stage].key, ms[stage],
      {.min = 0, .unit = "ms", .help = "0: not published"});
}

void Published::visit(OptionVisitor& v) {
  v("name", name, {.help = "of the system", .required = true});
  v("source", source, {.help = "where the figures are found", .required = true});
  v("errors", errors, {.help = "by recording"});
  v("times", times, {.help = "mean of each stage"});
}

std::optional<double> Published::find(const std::string& recording, MetricId metric) const {
  if (metric >= kFirstStage) {
    const double time = times.ms[metric - kFirstStage];
    return time > 0.0 ? std::optional(time) : std::nullopt;
  }
  const auto found = errors.find(recording);
  if (found == errors.end()) return std::nullopt;
  for (std::size_t kind = 0; kind < error_figures().size(); ++kind) {
    const auto figures = error_figures()[kind].all();
    const std::vector<double>& values = list_of(found->second, kind);
    const auto place =
        static_cast<std::size_t>(std::ranges::find(figures, metric) - figures.begin());
    if (place < values.size()) return values[place];
  }
  return std::nullopt;
}

}  // namespace stillpoint::study
