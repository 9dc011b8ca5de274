// A page to draw on, in any of the formats: Cairo behind a few functions. Points (1/72 inch),
// origin at the top left, y down.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>

#include "figures/colour.hpp"

namespace stillpoint::figures {

enum class Format { kPng, kSvg, kPdf };

struct Box {
  double x, y, width, height;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

struct Pen {
  Colour colour = kInk;
  double width_pt = 1.0;
  bool dashed = false;
};

/// What part of a text lies at its place: 0 the left or upper end, 0.5 the middle, 1 the other end.
struct Anchor {
  double x, y;
};

/// The same in all formats and on all machines with the font.
double text_width_pt(const std::string& text, double size_pt);

/// `text`, or its beginning with an ellipsis where it is wider than `width_pt`.
std::string shortened(const std::string& text, double size_pt, double width_pt);

class Canvas {
 public:
  /// `title` for the reader of the file.
  Canvas(Format format, double width_pt, double height_pt, const std::string& title);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void line(std::span<const Eigen::Vector2d> points, const Pen& pen);
  void fill(std::span<const Eigen::Vector2d> outline, const Colour& colour, double opacity = 1.0);
  void fill(const Box& box, const Colour& colour, double opacity = 1.0);
  void dot(const Eigen::Vector2d& at, double radius_pt, const Colour& colour);
  /// UTF-8; what is not is shown as a replacement character. Upright: from bottom to top, and the
  /// anchor turns with it.
  void text(const std::string& text, const Eigen::Vector2d& at, double size_pt, Anchor anchor,
            bool upright = false);
  /// Until unclip() nothing outside is drawn.
  void clip(const Box& box);
  void unclip();

  /// The file's bytes; the last call. Throws Error(kStage) when Cairo cannot draw the page.
  std::string finish();

 private:
  struct Cairo;
  std::unique_ptr<Cairo> cairo_;
};

}  // namespace stillpoint::figures
