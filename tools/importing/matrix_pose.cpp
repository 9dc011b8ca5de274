#include "importing/matrix_pose.hpp"

#include <charconv>
#include <limits>
#include <sstream>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::importing {
namespace {

constexpr double kRoundedBy = 0.01;  // what writers with few digits do to a rotation

/// Infinity and NaN, too; "-1.#IND" is what programs under Windows made of them.
std::optional<double> any_number(const std::string& word) {
  if (word.find(".#") != std::string::npos) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Pose> pose_of(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (!matrix.allFinite() || !rotation.isUnitary(kRoundedBy) || rotation.determinant() < 0 ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kRoundedBy))
    return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = matrix.topRightCorner<3, 1>();
  return orthonormalised(pose);
}

std::optional<Pose> read_matrix_pose(const std::filesystem::path& file) {
  std::istringstream stream(read_input_file(file));
  Eigen::Matrix4d matrix;
  int count = 0;
  for (std::string word; stream >> word; ++count) {
    const auto value = any_number(word);
    if (!value || count == 16)
      throw Error(Fault::kData, "is no 4 x 4 matrix of numbers", file.string());
    matrix(count / 4, count % 4) = *value;
  }
  if (count != 16)
    throw Error(Fault::kData, "holds " + std::to_string(count) + " numbers instead of 16",
                file.string());
  return pose_of(matrix);
}

}  // namespace stillpoint::importing
