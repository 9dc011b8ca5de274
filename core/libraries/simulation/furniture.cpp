#include "simulation/furniture.hpp"

namespace stillpoint::simulation {

using Eigen::Vector3f;

Furnisher::Furnisher(World& world, int seed)
    : world_(world),
      painter_(100 + seed, world.album),
      wood_(texture(painter_.wood({1024, 512}, {150, 178, 200}, 0.10), 2.0F, 1.0F)),
      birch_(texture(painter_.wood({1024, 512}, {110, 165, 205}, 0.14), 1.2F, 0.6F)),
      board_(texture(painter_.plaster({1024, 1024}, {105, 140, 165}, 0.05), 1.6F, 1.6F)),
      metal_(texture(painter_.metal({512, 512}, {165, 165, 162}), 0.8F, 0.8F)),
      black_(texture(painter_.metal({256, 256}, {34, 33, 32}), 0.4F, 0.4F, 0.45F)),
      white_(texture(painter_.metal({512, 512}, {222, 224, 224}), 0.8F, 0.8F)),
      cloth_(texture(painter_.fabric({512, 512}, {120, 70, 50}, 0.2), 0.6F, 0.6F)) {}

std::uint16_t Furnisher::texture(const cv::Mat& image, float width, float height, float infrared) {
  return world_.add_texture({image, {width, height}, infrared});
}

/// The grain of two things made of the same material shall not look the same.
Skin Furnisher::skin(std::uint16_t texture, std::uint8_t label) {
  const auto shift = [&] { return static_cast<float>(painter_.uniform(0, 1000)) * 0.00313F; };
  Skin result{.texture = texture, .label = label};
  result.offset = {shift(), shift()};
  return result;
}

void Furnisher::box(const Place& place, const Vector3f& centre, const Vector3f& size,
                    const Skin& skin) {
  add_box(world_.room, pose(place) * Eigen::Translation3f(centre), size, skin);
}

/// A picture lying flat.
void Furnisher::sheet(const Place& place, float width, float height, const cv::Mat& image,
                      float lift) {
  const Eigen::Affine3f at = pose(place);
  add_panel(world_.room, at * Vector3f(-width / 2, height / 2, lift),
            at.linear() * Vector3f(width, 0, 0), at.linear() * Vector3f(0, -height, 0),
            {.texture = texture(image, width, height)});
}

void Furnisher::upright(const Place& place, const std::vector<Ring>& rings, const Skin& skin) {
  add_loft(world_.room, pose(place), rings, skin, 16);
}

void Furnisher::desk(const Place& place, float width, float depth) {
  Skin top = skin(wood_, kDiningTable);
  top.instance = world_.add_instance();
  Skin frame = skin(metal_, kDiningTable);
  frame.instance = top.instance;
  box(place, {0, 0, 0.715F}, {width, depth, 0.03F}, top);
  for (const float x : {-width / 2 + 0.05F, width / 2 - 0.05F}) {
    for (const float y : {-depth / 2 + 0.06F, depth / 2 - 0.06F})
      box(place, {x, y, 0.35F}, {0.05F, 0.05F, 0.70F}, frame);
  }
  box(place, {0, depth / 2 - 0.06F, 0.62F}, {width - 0.14F, 0.03F, 0.10F}, frame);
}

void Furnisher::chair(const Place& place) {
  Skin seat = skin(birch_, kChair);
  seat.instance = world_.add_instance();
  Skin frame = skin(metal_, kChair);
  frame.instance = seat.instance;
  box(place, {0, 0, 0.45F}, {0.42F, 0.42F, 0.025F}, seat);
  box(place, {0, 0.20F, 0.70F}, {0.42F, 0.02F, 0.26F}, seat);
  for (const float x : {-0.19F, 0.19F}) {
    box(place, {x, -0.19F, 0.22F}, {0.025F, 0.025F, 0.44F}, frame);
    box(place, {x, 0.20F, 0.38F}, {0.025F, 0.025F, 0.76F}, frame);
  }
}

void Furnisher::monitor(const Place& place, float width, bool on) {
  const float height = width * 0.66F;
  Skin frame = skin(on ? metal_ : black_, kTvMonitor);
  frame.instance = world_.add_instance();
  box(place, {0, 0, 0.008F}, {0.24F, 0.18F, 0.016F}, frame);
  box(place, {0, 0.03F, 0.08F}, {0.06F, 0.03F, 0.16F}, frame);
  box(place, {0, 0, 0.12F + height / 2}, {width, 0.05F, height}, frame);
  Skin screen = frame;
  screen.offset.setZero();
  const float w = width - 0.04F;
  const float h = height - 0.04F;
  screen.texture = texture(painter_.screen({512, 512}, on), w, h, 0.25F);
  screen.glows = on;
  const Eigen::Affine3f at = pose(place);
  add_panel(world_.room, at * Vector3f(-w / 2, -0.027F, 0.12F + height / 2 + h / 2),
            at.linear() * Vector3f(w, 0, 0), at.linear() * Vector3f(0, 0, -h), screen);
}

void Furnisher::keyboard(const Place& place) {
  box(place, {0, 0, 0.01F}, {0.44F, 0.15F, 0.02F}, skin(black_));
  sheet(place, 0.43F, 0.14F, painter_.keyboard({512, 170}), 0.022F);
  box(place, {0.30F, 0, 0.015F}, {0.06F, 0.10F, 0.03F}, skin(black_));
}

void Furnisher::bookshelf(const Place& place, float width, float height) {
  constexpr float kDepth = 0.30F;
  constexpr float kShelf = 0.36F;
  const Skin side = skin(birch_);
  for (const float x : {-width / 2, width / 2})
    box(place, {x, 0, height / 2}, {0.025F, kDepth, height}, side);
  box(place, {0, kDepth / 2, height / 2}, {width, 0.01F, height}, skin(birch_));
  const Eigen::Affine3f at = pose(place);
  for (float z = 0.05F; z + kShelf < height + 0.01F; z += kShelf) {
    box(place, {0, 0, z}, {width, kDepth, 0.025F}, skin(birch_));
    const float books = width * static_cast<float>(painter_.uniform(60, 97)) / 100;
    const cv::Size size(static_cast<int>(books * 1000), 310);
    add_panel(world_.room, at * Vector3f(-width / 2 + 0.02F, -0.08F, z + 0.32F),
              at.linear() * Vector3f(books, 0, 0), at.linear() * Vector3f(0, 0, -0.31F),
              {.texture = texture(painter_.books(size), books, 0.31F)});
  }
  box(place, {0, 0, height}, {width, kDepth, 0.025F}, skin(birch_));
}

void Furnisher::cabinet(const Place& place, const Vector3f& size) {
  box(place, {0, 0, size.z() / 2}, size, skin(white_));
  for (float z = 0.12F; z < size.z() - 0.05F; z += 0.28F)
    box(place, {0, -size.y() / 2, z}, {size.x() * 0.4F, 0.03F, 0.02F}, skin(black_));
}

void Furnisher::sofa(const Place& place) {
  Skin cover = skin(cloth_, kSofa);
  cover.instance = world_.add_instance();
  box(place, {0, 0, 0.21F}, {1.70F, 0.80F, 0.42F}, cover);
  box(place, {0, 0.32F, 0.60F}, {1.70F, 0.18F, 0.40F}, cover);
  for (const float x : {-0.78F, 0.78F}) box(place, {x, 0, 0.50F}, {0.16F, 0.80F, 0.20F}, cover);
}

void Furnisher::plant(const Place& place) {
  Skin leaf{.texture = texture(painter_.leaves({512, 512}), 0.6F, 0.6F, 0.8F),
            .label = kPottedPlant,
            .instance = world_.add_instance()};
  Skin pot = skin(texture(painter_.metal({256, 256}, {60, 85, 150}), 0.4F, 0.4F), kPottedPlant);
  pot.instance = leaf.instance;
  upright(place, {{{0, 0, 0}, 0.11F, 0.11F}, {{0, 0, 0.26F}, 0.15F, 0.15F}, {{0, 0, 0.26F}, 0, 0}},
          pot);
  for (int i = 0; i < 6; ++i) {
    const auto spread = [&] { return static_cast<float>(painter_.uniform(-18, 19)) * 0.01F; };
    const Vector3f centre(spread(), spread(), 0.5F + 0.1F * static_cast<float>(i));
    upright(place, ellipsoid(centre, {0.17F, 0.15F, 0.20F}), leaf);
  }
}

void Furnisher::bottle(const Place& place) {
  Skin glass = skin(texture(painter_.poster({256, 256}), 0.22F, 0.25F, 0.6F), kBottle);
  glass.instance = world_.add_instance();
  upright(place,
          {{{0, 0, 0}, 0, 0},
           {{0, 0, 0}, 0.034F, 0.034F},
           {{0, 0, 0.18F}, 0.034F, 0.034F},
           {{0, 0, 0.23F}, 0.013F, 0.013F},
           {{0, 0, 0.27F}, 0.013F, 0.013F},
           {{0, 0, 0.27F}, 0, 0}},
          glass);
}

void Furnisher::mug(const Place& place) {
  const Skin china{.texture = texture(painter_.ball({256, 256}), 0.25F, 0.25F)};
  upright(place,
          {{{0, 0, 0}, 0, 0},
           {{0, 0, 0}, 0.04F, 0.04F},
           {{0, 0, 0.1F}, 0.04F, 0.04F},
           {{0, 0, 0.1F}, 0.034F, 0.034F},
           {{0, 0, 0.02F}, 0.034F, 0.034F},
           {{0, 0, 0.02F}, 0, 0}},
          china);
}

void Furnisher::book_stack(const Place& place, int count) {
  float z = place.z;
  for (int i = 0; i < count; ++i) {
    const float thick = 0.02F + 0.002F * static_cast<float>(painter_.uniform(0, 12));
    const Place here{place.x, place.y, z,
                     place.turn + 0.01F * static_cast<float>(painter_.uniform(-20, 21))};
    const float w = 0.20F + 0.004F * static_cast<float>(painter_.uniform(0, 12));
    const cv::Mat cover = painter_.poster({320, 256});
    box(here, {0, 0, thick / 2}, {w, w * 0.75F, thick},
        skin(texture(painter_.books({512, 64}), 0.3F, 0.05F)));
    sheet(here, w, w * 0.75F, cover, thick + 0.001F);
    z += thick;
  }
}

void Furnisher::papers(const Place& place) {
  for (int i = 0; i < 3; ++i) {
    const auto shift = [&] { return 0.01F * static_cast<float>(painter_.uniform(-9, 10)); };
    const Place here{place.x + shift(), place.y + shift(), place.z, place.turn + 3 * shift()};
    sheet(here, 0.21F, 0.297F, painter_.paper({320, 450}), 0.002F * static_cast<float>(i + 1));
  }
}

void Furnisher::cardboard_box(const Place& place, const Vector3f& size) {
  Skin card = skin(texture(painter_.cardboard({512, 512}), size.x(), size.z()));
  card.offset.setZero();
  box(place, {0, 0, size.z() / 2}, size, card);
}

void Furnisher::poster(const Place& place, float width, float height) {
  const cv::Size size(static_cast<int>(width * 900), static_cast<int>(height * 900));
  const Eigen::Affine3f at = pose(place);
  add_panel(world_.room, at * Vector3f(-width / 2, 0, height), at.linear() * Vector3f(width, 0, 0),
            at.linear() * Vector3f(0, 0, -height),
            {.texture = texture(painter_.poster(size), width, height)});
}

void Furnisher::whiteboard(const Place& place, float width, float height) {
  box(place, {0, 0.02F, height / 2}, {width + 0.05F, 0.03F, height + 0.05F}, skin(metal_));
  const Eigen::Affine3f at = pose(place);
  add_panel(world_.room, at * Vector3f(-width / 2, 0, height), at.linear() * Vector3f(width, 0, 0),
            at.linear() * Vector3f(0, 0, -height),
            {.texture = texture(painter_.whiteboard({1024, 768}), width, height)});
}

void Furnisher::door(const Place& place) {
  box(place, {0, 0, 1.02F}, {1.02F, 0.06F, 2.04F}, skin(metal_));
  box(place, {0, -0.02F, 1.0F}, {0.90F, 0.06F, 2.0F}, skin(board_));
  box(place, {0.36F, -0.08F, 1.05F}, {0.12F, 0.03F, 0.025F}, skin(black_));
  poster({place.x - 0.052F * std::sin(-place.turn), place.y - 0.052F * std::cos(place.turn), 1.3F,
          place.turn},
         0.21F, 0.297F);
}

void Furnisher::partition(const Place& place, float width, float height) {
  box(place, {0, 0, height / 2}, {width, 0.05F, height}, skin(board_));
  box(place, {0, 0, height + 0.01F}, {width, 0.06F, 0.02F}, skin(metal_));
}

void Furnisher::scaffold(const Place& place, float width, float height) {
  for (const float x : {-width / 2, width / 2}) {
    for (const float y : {-0.3F, 0.3F})
      box(place, {x, y, height / 2}, {0.045F, 0.045F, height}, skin(metal_));
  }
  for (float z = 0.4F; z < height; z += 0.55F) {
    for (const float y : {-0.3F, 0.3F})
      box(place, {0, y, z}, {width, 0.035F, 0.035F}, skin(metal_));
  }
}

}  // namespace stillpoint::simulation
