#include "orb_slam/feature_grid.hpp"

namespace stillpoint::orb_slam {

FeatureGrid::FeatureGrid(const Features& features, const Camera& camera)
    : columns_(camera.width / kCell + 1),
      rows_(camera.height / kCell + 1),
      start_(static_cast<std::size_t>(columns_) * rows_ + 1),
      entries_(features.size()) {
  const auto cell = [&](const cv::KeyPoint& k) { return row(k.pt.y) * columns_ + column(k.pt.x); };
  for (const cv::KeyPoint& k : features.keypoints) ++start_[cell(k) + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const cv::KeyPoint& k = features.keypoints[i];
    entries_[next[cell(k)]++] = {k.pt.x, k.pt.y, i};
  }
}

}  // namespace stillpoint::orb_slam
