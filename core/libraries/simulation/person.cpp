#include "simulation/person.hpp"

#include <memory>

#include "simulation/painting.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Affine3f;
using Eigen::Translation3f;
using Eigen::Vector3f;

struct Clothes {
  Skin shirt;
  Skin trousers;
  Skin face;
  Skin arms;
  Skin shoes;
};

Clothes dress(World& world, const PersonOptions& options) {
  Painter painter(1000 + options.seed);
  const auto tone = [&] {
    return cv::Scalar(painter.uniform(40, 190), painter.uniform(40, 190), painter.uniform(40, 190));
  };
  const cv::Scalar shirt_color = tone();
  cv::Mat shirt = options.shirt == "plaid"     ? painter.plaid({512, 512}, shirt_color)
                  : options.shirt == "striped" ? painter.stripes({512, 512}, shirt_color)
                                               : painter.fabric({512, 512}, shirt_color, 0.2);
  const Skin skin{.label = kPerson, .instance = world.add_instance()};
  const auto worn = [&](const cv::Mat& image, Eigen::Vector2f size) {
    Skin result = skin;
    result.texture = world.add_texture({image, size});
    return result;
  };
  const double dark = painter.uniform(40, 110);
  return {.shirt = worn(shirt, {0.6F, 0.6F}),
          .trousers =
              worn(painter.fabric({512, 512}, {dark * 1.3, dark, dark * 0.8}, 0.22), {0.6F, 0.6F}),
          // As large as the skin over the head: see ellipsoid() in body_mesh.
          .face = worn(painter.face({512, 512}), {0.69F, 0.345F}),
          .arms = worn(painter.fabric({256, 256}, {120, 150, 205}, 0.06), {0.3F, 0.3F}),
          .shoes = worn(painter.fabric({256, 256}, {40, 42, 48}, 0.3), {0.3F, 0.3F})};
}

void add_torso(Mesh& mesh, float h, const Skin& skin) {
  const auto ring = [&](float z, float x, float y) { return Ring{{0, 0, z * h}, x * h, y * h}; };
  add_loft(mesh, Affine3f::Identity(),
           {ring(-0.03F, 0, 0), ring(-0.03F, 0.062F, 0.092F), ring(0.04F, 0.060F, 0.086F),
            ring(0.12F, 0.062F, 0.090F), ring(0.19F, 0.067F, 0.102F), ring(0.235F, 0.062F, 0.112F),
            ring(0.262F, 0.050F, 0.098F), ring(0.280F, 0.036F, 0.050F), ring(0.288F, 0, 0)},
           skin, 28);
}

void add_foot(Mesh& mesh, float h, const Skin& skin) {
  const Affine3f pose = Translation3f(0.035F * h, 0, -0.045F * h) * Affine3f::Identity();
  add_loft(mesh, pose,
           {{{0, 0, 0}, 0, 0},
            {{0, 0, 0}, 0.075F * h, 0.027F * h},
            {{-0.004F * h, 0, 0.015F * h}, 0.072F * h, 0.027F * h},
            {{-0.018F * h, 0, 0.032F * h}, 0.050F * h, 0.024F * h},
            {{-0.030F * h, 0, 0.052F * h}, 0.026F * h, 0.023F * h},
            {{-0.030F * h, 0, 0.052F * h}, 0, 0}},
           skin);
}

Mesh part_mesh(int part, float h, const Clothes& clothes) {
  Mesh mesh;
  const Affine3f origin = Affine3f::Identity();
  const auto add_limb = [&](float length, float top, float middle, float bottom, const Skin& skin) {
    add_loft(mesh, origin, limb(length * h, top * h, middle * h, bottom * h), skin);
  };
  switch (part) {
    case kPelvis:
      add_loft(mesh, origin, ellipsoid({0, 0, 0.005F * h}, {0.066F * h, 0.097F * h, 0.062F * h}),
               clothes.trousers, 24);
      break;
    case kTorso:
      add_torso(mesh, h, clothes.shirt);
      break;
    case kHead:
      add_loft(mesh, origin, limb(0.06F * h, 0.03F * h, 0.031F * h, 0.034F * h), clothes.face);
      add_loft(mesh, origin, ellipsoid({0.012F * h, 0, 0.062F * h}, {0.11F, 0.08F, 0.125F}, 21),
               clothes.face, 32);
      break;
    case kLeftThigh:
    case kRightThigh:
      add_limb(0.245F, 0.047F, 0.045F, 0.032F, clothes.trousers);
      break;
    case kLeftShin:
    case kRightShin:
      add_limb(0.246F, 0.033F, 0.034F, 0.022F, clothes.trousers);
      break;
    case kLeftFoot:
    case kRightFoot:
      add_foot(mesh, h, clothes.shoes);
      break;
    case kLeftUpperArm:
    case kRightUpperArm:
      add_limb(0.172F, 0.031F, 0.029F, 0.024F, clothes.shirt);
      break;
    case kLeftForearm:
    case kRightForearm: {
      add_limb(0.146F, 0.025F, 0.024F, 0.018F, clothes.arms);
      const Affine3f hand = Translation3f(0, 0, -0.19F * h) * Affine3f::Identity();
      add_loft(mesh, hand, ellipsoid({0, 0, 0}, {0.022F * h, 0.013F * h, 0.05F * h}), clothes.arms);
      break;
    }
    default:
      break;
  }
  return mesh;
}

Mesh box_mesh(World& world) {
  const Skin skin{.texture = world.add_texture({Painter(77).cardboard({512, 512}), {0.42F, 0.30F}}),
                  .instance = world.add_instance()};
  Mesh mesh;
  add_box(mesh, Affine3f::Identity(), {0.30F, 0.42F, 0.30F}, skin);
  return mesh;
}

}  // namespace

void add_person(World& world, const PersonOptions& options) {
  const auto motion =
      std::make_shared<const std::function<PersonPose(double)>>(person_motion(options));
  const Clothes clothes = dress(world, options);
  for (int part = 0; part < kPersonParts; ++part) {
    if (part == kCarriedBox && !options.carries_box) continue;
    world.bodies.push_back(
        {part == kCarriedBox ? box_mesh(world)
                             : part_mesh(part, static_cast<float>(options.height), clothes),
         [motion, part](double time) { return (*motion)(time)[static_cast<std::size_t>(part)]; }});
  }
}

}  // namespace stillpoint::simulation
