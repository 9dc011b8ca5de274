// A figure as pixels, and where on them a point of a panel lies.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "figures/figure_file.hpp"
#include "figures/layout.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::figures {

class Picture {
 public:
  explicit Picture(const Figure& figure) : layout_(lay_out(figure)) {
    const std::string png = draw(figure, Format::kPng);
    pixels_ = decode_image(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
  }

  const cv::Mat& pixels() const { return pixels_; }
  const Layout& layout() const { return layout_; }

  Colour at(std::size_t panel, const Eigen::Vector2d& point) const {
    return at_page(layout_.panels[panel].on_page(point));
  }
  Colour at_page(const Eigen::Vector2d& pt) const {
    const double pixels_per_pt = pixels_.cols / layout_.width_pt;
    const auto& bgr = pixels_.at<cv::Vec3b>(static_cast<int>(pt.y() * pixels_per_pt),
                                            static_cast<int>(pt.x() * pixels_per_pt));
    return {bgr[2] / 255.0, bgr[1] / 255.0, bgr[0] / 255.0};
  }

 private:
  Layout layout_;
  cv::Mat pixels_;
};

/// Up to the rounding of a byte.
inline bool same(const Colour& a, const Colour& b, double tolerance = 0.01) {
  return std::abs(a.red - b.red) < tolerance && std::abs(a.green - b.green) < tolerance &&
         std::abs(a.blue - b.blue) < tolerance;
}

/// One row of one panel.
inline Figure figure_of(Panel panel) {
  Figure figure{"A test"};
  figure.rows.push_back({90, {std::move(panel)}});
  return figure;
}

}  // namespace stillpoint::figures
