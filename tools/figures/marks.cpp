#include "figures/marks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::figures {
namespace {

constexpr double kTranslucent = 0.22;
constexpr double kLanePt = 3;
constexpr double kHairPt = 0.7;

/// On the page, without points that lie where the one before does: pages of 10,000 frames stay
/// small.
class Run {
 public:
  void add(const Eigen::Vector2d& point) {
    constexpr double kSamePt = 0.1;
    skipped_ = !points_.empty() && (point - points_.back()).cwiseAbs().maxCoeff() < kSamePt;
    if (!skipped_) points_.push_back(point);
    last_ = point;
  }
  Points take() {
    if (skipped_) points_.push_back(last_);
    skipped_ = false;
    return std::exchange(points_, {});
  }

 private:
  Points points_;
  Eigen::Vector2d last_{0, 0};
  bool skipped_ = false;
};

/// Calls draw(points on the page) for every unbroken part.
template <class Draw>
void for_each_part(const PanelPlace& place, const Points& points, Draw draw) {
  Run run;
  for (const Eigen::Vector2d& point : points) {
    if (point.allFinite()) {
      run.add(place.on_page(point));
    } else if (const Points part = run.take(); !part.empty()) {
      draw(part);
    }
  }
  if (const Points part = run.take(); !part.empty()) draw(part);
}

class Painter {
 public:
  Painter(Canvas& canvas, const PanelPlace& place, const std::optional<ColourScale>& colours)
      : canvas_(canvas), place_(place), colours_(colours) {}

  void operator()(const Line& line) const {
    const double floor = place_.on_page({0, 0}).y();
    for_each_part(place_, line.points, [&](const Points& part) {
      if (line.filled) {
        Points outline = part;
        outline.emplace_back(part.back().x(), floor);
        outline.emplace_back(part.front().x(), floor);
        canvas_.fill(outline, line.colour, kTranslucent);
      }
      canvas_.line(part, {line.colour, line.width_pt, line.dashed});
    });
  }

  // Successive pieces of about one colour are one stroke.
  void operator()(const ValueLine& line) const {
    Points stroke;
    int shade = 0;
    const auto flush = [&] {
      if (stroke.size() > 1) canvas_.line(stroke, {colour_of(shade), line.width_pt});
      stroke.clear();
    };
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      if (!line.points[i].allFinite()) {
        flush();
        continue;
      }
      const Eigen::Vector2d point = place_.on_page(line.points[i]);
      const int next = shade_of(line.values[i]);
      if (!stroke.empty() && next != shade) {
        const Eigen::Vector2d joint = stroke.back();
        flush();
        stroke = {joint};
      }
      shade = next;
      stroke.push_back(point);
    }
    flush();
  }

  void operator()(const Dot& dot) const {
    if (dot.at.allFinite()) canvas_.dot(place_.on_page(dot.at), dot.radius_pt, dot.colour);
  }

  void operator()(const Stretch& stretch) const {
    const double left = place_.on_page({stretch.x.low, 0}).x(),
                 right = place_.on_page({stretch.x.high, 0}).x();
    const Box& axes = place_.axes;
    if (right - left < kHairPt)
      canvas_.line(Points{{left, axes.y}, {left, axes.bottom()}}, {stretch.colour, kHairPt});
    else if (stretch.lane)
      canvas_.fill({left, axes.y + *stretch.lane * kLanePt, right - left, kLanePt}, stretch.colour);
    else
      canvas_.fill({left, axes.y, right - left, axes.height}, stretch.colour, kTranslucent);
  }

  void operator()(const Bar& bar) const {
    const Eigen::Vector2d from = place_.on_page({bar.x.low, bar.y - bar.thickness / 2}),
                          to = place_.on_page({bar.x.high, bar.y + bar.thickness / 2});
    canvas_.fill(
        {from.x(), std::min(from.y(), to.y()), to.x() - from.x(), std::abs(to.y() - from.y())},
        bar.colour);
  }

 private:
  static constexpr int kShades = 48;

  int shade_of(double value) const {
    const Range& values = colours_->values;
    const double share = std::clamp((value - values.low) / values.span(), 0.0, 1.0);
    return static_cast<int>(std::lround(share * kShades));
  }
  static Colour colour_of(int shade) { return value_colour(static_cast<double>(shade) / kShades); }

  Canvas& canvas_;
  const PanelPlace& place_;
  const std::optional<ColourScale>& colours_;
};

struct Sample {
  Canvas& canvas;
  Eigen::Vector2d at;

  void operator()(const Line& line) const {
    if (line.filled) patch(line.colour, kTranslucent);
    stroke({line.colour, line.width_pt, line.dashed});
  }
  void operator()(const ValueLine&) const {}
  void operator()(const Dot& dot) const {
    canvas.dot(at + Eigen::Vector2d(kSamplePt / 2, 0), dot.radius_pt, dot.colour);
  }
  void operator()(const Stretch& stretch) const {
    if (stretch.x.span() == 0) {
      const Eigen::Vector2d middle = at + Eigen::Vector2d(kSamplePt / 2, 0), half(0, kTextPt / 2);
      canvas.line(Points{middle - half, middle + half}, {stretch.colour, kHairPt});
    } else {
      patch(kReferenceGrey, stretch.lane ? 1.0 : kTranslucent);
    }
  }
  void operator()(const Bar& bar) const { patch(bar.colour, 1.0); }

 private:
  void stroke(const Pen& pen) const {
    canvas.line(Points{at, at + Eigen::Vector2d(kSamplePt, 0)}, pen);
  }
  void patch(const Colour& colour, double opacity) const {
    canvas.fill({at.x(), at.y() - kTextPt / 2, kSamplePt, kTextPt}, colour, opacity);
  }
};

}  // namespace

void draw_mark(Canvas& canvas, const PanelPlace& place, const std::optional<ColourScale>& colours,
               const Mark& mark) {
  std::visit(Painter(canvas, place, colours), mark);
}

void draw_sample(Canvas& canvas, const Eigen::Vector2d& at, const Mark& mark) {
  std::visit(Sample{canvas, at}, mark);
}

}  // namespace stillpoint::figures
