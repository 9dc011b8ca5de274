#include "simulation/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>

#include "simulation/out_of_memory.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

constexpr unsigned kTimeSteps = 3;  // begin, middle, end
constexpr float kMiddle = 0.5F;
// For images, flags are left out that cost 5 % of a frame: one ray in nine million slips between
// triangles, far fewer than a depth camera loses. Light is baked along walls and into corners.
constexpr RTCSceneFlags kForImages = RTC_SCENE_FLAG_NONE;
constexpr RTCSceneFlags kForLight = RTC_SCENE_FLAG_ROBUST;
constexpr float kFirstHit = 0.02F;  // metres from the camera

// Bytes of address space. Without them, Embree and its scheduler may end the process, or fail and
// wait for ever later on: 144 MiB were needed to begin with a small mesh.
constexpr std::size_t kToStart = std::size_t{160} << 20;
constexpr std::size_t kPerTriangle = 1024;
constexpr std::size_t kPerScene = std::size_t{4} << 20;

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

/// Embree keeps the first error of a thread until it is asked for.
void require_no_error(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return;
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(Fault::kStage,
              "Embree failed, with its error " + std::to_string(static_cast<int>(code)),
              "simulation");
}

RTCDevice new_device() {
  // After a failed start, Embree waits for ever where a device is released.
  static std::atomic<bool> has_failed = false;
  if (has_failed) throw Error(Fault::kStage, "Embree cannot be started again", "simulation");
  require_memory(kToStart);
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  if (device) return device;
  has_failed = true;
  require_no_error(nullptr);
  throw Error(Fault::kStage, "Embree cannot be started", "simulation");
}

Scene mesh_scene(RTCDevice device, const Mesh& mesh, RTCSceneFlags flags) {
  require_memory(kPerScene + kPerTriangle * mesh.triangles.size());
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  void* vertices =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Eigen::Vector3f), mesh.vertices.size());
  void* triangles =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size());
  if (!vertices || !triangles) throw std::bad_alloc();
  std::ranges::copy(mesh.vertices, static_cast<Eigen::Vector3f*>(vertices));
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
  rtcCommitGeometry(geometry.get());
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), flags);
  rtcSetSceneBuildQuality(scene.get(),
                          RTC_BUILD_QUALITY_HIGH);  // built once, searched all the time
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcCommitScene(scene.get());
  require_no_error(device);
  return scene;
}

}  // namespace

/// Bodies as instances of their meshes, each where it is at `steps` moments.
class BodyScene {
 public:
  BodyScene(RTCDevice device, unsigned steps)
      : device_(device), steps_(steps), scene_(rtcNewScene(device)) {}

  void add(RTCScene mesh) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, mesh);
    rtcSetGeometryTimeStepCount(instance, steps_);
    rtcAttachGeometryByID(scene_.get(), instance, static_cast<unsigned>(instances_.size()));
    instances_.emplace_back(instance);
  }

  /// The moments are spread evenly from `begin` to `end`, one alone lies in the middle.
  void pose(const std::vector<const Body*>& bodies, double begin, double end) {
    require_memory(kPerScene);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (unsigned step = 0; step < steps_; ++step) {
        const double share = steps_ == 1 ? kMiddle : static_cast<double>(step) / (steps_ - 1);
        const Eigen::Matrix<float, 3, 4> world_from_body =
            bodies[i]
                ->world_from_body(begin + (end - begin) * share)
                .matrix()
                .topRows<3>()
                .cast<float>();
        rtcSetGeometryTransform(instances_[i].get(), step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                world_from_body.data());
      }
      rtcCommitGeometry(instances_[i].get());
    }
    rtcCommitScene(scene_.get());
    require_no_error(device_);
  }

  RTCScene get() const { return scene_.get(); }

 private:
  RTCDevice device_;
  unsigned steps_;
  Scene scene_;
  std::vector<Geometry> instances_;
};

class RayCaster::Impl {
 public:
  Impl(const Mesh& room, RTCSceneFlags flags)
      : device_(new_device()), room_(mesh_scene(device_.get(), room, flags)) {}

  void add_bodies(const std::vector<Body>& bodies) {
    for (const Body& body : bodies) {
      parts_.push_back(mesh_scene(device_.get(), body.mesh, kForImages));
      moving_.add(parts_.back().get());
      still_.add(parts_.back().get());
      bodies_.push_back(&body);
    }
  }

  void pose_bodies(double begin, double end) {
    moving_.pose(bodies_, begin, end);
    still_.pose(bodies_, begin, end);
  }

  RTCScene room() const { return room_.get(); }
  /// Null where nothing moves.
  RTCScene bodies(float moment) const {
    if (bodies_.empty()) return nullptr;
    return moment == kMiddle ? still_.get() : moving_.get();
  }

 private:
  Device device_;
  Scene room_;
  std::vector<Scene> parts_;
  std::vector<const Body*> bodies_;
  BodyScene moving_{device_.get(), kTimeSteps};
  BodyScene still_{device_.get(), 1};  // in the middle: most rays, and these are faster
};

RayCaster::RayCaster(const World& world) try
    : impl_(std::make_unique<Impl>(world.room, kForImages)) {
  impl_->add_bodies(world.bodies);
} catch (...) {
  rethrow_named();
}

RayCaster::RayCaster(const Mesh& mesh) try : impl_(std::make_unique<Impl>(mesh, kForLight)) {
} catch (...) {
  rethrow_named();
}

RayCaster::~RayCaster() = default;

void RayCaster::pose_bodies(double begin, double end) { impl_->pose_bodies(begin, end); }

void RayCaster::cast(const Eigen::Vector3f& origin, const RayPacket& directions, float moment,
                     Targets targets, std::span<Hit, kPacket> hits) const {
  RTCRayHit8 packet;
  for (int i = 0; i < kPacket; ++i) {
    packet.ray.org_x[i] = origin.x();
    packet.ray.org_y[i] = origin.y();
    packet.ray.org_z[i] = origin.z();
    packet.ray.tnear[i] = kFirstHit;
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
  if (RTCScene bodies = impl_->bodies(moment); bodies && targets == Targets::kAll)
    rtcIntersect8(kAll.data(), bodies, &context, &packet);
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
