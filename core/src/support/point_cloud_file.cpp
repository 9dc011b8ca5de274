#include "stillpoint/support/point_cloud_file.hpp"

#include <string>

#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint {

void write_ply(std::span<const LabelledPoint> points, const ClassNames& classes,
               const std::filesystem::path& file) {
  AtomicFile out(file);
  out.stream() << "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t label = 0; label < classes.size(); ++label)
    out.stream() << "comment label " << label << ' ' << classes[label] << '\n';
  out.stream() << "element vertex " << points.size()
               << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                  "property uchar green\nproperty uchar blue\nproperty uchar label\nend_header\n";
  std::string bytes;
  bytes.reserve(16 * points.size());
  for (const LabelledPoint& point : points) {
    bytes.append(reinterpret_cast<const char*>(point.position.data()), 3 * sizeof(float));
    bytes.append(reinterpret_cast<const char*>(point.rgb.data()), point.rgb.size());
    bytes.push_back(static_cast<char>(point.label));
  }
  out.stream() << bytes;
  out.commit();
}

}  // namespace stillpoint
