#include "inspection/recording_audit.hpp"

#include "inspection/audit_warnings.hpp"
#include "tum_recording/image_reader.hpp"

namespace stillpoint::inspection {
namespace {

using tum_recording::ImageReader;
using tum_recording::open_recording;
using tum_recording::StampedImage;

std::string ending_of(const std::filesystem::path& file) {
  return file.extension().string().substr(file.has_extension() ? 1 : 0);
}

std::vector<double> times_of(const std::vector<StampedImage>& images) {
  std::vector<double> times;
  for (const StampedImage& image : images) times.push_back(image.time);
  return times;
}

std::vector<PairStamps> stamps_of(const std::vector<ImagePair>& pairs) {
  std::vector<PairStamps> stamps;
  for (const ImagePair& pair : pairs) stamps.push_back({pair.color.time, pair.depth.time});
  return stamps;
}

}  // namespace

RecordingAudit audit_recording(const std::filesystem::path& folder, const AuditOptions& options) {
  RecordingAudit audit;
  audit.recording = open_recording(folder, options.pairing);
  audit.camera = options.camera;
  if (audit.camera) audit.depth_factor = audit.camera->depth_factor;
  const Recording& recording = audit.recording;
  const std::vector<PairStamps> pairs = stamps_of(recording.pairs);
  audit_stamps(times_of(recording.color), times_of(recording.depth), pairs, audit);
  ImageReader reader;
  const auto color = [&](std::size_t i) {
    const auto& file = recording.pairs[i].color.file;
    return RecordedImage{reader.color(file), ending_of(file)};
  };
  const auto depth = [&](std::size_t i) {
    const auto& file = recording.pairs[i].depth.file;
    return RecordedImage{reader.depth(file), ending_of(file)};
  };
  audit_images(pairs, {color, depth}, options.samples, audit);
  if (!recording.ground_truth.empty())
    audit.truth = audit_truth(recording.ground_truth, recording.pairs);
  audit.warnings = audit_warnings(audit, options.pairing);
  return audit;
}

}  // namespace stillpoint::inspection
