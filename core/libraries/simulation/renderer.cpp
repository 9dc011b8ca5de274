#include "simulation/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulation/body_tiles.hpp"
#include "simulation/eye.hpp"
#include "simulation/motion_blur.hpp"
#include "simulation/parallel.hpp"
#include "simulation/sample_pattern.hpp"
#include "simulation/shading.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

/// A packet of rays and what they meet.
struct Bundle {
  std::array<Vector3f, kPacket> directions;
  std::array<Hit, kPacket> hits;
};

}  // namespace

/// One image on its way.
struct Renderer::Job {
  const Renderer& renderer;
  double exposure;
  View view;
  Shader shader;
  cv::Mat sharp;     // CV_32FC3, colours in the middle of the exposure
  cv::Mat surfaces;  // CV_32SC1, Shader::surface_key per pixel
  MotionMap motion;
  MotionMap motion_around;
  BodyTiles bodies;  // by packet
  Eye middle;
  Eye begin;
  Eye end;
  std::array<std::vector<Eye>, kMany + 1> eyes;    // [n]: n moments, evenly spread
  std::vector<Eigen::Affine3f> begin_from_middle;  // per body, of points in the world
  std::vector<Eigen::Affine3f> end_from_middle;

  Job(const Renderer& r, double t, double e)
      : renderer(r),
        exposure(e),
        shader(r.world_, t, static_cast<float>(1 / r.camera_.fx)),
        motion(packet_columns(), packet_rows()),
        motion_around(motion),
        bodies(r.camera_, kPacketWidth, kPacketHeight),
        middle(eye_at(r.motion_, t, e, 0.5)),
        begin(eye_at(r.motion_, t, e, 0)),
        end(eye_at(r.motion_, t, e, 1)) {
    const cv::Size size(r.camera_.width, r.camera_.height);
    view.depth.create(size, CV_32F);
    view.infrared.create(size, CV_32F);
    view.labels.create(size, CV_8U);
    view.instances.create(size, CV_8U);
    surfaces.create(size, CV_32S);
    for (const std::size_t n : {kFew, kMany})
      for (std::size_t i = 0; i < n; ++i)
        eyes[n].push_back(
            eye_at(r.motion_, t, e, (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
    const std::array<Eye, 3> views = {begin, middle, end};
    for (std::size_t i = 0; i < r.world_.bodies.size(); ++i) {
      std::array<Eigen::Affine3d, 3> world_from_body;
      std::array<Eigen::Affine3f, 3> rounded;
      for (std::size_t k = 0; k < 3; ++k) {
        world_from_body[k] = r.world_.bodies[i].world_from_body(t + (views[k].moment - 0.5) * e);
        rounded[k] = world_from_body[k].cast<float>();
      }
      const Eigen::Affine3d body_from_world = world_from_body[1].inverse(Eigen::Isometry);
      begin_from_middle.emplace_back((world_from_body[0] * body_from_world).cast<float>());
      end_from_middle.emplace_back((world_from_body[2] * body_from_world).cast<float>());
      bodies.add(r.boxes_[i], rounded, views);
    }
  }

  int packet_columns() const { return (renderer.camera_.width + kPacketWidth - 1) / kPacketWidth; }
  int packet_rows() const { return (renderer.camera_.height + kPacketHeight - 1) / kPacketHeight; }

  RayCaster::Targets targets(int column, int row) const {
    return bodies.at(column, row) ? RayCaster::Targets::kAll : RayCaster::Targets::kRoom;
  }
  RayCaster::Targets targets(const std::array<cv::Point, kEdgePixels>& pixels) const {
    const bool any = std::any_of(pixels.begin(), pixels.end(), [&](const cv::Point& p) {
      return bodies.at(p.x / kPacketWidth, p.y / kPacketHeight);
    });
    return any ? RayCaster::Targets::kAll : RayCaster::Targets::kRoom;
  }

  /// Pixels beyond the image are replaced by those at its border.
  Pixels packet(int column, int row) const {
    Pixels pixels{};
    for (int i = 0; i < kPacket; ++i) {
      const auto k = static_cast<std::size_t>(i);
      pixels.x[k] = std::min(column * kPacketWidth + i % kPacketWidth, renderer.camera_.width - 1);
      pixels.y[k] = std::min(row * kPacketHeight + i / kPacketWidth, renderer.camera_.height - 1);
    }
    return pixels;
  }

  /// Casts rays through points of the image, px.
  void cast(const Points& points, const Eye& eye, RayCaster::Targets targets,
            Bundle& bundle) const {
    const Camera& c = renderer.camera_;
    RayPacket rays;
    for (std::size_t i = 0; i < kPacket; ++i) {
      const Vector3f ray((points.x[i] - static_cast<float>(c.cx)) / static_cast<float>(c.fx),
                         (points.y[i] - static_cast<float>(c.cy)) / static_cast<float>(c.fy), 1);
      const Vector3f d = eye.world_from_camera * ray;
      bundle.directions[i] = d;
      rays.x[i] = d.x();
      rays.y[i] = d.y();
      rays.z[i] = d.z();
    }
    renderer.caster_.cast(eye.position, rays, eye.moment, targets, bundle.hits);
  }

  /// How the surface at a hit moves in the image during the exposure.
  MotionRange image_motion(const Hit& hit, const Vector3f& direction) const {
    if (hit.distance == 0 || exposure == 0) return {};
    const Vector3f point = middle.position + hit.distance * direction;
    const auto pixel = [&](const Eye& eye, const Vector3f& p) -> Eigen::Vector2f {
      const Vector3f q = eye.world_from_camera.transpose() * (p - eye.position);
      return q.head<2>() * (static_cast<float>(renderer.camera_.fx) / std::max(q.z(), 0.05F));
    };
    const auto body = static_cast<std::size_t>(hit.body);
    const Eigen::Vector2f moved = hit.body < 0 ? pixel(end, point) - pixel(begin, point)
                                               : pixel(end, end_from_middle[body] * point) -
                                                     pixel(begin, begin_from_middle[body] * point);
    return {moved, moved};
  }

  /// Geometry of a row of packets.
  void find_surfaces(int row) {
    Bundle bundle;
    for (int column = 0; column < packet_columns(); ++column) {
      const Pixels pixels = packet(column, row);
      cast(points_in(pixels, 0, 0), middle, targets(column, row), bundle);
      MotionRange& moved = motion.at(column, row);
      moved = image_motion(bundle.hits[0], bundle.directions[0]);
      moved.include(image_motion(bundle.hits[7], bundle.directions[7]));
      AspectMemory aspects(shader);
      for (std::size_t i = 0; i < kPacket; ++i)
        keep(bundle.hits[i], bundle.directions[i], pixels.x[i], pixels.y[i], aspects);
    }
  }

  void keep(const Hit& hit, const Vector3f& direction, int x, int y, AspectMemory& aspects) {
    if (hit.distance == 0) {
      keep_nothing(x, y);
      return;
    }
    const Face& face = shader.face(hit);
    const Aspect& aspect = aspects.of(hit, face, direction);
    view.depth.at<float>(y, x) = hit.distance;
    view.labels.at<std::uint8_t>(y, x) = face.label;
    view.instances.at<std::uint8_t>(y, x) = face.instance;
    surfaces.at<int>(y, x) = Shader::surface_key(hit, face);
    view.infrared.at<float>(y, x) = aspect.infrared;
    if (sharp.data) set_color(sharp, x, y, shader.color(hit, face, aspect));
  }

  void keep_nothing(int x, int y) {
    view.depth.at<float>(y, x) = 0;
    view.labels.at<std::uint8_t>(y, x) = 0;
    view.instances.at<std::uint8_t>(y, x) = 0;
    surfaces.at<int>(y, x) = -1;
    view.infrared.at<float>(y, x) = 0;
    if (sharp.data) set_color(sharp, x, y, Vector3f::Zero());
  }

  static void set_color(cv::Mat& image, int x, int y, const Vector3f& c) {
    image.at<cv::Vec3f>(y, x) = {c[0], c[1], c[2]};
  }

  bool is_edge(int x, int y) const {
    const int key = surfaces.at<int>(y, x);
    const auto differs = [&](int to_x, int to_y) {
      return to_x >= 0 && to_y >= 0 && to_x < surfaces.cols && to_y < surfaces.rows &&
             surfaces.at<int>(to_y, to_x) != key;
    };
    return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
  }

  /// No surface in the range moves by more than a pixel during the exposure.
  static bool is_still(const MotionRange& range) { return range.fastest() <= 1; }
  /// Surfaces move past each other: a shifted image would not show what comes into view.
  static bool is_torn(const MotionRange& range) {
    constexpr float kApart = 1.5F;  // px; less is lost in the blur
    return !is_still(range) && range.spread() > kApart;
  }

  /// Smooth edges in `sharp`, and final colours where surfaces move past each other.
  void refine(int row) {
    std::array<cv::Point, kEdgePixels> edges;
    std::size_t waiting = 0;
    for (int column = 0; column < packet_columns(); ++column) {
      const Pixels pixels = packet(column, row);
      const MotionRange& range = motion_around.at(column, row);
      if (is_torn(range)) {
        expose(pixels, targets(column, row), range.fastest() <= kFew ? kFew : kMany);
        continue;
      }
      for (std::size_t i = 0; i < kPacket; ++i) {
        if (!is_edge(pixels.x[i], pixels.y[i])) continue;
        edges[waiting] = {pixels.x[i], pixels.y[i]};
        if (++waiting < kEdgePixels) continue;
        smooth(edges);
        waiting = 0;
      }
    }
    if (waiting == 0) return;
    std::fill(edges.begin() + static_cast<std::ptrdiff_t>(waiting), edges.end(), edges[0]);
    smooth(edges);
  }

  Vector3f color(const Hit& hit, const Face& face, const Vector3f& direction,
                 AspectMemory& aspects) const {
    return shader.color(hit, face, aspects.of(hit, face, direction));
  }

  /// Several views spread over each pixel; one look at each surface's colour is enough.
  void smooth(const std::array<cv::Point, kEdgePixels>& pixels) {
    constexpr float kAside = 1.0F / 3;  // px
    Points points{};
    for (std::size_t i = 0; i < kPacket; ++i) {
      const cv::Point& pixel = pixels[i / kEdgeViews];
      const float dx = i % kEdgeViews == 0 ? -kAside : kAside;
      // One diagonal or the other, in turn: no direction is smoother than others.
      const float dy = (pixel.x + pixel.y) % 2 == 0 ? dx : -dx;
      points.x[i] = static_cast<float>(pixel.x) + dx;
      points.y[i] = static_cast<float>(pixel.y) + dy;
    }
    Bundle bundle;
    cast(points, middle, targets(pixels), bundle);
    AspectMemory aspects(shader);
    std::array<Vector3f, kEdgePixels> sums;
    for (std::size_t i = 0; i < kEdgePixels; ++i) sums[i] = color_at(pixels[i]);
    for (std::size_t i = 0; i < kPacket; ++i) {
      const Hit& hit = bundle.hits[i];
      if (hit.distance == 0) continue;
      const cv::Point& pixel = pixels[i / kEdgeViews];
      const Face& face = shader.face(hit);
      if (Shader::surface_key(hit, face) == surfaces.at<int>(pixel))
        sums[i / kEdgeViews] += color_at(pixel);
      else
        sums[i / kEdgeViews] += color(hit, face, bundle.directions[i], aspects);
    }
    for (std::size_t i = 0; i < kEdgePixels; ++i)
      set_color(sharp, pixels[i].x, pixels[i].y, sums[i] / static_cast<float>(kEdgeViews + 1));
  }

  Vector3f color_at(const cv::Point& pixel) const {
    return Vector3f(sharp.at<cv::Vec3f>(pixel).val);
  }

  /// Views spread over each pixel and the exposure.
  void expose(const Pixels& pixels, RayCaster::Targets targets, std::size_t count) {
    Bundle bundle;
    AspectMemory aspects(shader);
    std::array<Vector3f, kPacket> sums;
    sums.fill(Vector3f::Zero());
    for (std::size_t s = 0; s < count; ++s) {
      cast(points_in(pixels, cell_offset(0, s, count), cell_offset(1, s, count)), eyes[count][s],
           targets, bundle);
      for (std::size_t i = 0; i < kPacket; ++i) {
        const Hit& hit = bundle.hits[i];
        if (hit.distance > 0)
          sums[i] += color(hit, shader.face(hit), bundle.directions[i], aspects);
      }
    }
    for (std::size_t i = 0; i < kPacket; ++i)
      set_color(view.color, pixels.x[i], pixels.y[i], sums[i] / static_cast<float>(count));
  }

  /// Final colours where the image stands still or moves as a whole.
  void blur(int row) {
    for (int column = 0; column < packet_columns(); ++column) {
      const MotionRange& range = motion_around.at(column, row);
      if (is_torn(range)) continue;
      const Pixels pixels = packet(column, row);
      for (std::size_t i = 0; i < kPacket; ++i) {
        const cv::Point pixel(pixels.x[i], pixels.y[i]);
        view.color.at<cv::Vec3f>(pixel) =
            is_still(range) ? sharp.at<cv::Vec3f>(pixel) : mean_along(sharp, pixel, range.mean());
      }
    }
  }
};

Renderer::Renderer(const World& world, const CameraMotion& motion, const Camera& camera,
                   int threads)
    : world_(world), motion_(motion), camera_(camera), threads_(threads), caster_(world) {
  for (const Body& body : world.bodies) {
    Eigen::AlignedBox3f& box = boxes_.emplace_back();
    for (const Vector3f& vertex : body.mesh.vertices) box.extend(vertex);
  }
}

View Renderer::render(double time, double exposure) {
  caster_.pose_bodies(time - exposure / 2, time + exposure / 2);
  Job job(*this, time, exposure);
  job.sharp.create(job.surfaces.size(), CV_32FC3);
  job.view.color.create(job.surfaces.size(), CV_32FC3);
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.find_surfaces(row); });
  job.motion_around = job.motion.widened();
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.refine(row); });
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.blur(row); });
  return job.view;
}

View Renderer::render_geometry(double time) {
  caster_.pose_bodies(time, time);
  Job job(*this, time, 0);
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.find_surfaces(row); });
  return job.view;
}

}  // namespace stillpoint::simulation
