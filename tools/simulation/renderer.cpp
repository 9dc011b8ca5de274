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
constexpr float kSharp = 0.6F;  // px of motion during the exposure that one sample can show
constexpr float kSmooth = 4.0F;  // px of motion that kFew samples can show
constexpr int kFew = 4;
constexpr int kMany = 8;

/// Positions within a pixel, in px from its centre: Halton points, bases 2 and 3.
constexpr std::array<std::array<float, 2>, kMany> kSamples = {{{0.0F, -1 / 6.F},
                                                               {-0.25F, 1 / 6.F},
                                                               {0.25F, -7 / 18.F},
                                                               {-0.375F, -1 / 18.F},
                                                               {0.125F, 5 / 18.F},
                                                               {-0.125F, -5 / 18.F},
                                                               {0.375F, 1 / 18.F},
                                                               {-0.4375F, 7 / 18.F}}};

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
  std::array<Eye, kFew> few;
  std::array<Eye, kMany> many;
  std::vector<Eigen::Affine3d> begin_from_middle;  // per body, of points in the world
  std::vector<Eigen::Affine3d> end_from_middle;

  Job(const Renderer& r, double t, double e, bool with_color)
      : renderer(r), time(t), exposure(e), colored(with_color),
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
    for (std::size_t i = 0; i < kFew; ++i)
      few[i] = eye_at(r.motion_, t, e, (static_cast<double>(i) + 0.5) / kFew);
    for (std::size_t i = 0; i < kMany; ++i)
      many[i] = eye_at(r.motion_, t, e, (static_cast<double>(i) + 0.5) / kMany);
    for (const Body& body : r.world_.bodies) {
      const Eigen::Affine3d body_from_world = body.world_from_body(t).inverse(Eigen::Isometry);
      begin_from_middle.push_back(body.world_from_body(t - e / 2) * body_from_world);
      end_from_middle.push_back(body.world_from_body(t + e / 2) * body_from_world);
    }
  }

  int packet_columns() const { return (renderer.camera_.width + kPacketWidth - 1) / kPacketWidth; }
  int packet_rows() const { return (renderer.camera_.height + kPacketHeight - 1) / kPacketHeight; }

  /// Casts the rays of a packet of pixels, `dx`, `dy` px from their centres.
  void cast(int column, int row, const Eye& eye, float dx, float dy,
            std::array<Vector3f, kPacket>& directions, std::array<Hit, kPacket>& hits) const {
    const Camera& c = renderer.camera_;
    RayPacket packet;
    for (int i = 0; i < kPacket; ++i) {
      const auto u = static_cast<float>(column * kPacketWidth + i % kPacketWidth) + dx;
      const auto v = static_cast<float>(row * kPacketHeight + i / kPacketWidth) + dy;
      const Vector3f ray((u - static_cast<float>(c.cx)) / static_cast<float>(c.fx),
                         (v - static_cast<float>(c.cy)) / static_cast<float>(c.fy), 1);
      const Vector3f d = eye.world_from_camera * ray;
      const auto k = static_cast<std::size_t>(i);
      directions[k] = d;
      packet.x[k] = d.x();
      packet.y[k] = d.y();
      packet.z[k] = d.z();
    }
    renderer.caster_.cast(eye.position, packet, eye.moment, hits);
  }

  /// Calls visit(lane, x, y) for the pixels of a packet that lie in the image.
  template <class Visit>
  void for_pixels(int column, int row, Visit&& visit) const {
    for (int i = 0; i < kPacket; ++i) {
      const int x = column * kPacketWidth + i % kPacketWidth;
      const int y = row * kPacketHeight + i / kPacketWidth;
      if (x < renderer.camera_.width && y < renderer.camera_.height)
        visit(static_cast<std::size_t>(i), x, y);
    }
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
      cast(column, row, middle, 0, 0, directions, hits);
      float& moved = motion.at<float>(row, column);
      if (colored && exposure > 0)
        moved = std::max(image_motion(hits[0], directions[0]), image_motion(hits[7], directions[7]));
      for_pixels(column, row, [&](std::size_t i, int x, int y) {
        const Hit& hit = hits[i];
        view.depth.at<float>(y, x) = hit.distance;
        if (hit.distance == 0) {
          view.labels.at<std::uint8_t>(y, x) = 0;
          view.instances.at<std::uint8_t>(y, x) = 0;
          view.infrared.at<float>(y, x) = 0;
          surfaces.at<int>(y, x) = -1;
          if (colored) view.color.at<cv::Vec3f>(y, x) = {};
          return;
        }
        const Face& face = shader.face(hit);
        view.labels.at<std::uint8_t>(y, x) = face.label;
        view.instances.at<std::uint8_t>(y, x) = face.instance;
        surfaces.at<int>(y, x) = static_cast<int>(surface_key(hit, face));
        float cosine = 0;
        if (colored && moved <= kSharp) {
          const Shade shade = shader.shade(hit, directions[i]);
          view.color.at<cv::Vec3f>(y, x) = {shade.color[0], shade.color[1], shade.color[2]};
          cosine = shade.cosine;
        } else {
          cosine = shader.cosine(hit, directions[i]);
        }
        view.infrared.at<float>(y, x) =
            cosine * renderer.world_.textures[face.texture].infrared();
      });
    }
  }

  bool has_edge(int column, int row) const {
    const int left = std::max(0, column * kPacketWidth - 1);
    const int right = std::min(renderer.camera_.width - 1, (column + 1) * kPacketWidth);
    const int top = std::max(0, row * kPacketHeight - 1);
    const int bottom = std::min(renderer.camera_.height - 1, (row + 1) * kPacketHeight);
    const int first = surfaces.at<int>(top, left);
    for (int y = top; y <= bottom; ++y) {
      const int* keys = surfaces.ptr<int>(y);
      for (int x = left; x <= right; ++x)
        if (keys[x] != first) return true;
    }
    return false;
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
    for (int column = 0; column < packet_columns(); ++column) {
      const float moved = motion_around(column, row);
      if (moved > kSmooth) {
        resample(column, row, many);
      } else if (moved > kSharp || has_edge(column, row)) {
        resample(column, row, few);
      }
    }
  }

  template <std::size_t N>
  void resample(int column, int row, const std::array<Eye, N>& eyes) {
    std::array<Vector3f, kPacket> directions;
    std::array<Hit, kPacket> hits;
    std::array<Vector3f, kPacket> sums;
    sums.fill(Vector3f::Zero());
    for (std::size_t s = 0; s < N; ++s) {
      cast(column, row, eyes[s], kSamples[s][0], kSamples[s][1], directions, hits);
      for (std::size_t i = 0; i < kPacket; ++i)
        if (hits[i].distance > 0) sums[i] += shader.shade(hits[i], directions[i]).color;
    }
    for_pixels(column, row, [&](std::size_t i, int x, int y) {
      const Vector3f mean = sums[i] / static_cast<float>(N);
      view.color.at<cv::Vec3f>(y, x) = {mean[0], mean[1], mean[2]};
    });
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
