#include "simulation/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <cstring>

#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

constexpr unsigned kTimeSteps = 3;  // begin, middle, end: the middle is exact
constexpr float kNear = 0.02F;

template <auto Release>
struct Releaser {
  template <class T>
  void operator()(T* object) const {
    Release(object);
  }
};
using Device = std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, Releaser<rtcReleaseGeometry>>;

Scene new_scene(RTCDevice device) {
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  return scene;
}

Scene mesh_scene(RTCDevice device, const Mesh& mesh) {
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  void* vertices =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Eigen::Vector3f), mesh.vertices.size());
  void* triangles =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size());
  if (!vertices || !triangles) throw Error(Fault::kStage, "no memory for a mesh", "simulation");
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Eigen::Vector3f));
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
  rtcCommitGeometry(geometry.get());
  Scene scene = new_scene(device);
  rtcSetSceneBuildQuality(scene.get(),
                          RTC_BUILD_QUALITY_HIGH);  // built once, searched all the time
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcCommitScene(scene.get());
  return scene;
}

}  // namespace

class RayCaster::Impl {
 public:
  explicit Impl(const Mesh& room) : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (!device_) throw Error(Fault::kStage, "Embree cannot be started", "simulation");
    room_ = mesh_scene(device_.get(), room);
    moving_ = new_scene(device_.get());
  }

  void add_bodies(const std::vector<Body>& bodies) {
    for (const Body& body : bodies) {
      parts_.push_back(mesh_scene(device_.get(), body.mesh));
      RTCGeometry instance = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      instances_.emplace_back(instance);
      rtcSetGeometryInstancedScene(instance, parts_.back().get());
      rtcSetGeometryTimeStepCount(instance, kTimeSteps);
      rtcAttachGeometryByID(moving_.get(), instance, static_cast<unsigned>(bodies_.size()));
      bodies_.push_back(&body);
    }
  }

  void pose_bodies(double begin, double end) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (unsigned step = 0; step < kTimeSteps; ++step) {
        const double time = begin + (end - begin) * step / (kTimeSteps - 1);
        const Eigen::Matrix<float, 3, 4> world_from_body =
            bodies_[i]->world_from_body(time).matrix().topRows<3>().cast<float>();
        rtcSetGeometryTransform(instances_[i].get(), step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                world_from_body.data());
      }
      rtcCommitGeometry(instances_[i].get());
    }
    rtcCommitScene(moving_.get());
  }

  RTCScene room() const { return room_.get(); }
  /// Null where nothing moves.
  RTCScene moving() const { return bodies_.empty() ? nullptr : moving_.get(); }

 private:
  Device device_;
  Scene room_;
  Scene moving_;
  std::vector<Scene> parts_;
  std::vector<Geometry> instances_;
  std::vector<const Body*> bodies_;
};

RayCaster::RayCaster(const World& world) : impl_(std::make_unique<Impl>(world.room)) {
  impl_->add_bodies(world.bodies);
}

RayCaster::RayCaster(const Mesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}

RayCaster::~RayCaster() = default;

void RayCaster::pose_bodies(double begin, double end) { impl_->pose_bodies(begin, end); }

void RayCaster::cast(const Eigen::Vector3f& origin, const RayPacket& directions, float moment,
                     Targets targets, std::span<Hit, kPacket> hits) const {
  RTCRayHit8 packet;
  for (int i = 0; i < kPacket; ++i) {
    packet.ray.org_x[i] = origin.x();
    packet.ray.org_y[i] = origin.y();
    packet.ray.org_z[i] = origin.z();
    packet.ray.tnear[i] = kNear;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = moment;
    packet.ray.mask[i] = ~0U;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  std::memcpy(packet.ray.dir_x, directions.x.data(), sizeof(packet.ray.dir_x));
  std::memcpy(packet.ray.dir_y, directions.y.data(), sizeof(packet.ray.dir_y));
  std::memcpy(packet.ray.dir_z, directions.z.data(), sizeof(packet.ray.dir_z));
  alignas(32) static constexpr std::array<int, kPacket> kAll = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(kAll.data(), impl_->room(), &context, &packet);
  if (targets == Targets::kAll && impl_->moving())
    rtcIntersect8(kAll.data(), impl_->moving(), &context, &packet);
  for (std::size_t i = 0; i < kPacket; ++i) {
    const bool nothing = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID;
    hits[i] = nothing ? Hit{}
                      : Hit{packet.ray.tfar[i], static_cast<int>(packet.hit.instID[0][i]),
                            packet.hit.primID[i], packet.hit.u[i], packet.hit.v[i]};
  }
}

bool RayCaster::occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float reach) const {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = reach;
  ray.mask = ~0U;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->room(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace stillpoint::simulation
