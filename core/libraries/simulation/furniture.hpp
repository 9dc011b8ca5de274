// Furnishing a room piece by piece: each function adds one thing to the world's room.
#pragma once

#include <string>

#include "simulation/painting.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

/// Where something stands: the middle of its foot, and its turn about z (radians; 0 = its front
/// towards -y).
struct Place {
  float x = 0;
  float y = 0;
  float z = 0;
  float turn = 0;

  Eigen::Affine3f pose() const {
    return Eigen::Translation3f(x, y, z) * Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ());
  }
};

class Furnisher {
 public:
  Furnisher(World& world, int seed);
  /// From now on, places are relative to this; at first, to the world.
  void move_origin(const Eigen::Affine3f& world_from_origin) { origin_ = world_from_origin; }

  void desk(const Place& place, float width, float depth);
  void chair(const Place& place);
  void monitor(const Place& place, float width, bool on);
  void keyboard(const Place& place);
  void bookshelf(const Place& place, float width, float height);
  void cabinet(const Place& place, const Eigen::Vector3f& size);
  void sofa(const Place& place);
  void plant(const Place& place);
  void bottle(const Place& place);
  void mug(const Place& place);
  void book_stack(const Place& place, int count);
  void papers(const Place& place);
  void cardboard_box(const Place& place, const Eigen::Vector3f& size);
  /// A picture hanging at `place` (its lower edge), facing as a piece of furniture would.
  void poster(const Place& place, float width, float height);
  void whiteboard(const Place& place, float width, float height);
  void door(const Place& place);
  /// A plain board standing on the floor.
  void partition(const Place& place, float width, float height);
  void scaffold(const Place& place, float width, float height);

 private:
  Eigen::Affine3f pose(const Place& place) const { return origin_ * place.pose(); }
  std::uint16_t texture(const cv::Mat& image, float width, float height, float infrared = 1.0F);
  Skin skin(std::uint16_t texture, std::uint8_t label = kBackground);
  void box(const Place& place, const Eigen::Vector3f& centre, const Eigen::Vector3f& size,
           const Skin& skin);
  void sheet(const Place& place, float width, float height, const cv::Mat& image, float lift);
  void upright(const Place& place, const std::vector<Ring>& rings, const Skin& skin);

  World& world_;
  Eigen::Affine3f origin_ = Eigen::Affine3f::Identity();
  Painter painter_;
  std::uint16_t wood_;
  std::uint16_t birch_;
  std::uint16_t board_;
  std::uint16_t metal_;
  std::uint16_t black_;
  std::uint16_t white_;
  std::uint16_t cloth_;
};

}  // namespace stillpoint::simulation
