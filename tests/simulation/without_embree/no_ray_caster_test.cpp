// What a build without Embree says when a world is to be rendered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/ray_caster.hpp"
#include "support/error_text.hpp"

namespace stillpoint::simulation {
namespace {

TEST(WithoutEmbree, WorldsAreRefusedWithTheRemedy) {
  EXPECT_THAT(testing::error_text(Fault::kUsage, [] { RayCaster caster(Mesh{}); }),
              ::testing::HasSubstr("-DSTILLPOINT_WITH_EMBREE=ON"));
}

}  // namespace
}  // namespace stillpoint::simulation
