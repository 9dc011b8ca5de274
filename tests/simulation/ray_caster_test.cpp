#include "simulation/ray_caster.hpp"

#include <gtest/gtest.h>

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

Hit cast_one(const RayCaster& caster, const Vector3f& origin, const Vector3f& direction,
             float moment = 0.5F, RayCaster::Targets targets = RayCaster::Targets::kAll) {
  RayPacket packet;
  packet.x.fill(direction.x());
  packet.y.fill(direction.y());
  packet.z.fill(direction.z());
  std::array<Hit, kPacket> hits;
  caster.cast(origin, packet, moment, targets, hits);
  return hits[3];
}

TEST(RayCaster, MeetsABoxWhereItIs) {
  Mesh mesh;
  add_box(mesh, Eigen::Affine3f(Eigen::Translation3f(0, 0, 3)), {1, 1, 1}, {});
  const RayCaster caster(mesh);
  EXPECT_NEAR(cast_one(caster, Vector3f::Zero(), {0.1F, 0.05F, 1}).distance, 2.5F, 1e-5F);
  EXPECT_EQ(cast_one(caster, Vector3f::Zero(), {1, 0, 1}).distance, 0);
  EXPECT_TRUE(caster.occluded(Vector3f::Zero(), {0, 0, 1}, 3));
  EXPECT_FALSE(caster.occluded(Vector3f::Zero(), {0, 0, 1}, 2));
}

TEST(RayCaster, MeetsASphereWithinItsTessellation) {
  Mesh mesh;
  add_loft(mesh, Eigen::Affine3f::Identity(), ellipsoid({0, 0, 0}, {1, 1, 1}, 65), {}, 128);
  const RayCaster caster(mesh);
  for (const float x : {0.0F, 0.3F, -0.6F}) {
    const float expected = 5 - std::sqrt(1 - x * x - 0.01F);
    EXPECT_NEAR(cast_one(caster, {x, -5, 0.1F}, {0, 1, 0}).distance, expected, 2e-3F) << x;
  }
}

TEST(RayCaster, BodiesAreWhereTheyAreAtTheMoment) {
  World world;
  Body body;
  add_box(body.mesh, Eigen::Affine3f::Identity(), {1, 1, 1}, {});
  body.world_from_body = [](double t) {
    return Eigen::Affine3d(Eigen::Translation3d(0, 3 + 2 * t, 0));
  };
  world.bodies.push_back(body);
  add_box(world.room, Eigen::Affine3f(Eigen::Translation3f(0, 20, 0)), {1, 1, 1}, {});
  RayCaster caster(world);
  caster.pose_bodies(1, 2);
  EXPECT_NEAR(cast_one(caster, Vector3f::Zero(), {0, 1, 0}, 0.0F).distance, 4.5F, 1e-5F);
  EXPECT_NEAR(cast_one(caster, Vector3f::Zero(), {0, 1, 0}, 0.5F).distance, 5.5F, 1e-5F);
  EXPECT_NEAR(cast_one(caster, Vector3f::Zero(), {0, 1, 0}, 0.75F).distance, 6.0F, 1e-5F);
  EXPECT_EQ(cast_one(caster, Vector3f::Zero(), {0, 1, 0}).body, 0);
  const Hit behind = cast_one(caster, Vector3f::Zero(), {0, 1, 0}, 0.5F, RayCaster::Targets::kRoom);
  EXPECT_EQ(behind.body, -1);
  EXPECT_NEAR(behind.distance, 19.5F, 1e-5F);
}

}  // namespace
}  // namespace stillpoint::simulation
