#include "simulation/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulation/parallel.hpp"
#include "simulation/shading.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

constexpr int kPacketWidth = 4;  // px
constexpr int kPacketHeight = 2;
constexpr int kFew = 4;   // samples at an edge
constexpr int kMany = 8;  // samples at a fast edge; the most anywhere

/// Columns and rows of the samples of an edge pixel in a grid of kFew or kMany: each is used once,
/// so that the mean stays at the pixel's centre, and in an order that has nothing to do with time.
constexpr std::array<std::array<int, kFew>, 2> kFewCells = {{{1, 3, 0, 2}, {0, 2, 3, 1}}};
constexpr std::array<std::array<int, kMany>, 2> kManyCells = {
    {{0, 4, 2, 6, 1, 5, 3, 7}, {2, 7, 4, 1, 6, 3, 0, 5}}};

/// Offset in px along axis 0 (x) or 1 (y).
float cell_offset(std::size_t axis, std::size_t sample, std::size_t count) {
  const int cell = count == kFew ? kFewCells[axis][sample] : kManyCells[axis][sample];
  return (static_cast<float>(cell) + 0.5F) / static_cast<float>(count) - 0.5F;
}

/// The camera at one moment of the exposure.
struct Eye {
  Eigen::Vector3f position;
  Eigen::Matrix3f world_from_camera;
  float moment;  // of the exposure, [0, 1]
};

Eye eye_at(const CameraMotion& motion, double time, double exposure, double moment) {
  const Pose pose = motion.world_from_camera(time + (moment - 0.5) * exposure);
  return {pose.translation().cast<float>(), pose.linear().cast<float>(),
          static_cast<float>(moment)};
}

/// Two views of the same surface point on different sides of this differ by an edge.
std::uint32_t surface_key(const Hit& hit, const Face& face) {
  return static_cast<std::uint32_t>(hit.body + 1) << 16 | face.surface;
}

/// Pixels whose rays are cast together; those near each other are faster.
struct Pixels {
  std::array<int, kPacket> x;
  std::array<int, kPacket> y;
};

}  // namespace

/// One image on its way.
struct Renderer::Job {
  const Renderer& renderer;
  double time;
  double exposure;
  bool colored;
  View view;
  Shader shader;
  cv::Mat surfaces;  // CV_32SC1, surface_key per pixel
  cv::Mat motion;    // CV_32FC1, px during the exposure, per packet
  Eye middle;
  Eye begin;
  Eye end;
  std::array<std::vector<Eye>, kMany + 1> eyes;    // [n]: n moments, evenly spread
  std::vector<Eigen::Affine3d> begin_from_middle;  // per body, of points in the world
  std::vector<Eigen::Affine3d> end_from_middle;

  Job(const Renderer& r, double t, double e, bool with_color)
      : renderer(r),
        time(t),
        exposure(e),
        colored(with_color),
        shader(r.world_, t, static_cast<float>(1 / r.camera_.fx)) {
    const cv::Size size(r.camera_.width, r.camera_.height);
    if (colored) view.color.create(size, CV_32FC3);
    view.depth.create(size, CV_32F);
    view.infrared.create(size, CV_32F);
    view.labels.create(size, CV_8U);
    view.instances.create(size, CV_8U);
    surfaces.create(size, CV_32S);
    motion = cv::Mat::zeros(packet_rows(), packet_columns(), CV_32F);
    middle = eye_at(r.motion_, t, e, 0.5);
    begin = eye_at(r.motion_, t, e, 0);
    end = eye_at(r.motion_, t, e, 1);
    for (int n = 2; colored && n <= kMany; ++n)
      for (int i = 0; i < n; ++i)
        eyes[static_cast<std::size_t>(n)].push_back(eye_at(r.motion_, t, e, (i + 0.5) / n));
    for (const Body& body : r.world_.bodies) {
      const Eigen::Affine3d body_from_world = body.world_from_body(t).inverse(Eigen::Isometry);
      begin_from_middle.push_back(body.world_from_body(t - e / 2) * body_from_world);
      end_from_middle.push_back(body.world_from_body(t + e / 2) * body_from_world);
    }
  }

  int packet_columns() const { return (renderer.camera_.width + kPacketWidth - 1) / kPacketWidth; }
  int packet_rows() const { return (renderer.camera_.height + kPacketHeight - 1) / kPacketHeight; }

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

  /// Casts rays `dx`, `dy` px from the centres of pixels.
  void cast(const Pixels& pixels, const Eye& eye, float dx, float dy,
            std::array<Vector3f, kPacket>& directions, std::array<Hit, kPacket>& hits) const {
    const Camera& c = renderer.camera_;
    RayPacket rays;
    for (std::size_t i = 0; i < kPacket; ++i) {
      const float u = static_cast<float>(pixels.x[i]) + dx;
      const float v = static_cast<float>(pixels.y[i]) + dy;
      const Vector3f ray((u - static_cast<float>(c.cx)) / static_cast<float>(c.fx),
                         (v - static_cast<float>(c.cy)) / static_cast<float>(c.fy), 1);
      const Vector3f d = eye.world_from_camera * ray;
      directions[i] = d;
      rays.x[i] = d.x();
      rays.y[i] = d.y();
      rays.z[i] = d.z();
    }
    renderer.caster_.cast(eye.position, rays, eye.moment, hits);
  }

  /// How far the surface at a hit moves in the image during the exposure, px.
  float image_motion(const Hit& hit, const Vector3f& direction) const {
    if (hit.distance == 0) return 0;
    const Vector3f point = middle.position + hit.distance * direction;
    const auto pixel = [&](const Eye& eye, const Vector3f& p) -> Eigen::Vector2f {
      const Vector3f q = eye.world_from_camera.transpose() * (p - eye.position);
      return q.head<2>() * (static_cast<float>(renderer.camera_.fx) / std::max(q.z(), 0.05F));
    };
    if (hit.body < 0) return (pixel(end, point) - pixel(begin, point)).norm();
    const auto body = static_cast<std::size_t>(hit.body);
    return (pixel(end, end_from_middle[body].cast<float>() * point) -
            pixel(begin, begin_from_middle[body].cast<float>() * point))
        .norm();
  }

  /// Geometry of a row of packets, and colours where one sample will do.
  void first_pass(int row) {
    std::array<Vector3f, kPacket> directions;
    std::array<Hit, kPacket> hits;
    for (int column = 0; column < packet_columns(); ++column) {
      const Pixels pixels = packet(column, row);
      cast(pixels, middle, 0, 0, directions, hits);
      float& moved = motion.at<float>(row, column);
      if (colored && exposure > 0)
        moved =
            std::max(image_motion(hits[0], directions[0]), image_motion(hits[7], directions[7]));
      for (std::size_t i = 0; i < kPacket; ++i)
        keep(hits[i], directions[i], pixels.x[i], pixels.y[i], colored && moved <= 1);
    }
  }

  void keep(const Hit& hit, const Vector3f& direction, int x, int y, bool with_color) {
    view.depth.at<float>(y, x) = hit.distance;
    if (hit.distance == 0) {
      view.labels.at<std::uint8_t>(y, x) = 0;
      view.instances.at<std::uint8_t>(y, x) = 0;
      view.infrared.at<float>(y, x) = 0;
      surfaces.at<int>(y, x) = -1;
      if (with_color) view.color.at<cv::Vec3f>(y, x) = {};
      return;
    }
    const Face& face = shader.face(hit);
    view.labels.at<std::uint8_t>(y, x) = face.label;
    view.instances.at<std::uint8_t>(y, x) = face.instance;
    surfaces.at<int>(y, x) = static_cast<int>(surface_key(hit, face));
    view.infrared.at<float>(y, x) =
        shader.cosine(hit, direction) * renderer.world_.textures[face.texture].infrared();
    if (with_color) set_color(x, y, shader.shade(hit, direction));
  }

  void set_color(int x, int y, const Vector3f& c) {
    view.color.at<cv::Vec3f>(y, x) = {c[0], c[1], c[2]};
  }

  bool is_edge(int x, int y) const {
    const int key = surfaces.at<int>(y, x);
    const auto differs = [&](int to_x, int to_y) {
      return to_x >= 0 && to_y >= 0 && to_x < surfaces.cols && to_y < surfaces.rows &&
             surfaces.at<int>(to_y, to_x) != key;
    };
    return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
  }

  /// Motion here or near enough to come here during the exposure.
  float motion_around(int column, int row) const {
    float most = 0;
    for (int y = std::max(0, row - 2); y <= std::min(packet_rows() - 1, row + 2); ++y)
      for (int x = std::max(0, column - 1); x <= std::min(packet_columns() - 1, column + 1); ++x)
        most = std::max(most, motion.at<float>(y, x));
    return most;
  }

  /// Colours of a row of packets where edges or motion need several samples.
  void second_pass(int row) {
    Pixels edges{};
    std::size_t waiting = 0;
    for (int column = 0; column < packet_columns(); ++column) {
      const Pixels pixels = packet(column, row);
      // One sample per pixel of motion: textures are as smooth as a pixel is wide.
      const int n = std::clamp(static_cast<int>(std::ceil(motion_around(column, row))), 1, kMany);
      if (n > 1) {
        bool edge = false;
        for (std::size_t i = 0; i < kPacket; ++i) edge |= is_edge(pixels.x[i], pixels.y[i]);
        const int count = !edge ? n : n <= kFew ? kFew : kMany;
        resample(pixels, static_cast<std::size_t>(count), edge);
        continue;
      }
      for (std::size_t i = 0; i < kPacket; ++i) {
        if (!is_edge(pixels.x[i], pixels.y[i])) continue;
        edges.x[waiting] = pixels.x[i];
        edges.y[waiting] = pixels.y[i];
        if (++waiting < kPacket) continue;
        resample(edges, kFew, true);
        waiting = 0;
      }
    }
    if (waiting == 0) return;
    for (std::size_t i = waiting; i < kPacket; ++i) {
      edges.x[i] = edges.x[0];
      edges.y[i] = edges.y[0];
    }
    resample(edges, kFew, true);
  }

  void resample(const Pixels& pixels, std::size_t count, bool edge) {
    std::array<Vector3f, kPacket> directions;
    std::array<Hit, kPacket> hits;
    std::array<Vector3f, kPacket> sums;
    sums.fill(Vector3f::Zero());
    for (std::size_t s = 0; s < count; ++s) {
      const float dx = edge ? cell_offset(0, s, count) : 0;
      const float dy = edge ? cell_offset(1, s, count) : 0;
      cast(pixels, eyes[count][s], dx, dy, directions, hits);
      for (std::size_t i = 0; i < kPacket; ++i)
        if (hits[i].distance > 0) sums[i] += shader.shade(hits[i], directions[i]);
    }
    for (std::size_t i = 0; i < kPacket; ++i)
      set_color(pixels.x[i], pixels.y[i], sums[i] / static_cast<float>(count));
  }
};

Renderer::Renderer(const World& world, const CameraMotion& motion, const Camera& camera,
                   int threads)
    : world_(world), motion_(motion), camera_(camera), threads_(threads), caster_(world) {}

View Renderer::render(double time, double exposure) {
  caster_.pose_bodies(time - exposure / 2, time + exposure / 2);
  Job job(*this, time, exposure, true);
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.first_pass(row); });
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.second_pass(row); });
  return job.view;
}

View Renderer::render_geometry(double time) {
  caster_.pose_bodies(time, time);
  Job job(*this, time, 0, false);
  parallel_for(threads_, job.packet_rows(), [&](int row) { job.first_pass(row); });
  return job.view;
}

}  // namespace stillpoint::simulation
