#include "ros2_messages/message_type.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace stillpoint::ros2_messages {
namespace {

struct Definition {
  std::string_view type;
  std::string_view fields;
};

// The interfaces of ROS 2, alike from Foxy to Jazzy, but for Marker: from Humble on. Types of their
// own package are named in full.
constexpr std::array kDefinitions{
    Definition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    Definition{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/String", "string data\n"},
    Definition{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    Definition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    Definition{"geometry_msgs/Pose",
               "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    Definition{"geometry_msgs/PoseWithCovariance",
               "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/Twist",
               "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    Definition{"geometry_msgs/TwistWithCovariance",
               "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/Transform",
               "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    Definition{
        "geometry_msgs/TransformStamped",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"nav_msgs/Odometry",
               "std_msgs/Header header\nstring child_frame_id\n"
               "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n"},
    Definition{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    Definition{"nav_msgs/MapMetaData",
               "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\n"
               "uint32 height\ngeometry_msgs/Pose origin\n"},
    Definition{"nav_msgs/OccupancyGrid",
               "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    Definition{"sensor_msgs/Image",
               "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
               "uint8 is_bigendian\nuint32 step\nuint8[] data\n"},
    Definition{"sensor_msgs/CompressedImage",
               "std_msgs/Header header\nstring format\nuint8[] data\n"},
    Definition{"sensor_msgs/RegionOfInterest",
               "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    Definition{"sensor_msgs/CameraInfo",
               "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
               "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
               "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    Definition{"sensor_msgs/PointField",
               "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
               "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\n"
               "uint8 datatype\nuint32 count\n"},
    Definition{"sensor_msgs/PointCloud2",
               "std_msgs/Header header\nuint32 height\nuint32 width\n"
               "sensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\n"
               "uint32 row_step\nuint8[] data\nbool is_dense\n"},
    Definition{"octomap_msgs/Octomap",
               "std_msgs/Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data\n"},
    Definition{"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    Definition{"diagnostic_msgs/DiagnosticStatus",
               "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\n"
               "string message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
    Definition{"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    Definition{"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    Definition{"visualization_msgs/Marker",
               "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\n"
               "int32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\n"
               "int32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\n"
               "int32 TRIANGLE_LIST=11\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\n"
               "int32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\n"
               "int32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
               "std_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n"
               "bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
               "string texture_resource\nsensor_msgs/CompressedImage texture\n"
               "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
               "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
               "bool mesh_use_embedded_materials\n"}};

const Definition* find(std::string_view type) {
  const auto* found = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                                   [&](const Definition& each) { return each.type == type; });
  return found == kDefinitions.end() ? nullptr : found;
}

/// The type and all in it, each once, in the order in which they are met.
void collect(const Definition& definition, std::vector<const Definition*>& all) {
  if (std::find(all.begin(), all.end(), &definition) != all.end()) return;
  all.push_back(&definition);
  std::istringstream lines{std::string(definition.fields)};
  for (std::string line; std::getline(lines, line);)
    if (const Definition* part = find(line.substr(0, line.find_first_of(" ["))))
      collect(*part, all);
}

}  // namespace

std::string schema_name(std::string_view type) {
  const std::size_t slash = type.find('/');
  return std::string(type.substr(0, slash)) + "/msg" + std::string(type.substr(slash));
}

std::string schema_text(std::string_view type) {
  const Definition* definition = find(type);
  if (!definition) throw std::logic_error("no message type " + std::string(type));
  std::vector<const Definition*> all;
  collect(*definition, all);
  std::string text(definition->fields);
  for (std::size_t i = 1; i < all.size(); ++i) {
    text += std::string(80, '=') + "\nMSG: ";
    text += all[i]->type;
    text += '\n';
    text += all[i]->fields;
  }
  return text;
}

}  // namespace stillpoint::ros2_messages
