#include "orb_slam/keypoint_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace stillpoint::orb_slam {
namespace {

// Square cells that are covered by a corner chosen already. The side of a cell counts in eighths of
// a pixel, fine enough to meet a wanted number of corners.
constexpr int kUnits = 8;

class Cover {
 public:
  Cover(cv::Size image, int side)
      : side_(side),
        columns_(image.width * kUnits / side + 1 + 2 * kReach),
        covered_(static_cast<std::size_t>(columns_) *
                 static_cast<std::size_t>(image.height * kUnits / side + 1 + 2 * kReach)) {}

  // False if the corner's cell is covered; otherwise covers the square of cells around it.
  bool claim(const Corner& corner) {
    const int column = corner.x * kUnits / side_, row = corner.y * kUnits / side_;
    std::uint8_t* first = &covered_[static_cast<std::size_t>(row * columns_ + column)];
    if (first[kReach * columns_ + kReach]) return false;
    for (int i = 0; i <= 2 * kReach; ++i, first += columns_)
      std::fill_n(first, 2 * kReach + 1, std::uint8_t{1});
    return true;
  }

 private:
  static constexpr int kReach = 2;  // cells to each side
  int side_, columns_;
  std::vector<std::uint8_t> covered_;
};

std::vector<Corner> suppress(const std::vector<Corner>& sorted, cv::Size image, int side) {
  std::vector<Corner> chosen;
  Cover cover(image, side);
  for (const Corner& corner : sorted)
    if (cover.claim(corner)) chosen.push_back(corner);
  return chosen;
}

}  // namespace

void drop_weak_beside_strong(std::vector<Corner>& corners, cv::Size image, int cell,
                             int threshold) {
  const int columns = image.width / cell + 1;
  std::vector<std::uint8_t> has_strong(static_cast<std::size_t>(columns) *
                                       (image.height / cell + 1));
  const auto cell_of = [&](const Corner& c) { return c.y / cell * columns + c.x / cell; };
  for (const Corner& c : corners)
    if (c.score > threshold) has_strong[cell_of(c)] = 1;
  std::erase_if(corners,
                [&](const Corner& c) { return c.score <= threshold && has_strong[cell_of(c)]; });
}

void keep_evenly_spread(std::vector<Corner>& corners, cv::Size image, int count) {
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.score > b.score; });
  if (std::ssize(corners) <= count) return;
  // The largest neighbourhood that leaves enough corners. The start of the search leaves too few:
  // it gives every corner 25 times its share of the image.
  int enough = 1,
      too_large = static_cast<int>(kUnits * std::sqrt(image.area() / (count + 1.0))) + 2;
  std::vector<Corner> best = corners;
  while (too_large - enough > 1 && std::ssize(best) > count) {
    const int side = (enough + too_large) / 2;
    std::vector<Corner> chosen = suppress(corners, image, side);
    if (std::ssize(chosen) < count) {
      too_large = side;
    } else {
      enough = side;
      best = std::move(chosen);
    }
  }
  best.resize(static_cast<std::size_t>(count));
  corners = std::move(best);
}

}  // namespace stillpoint::orb_slam
