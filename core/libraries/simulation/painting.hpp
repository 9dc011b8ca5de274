// Pictures for textures, painted from a seed. Sizes in px; all are CV_8UC3, BGR.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "simulation/album.hpp"

namespace stillpoint::simulation {

class Painter {
 public:
  /// With an album, photographs take the place of what covers walls, floors and large things.
  explicit Painter(int seed, std::shared_ptr<const Album> album = nullptr)
      : random_(static_cast<std::uint64_t>(seed) * 7919 + 17), album_(std::move(album)) {}

  cv::Mat plaster(cv::Size size, cv::Scalar color, double contrast);
  cv::Mat wood(cv::Size size, cv::Scalar color, double contrast);
  cv::Mat carpet(cv::Size size);
  cv::Mat poster(cv::Size size);
  cv::Mat paper(cv::Size size);
  cv::Mat whiteboard(cv::Size size);
  cv::Mat books(cv::Size size);
  cv::Mat keyboard(cv::Size size);
  cv::Mat screen(cv::Size size, bool on);
  cv::Mat cardboard(cv::Size size);
  cv::Mat metal(cv::Size size, cv::Scalar color);
  cv::Mat plaid(cv::Size size, cv::Scalar color);
  cv::Mat stripes(cv::Size size, cv::Scalar color);
  cv::Mat fabric(cv::Size size, cv::Scalar color, double contrast);
  cv::Mat face(cv::Size size);
  cv::Mat leaves(cv::Size size);
  cv::Mat ball(cv::Size size);
  cv::Mat ceiling(cv::Size size);

  int uniform(int low, int high) { return random_.uniform(low, high); }

 private:
  /// Smooth noise of `octaves` scales, mean 0, about [-1, 1], CV_32F; repeats at its borders.
  cv::Mat noise(cv::Size size, cv::Size coarsest_cells, int octaves, double persistence = 0.55);
  /// `color` made lighter and darker by `field` x `contrast`.
  cv::Mat tint(const cv::Mat& field, cv::Scalar color, double contrast);
  cv::Scalar color(int low = 20, int high = 235);
  void write_lines(cv::Mat& image, cv::Rect area, double height, cv::Scalar ink);
  void picture(cv::Mat image);

  cv::RNG random_;
  std::shared_ptr<const Album> album_;
};

}  // namespace stillpoint::simulation
