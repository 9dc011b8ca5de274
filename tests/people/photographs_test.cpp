#include "people/photographs.hpp"

#include <gtest/gtest.h>

#include "small_base.hpp"
#include "support/image_io.hpp"

namespace stillpoint::people {
namespace {

TEST(Photographs, EveryTenthIsForMeasuring) {
  const testing::TemporaryFolder folder;
  for (int i = 0; i < 25; ++i) folder.write(std::to_string(100 + i) + ".webp", "");
  folder.write("100.png", "");
  const auto held_out = held_out_images(folder.path());
  ASSERT_EQ(held_out.size(), 3U);
  EXPECT_EQ(held_out[1].filename(), "110.webp");
  EXPECT_EQ(held_out[2].filename(), "120.webp");
}

TEST(Photographs, OnlyWholePeopleOfSomeSize) {
  const testing::TemporaryFolder folder;
  const PersonPhoto whole = write_person(folder);
  EXPECT_EQ(held_out_people({folder.path()}).size(), 1U);
  cv::Mat mask = testing::read_image(whole.mask, cv::IMREAD_GRAYSCALE);
  cv::Mat cut = mask.clone();
  cut.rowRange(0, 200).setTo(0);
  testing::write_image(whole.mask, cut);
  EXPECT_TRUE(held_out_people({folder.path()}).empty()) << "too small";
  mask.rowRange(170, 185).setTo(0);
  testing::write_image(whole.mask, mask);
  EXPECT_TRUE(held_out_people({folder.path()}).empty()) << "two pieces";
}

TEST(Photographs, EverybodyIsSomebodyElse) {
  std::vector<PersonPhoto> photos(6);
  for (std::size_t i = 0; i < photos.size(); ++i) {
    photos[i].image = std::to_string(i);
    photos[i].brightness = i < 3 ? 30 : 120;
  }
  using Clothes = PersonPlan::Clothes;
  const std::vector<PersonPlan> plans = {
      {.clothes = Clothes::kDark}, {.clothes = Clothes::kDark}, {.photo = "named"}, {}};
  const auto drawn = draw_people(photos, plans, 4);
  ASSERT_EQ(drawn.size(), 3U);
  EXPECT_EQ(drawn[0].brightness, 30);
  EXPECT_EQ(drawn[1].brightness, 30);
  EXPECT_NE(drawn[0].image, drawn[1].image);
  EXPECT_EQ(draw_people(photos, plans, 4)[0].image, drawn[0].image);
  EXPECT_THROW(draw_people({}, plans, 4), Error);
}

}  // namespace
}  // namespace stillpoint::people
