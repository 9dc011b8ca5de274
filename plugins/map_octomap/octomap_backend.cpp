#include "map_octomap/octomap_backend.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace stillpoint::map_octomap {
namespace {

using semantic_octree::CostMap;
using semantic_octree::floor_of;
using semantic_octree::project;
using semantic_octree::ScanBrick;
using semantic_octree::ScanOptions;
using semantic_octree::with_colors;
using semantic_octree::write_cost_map;
using semantic_octree::write_occupancy;
using semantic_octree::write_octree;
using semantic_octree::write_point_cloud;

constexpr float kBelowThreshold = 0.01F;  // log-odds below the threshold of occupied
constexpr long kMaxMargin = 3;            // voxels: the cost grows with its third power

float log_odds(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}

OccupancyModel model_of(const OctomapBackend::Options& options) {
  const bool carves = options.model == OctomapBackend::Options::Model::kRays;
  return {.hit = log_odds(options.prob_hit),
          .miss = carves ? log_odds(options.prob_miss) : 0.0F,
          .min = log_odds(options.clamping_min),
          .max = log_odds(options.clamping_max),
          .doubt = log_odds(options.occupied_above) - log_odds(options.prob_hit) - kBelowThreshold};
}

ScanOptions scan_options_of(const OctomapBackend::Options& options) {
  return {.resolution = options.resolution,
          .range = options.range,
          .carve = options.model == OctomapBackend::Options::Model::kRays,
          .sigmas_before_surface = OctomapBackend::kSigmasBeforeSurface,
          .min_weight = static_cast<std::uint8_t>(options.min_weight),
          .margin = static_cast<int>(
              std::min(std::lround(options.margin / options.resolution), kMaxMargin))};
}

bool share_any(const std::vector<BrickKey>& some, const std::vector<BrickKey>& others) {
  for (auto a = some.begin(), b = others.begin(); a != some.end() && b != others.end();) {
    if (*a == *b) return true;
    *a < *b ? ++a : ++b;
  }
  return false;
}

void unite(std::vector<BrickKey>& all, const std::vector<BrickKey>& more) {
  std::vector<BrickKey> united;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(united));
  all = std::move(united);
}

}  // namespace

void OctomapBackend::Options::visit(OptionVisitor& v) {
  v("resolution", resolution, {.min = 0.005, .max = 1, .unit = "m", .help = "edge of a voxel"});
  v("range", range,
    {.min = 0.5, .max = 13, .unit = "m", .help = "surfaces farther from the camera are left out"});
  v.choice("model", model, {{"rays", Model::kRays}, {"hits", Model::kHits}},
           {.help = "whether rays carve free space, or only hits count (the paper, eq. 6)"});
  v("prob_hit", prob_hit,
    {.min = 0.51,
     .max = 0.99,
     .help = "occupancy probability of a voxel in which one ray ends (OctoMap's sensor model)"});
  v("prob_miss", prob_miss,
    {.min = 0.01,
     .max = 0.49,
     .help = "occupancy probability of a voxel through which one ray passes"});
  v("clamping_min", clamping_min,
    {.min = 0.001, .max = 0.49, .help = "lower clamping bound of the probability"});
  v("clamping_max", clamping_max,
    {.min = 0.7, .max = 0.999, .help = "upper clamping bound of the probability"});
  v("occupied_above", occupied_above,
    {.min = 0.01, .max = 0.99, .help = "probability from which a voxel is occupied"});
  v("tolerance", tolerance,
    {.min = 0,
     .max = 10,
     .unit = "voxels",
     .help = "a key frame is fused anew when it has moved by more than this; smaller: more exact, "
             "slower after loops"});
  v("stride", stride,
    {.min = 0,
     .max = 32,
     .unit = "px",
     .help = "every n-th pixel in each direction is used; 0: chosen by the resolution"});
  v("min_weight", min_weight,
    {.min = 0, .max = 255, .help = "least map weight of pixels that are mapped; 0: all are"});
  v("margin", margin,
    {.min = 0,
     .max = 0.1,
     .unit = "m",
     .help =
         "border around pixels that are not mapped, in which a voxel needs two hits; at most three "
         "voxels"});
  v("cost_map", cost_map, {.help = "2-D cost map for robots on the floor, saved with the map"});
  v.require(range / resolution <= 500, "range is more than 500 voxels");
  v.require(clamping_min < occupied_above && occupied_above < clamping_max,
            "occupied_above must lie between clamping_min and clamping_max");
}

OctomapBackend::OctomapBackend(const Options& options, const StageContext& context)
    : options_(options),
      log_(context.log),
      classes_(with_colors(context.classes)),
      model_(model_of(options)),
      tree_(options.resolution),
      scan_(scan_options_of(options)) {
  tree_.setOccupancyThres(options.occupied_above);
}

void OctomapBackend::integrate(const DenseKeyFrame& keyframe) {
  index_[keyframe.id] = entries_.size();
  Entry& entry = entries_.emplace_back(
      Entry{.images = StoredKeyFrame(keyframe, stride_for(*keyframe.frame->camera)),
            .world_from_camera = keyframe.world_from_camera,
            .fused_at = {},
            .bricks = {}});
  scan(entry);
  tree_.add(scan_, scan_.bricks(), model_);
}

void OctomapBackend::move(std::span<const MovedKeyFrame> moved) {
  for (const MovedKeyFrame& keyframe : moved)
    if (const auto found = index_.find(keyframe.keyframe); found != index_.end())
      entries_[found->second].world_from_camera = keyframe.world_from_camera;
  if (entries_.size() < rest_until_) return;
  std::vector<std::size_t> far;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (!is_up_to_date(entries_[i]) &&
        moved_by(entries_[i]) > options_.tolerance * options_.resolution)
      far.push_back(i);
  rest_until_ = entries_.size() + fuse_again(far) / kScansPerKeyFrame;
}

void OctomapBackend::clear() {
  tree_.clear();
  entries_.clear();
  index_.clear();
  rest_until_ = 0;
}

void OctomapBackend::save(const std::filesystem::path& directory) {
  if (entries_.empty()) {
    log_(LogLevel::kWarning, "no key frame was mapped, so there is no dense map");
    return;
  }
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (!is_up_to_date(entries_[i])) moved.push_back(i);
  fuse_again(moved);
  write_octree(tree_, classes_, directory / "map.ot");
  write_occupancy(tree_, directory / "map.bt");
  write_point_cloud(tree_, classes_, directory / "map.ply");
  save_cost_map(directory);
}

void OctomapBackend::save_cost_map(const std::filesystem::path& directory) {
  const auto floor = floor_of(tree_, options_.cost_map);
  if (!floor) {
    warn_once(
        "no floor was seen, so there is no cost map; map_backend.cost_map.floor can say where it "
        "is");
    return;
  }
  std::optional<CostMap> map;
  try {
    map = project(tree_, *floor, options_.cost_map);
  } catch (const Error& error) {  // the other files are still useful
    warn_once(error.what());
    return;
  }
  write_cost_map(*map, directory / "map");
}

// The map may be saved every few seconds.
void OctomapBackend::warn_once(const std::string& what) {
  if (warned_.insert(what).second) log_(LogLevel::kWarning, what);
}

// Neighbouring pixels are about a third of a voxel apart at the end of the range, or every pixel is
// used: with larger gaps, surfaces at grazing angles would be carved away between them.
int OctomapBackend::stride_for(const Camera& camera) const {
  if (options_.stride > 0) return options_.stride;
  const double pixel = options_.range / std::min(camera.fx, camera.fy);  // metres, at the end
  return std::max(1, static_cast<int>(options_.resolution / 3 / pixel));
}

// Scans the stored images rather than the originals, so that fusing again gives the same result.
void OctomapBackend::scan(Entry& entry) {
  entry.fused_at = entry.world_from_camera;
  scan_.scan(entry.images.unpack(entry.fused_at));
  entry.bricks.clear();
  for (const ScanBrick* brick : scan_.bricks()) entry.bricks.push_back(brick->key);
  std::sort(entry.bricks.begin(), entry.bricks.end());
}

bool OctomapBackend::is_up_to_date(const Entry& entry) {
  return entry.fused_at.matrix() == entry.world_from_camera.matrix();
}

// Upper bound of the displacement of a surface within range, in metres.
double OctomapBackend::moved_by(const Entry& entry) const {
  const Pose change = entry.fused_at.inverse() * entry.world_from_camera;
  return change.translation().norm() + options_.range * rotation_angle(change);
}

std::size_t OctomapBackend::fuse_again(std::span<const std::size_t> entries) {
  if (entries.empty()) return 0;
  std::size_t scans = entries.size();
  std::vector<BrickKey> changed;
  // These are scanned twice: the bricks that they see now must be known before anything is fused,
  // and keeping the scans would take up to a megabyte each.
  for (const std::size_t i : entries) {
    unite(changed, entries_[i].bricks);
    scan(entries_[i]);
    unite(changed, entries_[i].bricks);
  }
  tree_.remove(changed);
  std::vector<const ScanBrick*> bricks;
  for (Entry& entry : entries_) {
    if (!share_any(entry.bricks, changed)) continue;
    scan_.scan(entry.images.unpack(entry.fused_at));
    ++scans;
    bricks.clear();
    std::copy_if(scan_.bricks().begin(), scan_.bricks().end(), std::back_inserter(bricks),
                 [&](const ScanBrick* brick) {
                   return std::binary_search(changed.begin(), changed.end(), brick->key);
                 });
    tree_.add(scan_, bricks, model_);
  }
  return scans;
}

}  // namespace stillpoint::map_octomap
