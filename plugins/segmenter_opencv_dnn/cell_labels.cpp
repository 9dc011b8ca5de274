#include "segmenter_opencv_dnn/cell_labels.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

/// Pixels [first, end) that lie between the same two cells.
struct PixelRun {
  int cell;
  int first;
  int end;
};

std::vector<PixelRun> runs_of(const std::vector<CellPosition>& positions) {
  std::vector<PixelRun> runs;
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    const int cell = positions[static_cast<std::size_t>(i)].cell;
    if (runs.empty() || runs.back().cell != cell) runs.push_back({cell, i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

/// Scores of one plane at the four cells around a pixel.
struct Corners {
  std::array<float, 4> value;  // top left, top right, bottom left, bottom right
  int label;

  float lowest() const {
    return std::min(std::min(value[0], value[1]), std::min(value[2], value[3]));
  }
  float highest() const {
    return std::max(std::max(value[0], value[1]), std::max(value[2], value[3]));
  }
  float at(float x, float y) const {
    const float top = value[0] + x * (value[1] - value[0]);
    const float bottom = value[2] + x * (value[3] - value[2]);
    return top + y * (bottom - top);
  }
};

class PixelLabeller {
 public:
  PixelLabeller(const std::vector<ScorePlane>& planes, const CellGrid& grid)
      : planes_(planes), grid_(grid), labels_(grid.image, CV_8UC1) {
    corners_.reserve(planes.size());
  }

  void label(const PixelRun& columns, const PixelRun& rows) {
    gather_candidates(columns.cell, rows.cell);
    const int first_label = corners_.front().label;
    const bool certain = std::ranges::all_of(
        corners_, [&](const Corners& corners) { return corners.label == first_label; });
    for (int v = rows.first; v < rows.end; ++v) {
      auto* row = labels_.ptr<std::uint8_t>(v);
      if (certain)
        std::fill(row + columns.first, row + columns.end, static_cast<std::uint8_t>(first_label));
      else
        label_each(columns, grid_.rows[static_cast<std::size_t>(v)].share, row);
    }
  }

  cv::Mat labels() const { return labels_; }

 private:
  /// An interpolated score is never above the highest of its corners: planes that stay below
  /// another one's lowest corner cannot win.
  void gather_candidates(int x, int y) {
    const int right = std::min(x + 1, grid_.cells.width - 1);
    const int below = std::min(y + 1, grid_.cells.height - 1);
    corners_.clear();
    float certain = -std::numeric_limits<float>::infinity();
    for (const ScorePlane& plane : planes_) {
      const auto* top = plane.scores.ptr<float>(y);
      const auto* bottom = plane.scores.ptr<float>(below);
      corners_.push_back({{top[x], top[right], bottom[x], bottom[right]}, plane.label});
      certain = std::max(certain, corners_.back().lowest());
    }
    std::erase_if(corners_, [&](const Corners& c) { return c.highest() < certain; });
  }

  void label_each(const PixelRun& columns, float y, std::uint8_t* row) const {
    for (int u = columns.first; u < columns.end; ++u)
      row[u] =
          static_cast<std::uint8_t>(winner(grid_.columns[static_cast<std::size_t>(u)].share, y));
  }

  int winner(float x, float y) const {
    int label = corners_.front().label;
    float best = corners_.front().at(x, y);
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      const float score = corners_[i].at(x, y);
      if (score <= best) continue;
      best = score;
      label = corners_[i].label;
    }
    return label;
  }

  const std::vector<ScorePlane>& planes_;
  const CellGrid& grid_;
  cv::Mat labels_;
  std::vector<Corners> corners_;  // of the planes that may win
};

int nearest(const CellPosition& position) { return position.cell + (position.share > 0.5f); }

}  // namespace

cv::Mat label_pixels(const std::vector<ScorePlane>& planes, const CellGrid& grid) {
  const std::vector<PixelRun> columns = runs_of(grid.columns);
  PixelLabeller labeller(planes, grid);
  for (const PixelRun& row : runs_of(grid.rows))
    for (const PixelRun& column : columns) labeller.label(column, row);
  return labeller.labels();
}

void score_objects(Segmentation& segmentation, const std::vector<cv::Mat>& probabilities,
                   const CellGrid& grid) {
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    SegmentedObject& object = segmentation.objects[i];
    const cv::Mat& probability = probabilities[static_cast<std::size_t>(object.label)];
    double sum = 0;
    for (int v = object.box.y; v < object.box.br().y; ++v) {
      const auto* instance = segmentation.instances.ptr<std::uint8_t>(v);
      const auto* cells = probability.ptr<float>(nearest(grid.rows[static_cast<std::size_t>(v)]));
      for (int u = object.box.x; u < object.box.br().x; ++u)
        if (instance[u] == i + 1) sum += cells[nearest(grid.columns[static_cast<std::size_t>(u)])];
    }
    object.score = static_cast<float>(std::clamp(sum / object.pixels, 0.0, 1.0));
  }
}

}  // namespace stillpoint::segmenter_opencv_dnn
