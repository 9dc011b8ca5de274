// Instead of ray_caster.cpp, in builds without Embree.
#include "simulation/ray_caster.hpp"

#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

[[noreturn]] void refuse() {
  throw Error(Fault::kUsage, "this build cannot render worlds", "simulation",
              "configure it with -DSTILLPOINT_WITH_EMBREE=ON");
}

}  // namespace

class RayCaster::Impl {};

RayCaster::RayCaster(const World&) { refuse(); }
RayCaster::RayCaster(const Mesh&) { refuse(); }
RayCaster::~RayCaster() = default;
void RayCaster::pose_bodies(double, double) { refuse(); }
void RayCaster::cast(const Eigen::Vector3f&, const RayPacket&, float, Targets,
                     std::span<Hit, kPacket>) const {
  refuse();
}
bool RayCaster::occluded(const Eigen::Vector3f&, const Eigen::Vector3f&, float) const { refuse(); }

}  // namespace stillpoint::simulation
