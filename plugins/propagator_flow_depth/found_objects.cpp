#include "propagator_flow_depth/found_objects.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "propagator_flow_depth/mask_rim.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr double kSurfaceShare = 0.05;  // of the mask; less is no separate surface

/// A box of a frame in its view.
cv::Rect view_box(cv::Rect box, cv::Size view) {
  return cv::Rect(box.x / kViewScale - 1, box.y / kViewScale - 1, box.width / kViewScale + 3,
                  box.height / kViewScale + 3) &
         cv::Rect({}, view);
}

cv::Mat inside(const cv::Mat& depth, const DepthLayer& layer) {
  cv::Mat result;
  cv::inRange(depth, layer.near, layer.far, result);
  return result;
}

/// The parts of the object in front of its layer, one surface after the other.
std::vector<FoundObject> surfaces_in_front(const FoundObject& object, const View& view, int rim) {
  std::vector<FoundObject> surfaces;
  if (!object.layer.known()) return surfaces;
  const cv::Mat depth = view.depth(object.box);
  const double enough = kSurfaceShare * object.pixels;
  cv::Mat rest = object.mask & (depth > 0) & (depth < object.layer.near);
  if (cv::countNonZero(rest) < enough) return surfaces;
  rest = remove_rims(rest, rim);
  while (cv::countNonZero(rest) >= enough) {
    FoundObject surface{.label = object.label, .score = object.score, .box = object.box};
    surface.layer = depth_layer(depth, rest);
    if (!surface.layer.known()) break;
    surface.mask = rest & inside(depth, surface.layer);
    surface.pixels = cv::countNonZero(surface.mask);
    rest &= ~surface.mask;
    if (surface.pixels >= enough) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace

FoundObjects found_objects(const Segmentation& segmentation, const View& view,
                           const FindOptions& options) {
  Segmentation named = segmentation;
  if (named.instances.empty()) find_objects(named, options.min_pixels);
  FoundObjects found;
  cv::resize(named.instances, found.instances, view.size(), 0, 0, cv::INTER_NEAREST);
  for (std::size_t i = 0; i < named.objects.size(); ++i) {
    FoundObject object{.label = named.objects[i].label, .score = named.objects[i].score};
    object.box = view_box(named.objects[i].box, view.size());
    object.mask = found.instances(object.box) == static_cast<int>(i) + 1;
    object.pixels = cv::countNonZero(object.mask);
    object.layer = depth_layer(view.depth(object.box), object.mask);
    found.objects.push_back(std::move(object));
  }
  for (std::size_t i = 0; i < named.objects.size(); ++i) {
    for (FoundObject& surface : surfaces_in_front(found.objects[i], view, options.rim)) {
      if (found.objects.size() == kMostObjects) return found;
      found.objects.push_back(std::move(surface));
      found.instances(found.objects.back().box)
          .setTo(static_cast<int>(found.objects.size()), found.objects.back().mask);
    }
  }
  return found;
}

}  // namespace stillpoint::propagator_flow_depth
