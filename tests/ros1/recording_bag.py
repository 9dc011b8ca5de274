"""A recording of the TUM format as a bag, and its truth."""
import pathlib

import numpy
import PIL.Image
import rosbag
import rospy
from sensor_msgs.msg import CameraInfo, Image

CAMERA_FRAME = "camera_color_optical_frame"
CAMERA = "/camera"


def stamp_of(text, offset=0.0):
    whole, fraction = text.split(".")
    return rospy.Time(int(whole), int(fraction.ljust(9, "0"))) + rospy.Duration(offset)


def lines_of(file):
    return [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]


def image_message(pixels, encoding, stamp):
    message = Image()
    message.header.stamp, message.header.frame_id = stamp, CAMERA_FRAME
    message.height, message.width = pixels.shape[:2]
    message.encoding, message.step, message.data = encoding, pixels.strides[0], pixels.tobytes()
    return message


def info_message(camera, stamp):
    info = CameraInfo()
    info.header.stamp, info.header.frame_id = stamp, CAMERA_FRAME
    info.width, info.height, info.distortion_model, info.D = camera["width"], camera["height"], "plumb_bob", [0.0] * 5
    info.K = [camera["fx"], 0, camera["cx"], 0, camera["fy"], camera["cy"], 0, 0, 1]
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = [camera["fx"], 0, camera["cx"], 0, 0, camera["fy"], camera["cy"], 0, 0, 0, 1, 0]
    return info


def camera_of(recording):
    words = [line.split("#")[0].split(":") for line in (recording / "camera.yaml").read_text().splitlines()]
    text = {word[0].strip(): word[1].strip() for word in words if len(word) == 2}
    return {key: float(text[key]) for key in ("fx", "fy", "cx", "cy")} | {
        key: int(text[key]) for key in ("width", "height")}


def write_bag(recording, file, metres=False, offset=0.0, depth_offset=0.0):
    """rgb8, and 16UC1 with the recording's values or 32FC1 in metres. Stamps are `offset` seconds later than in the
    recording, those of depth another `depth_offset`. Returns the first one of the recording."""
    camera = camera_of(recording)
    with rosbag.Bag(str(file), "w") as bag:
        for (time, color), (_, depth) in zip(lines_of(recording / "rgb.txt"), lines_of(recording / "depth.txt")):
            stamp, depth_stamp = stamp_of(time, offset), stamp_of(time, offset + depth_offset)
            values = numpy.asarray(PIL.Image.open(recording / depth)).astype(numpy.uint16)
            depth_pixels = values / numpy.float32(5000) if metres else values
            rgb = numpy.asarray(PIL.Image.open(recording / color).convert("RGB"))
            bag.write(CAMERA + "/color/camera_info", info_message(camera, stamp), stamp)
            bag.write(CAMERA + "/color/image_raw", image_message(rgb, "rgb8", stamp), stamp)
            bag.write(CAMERA + "/aligned_depth_to_color/image_raw",
                      image_message(depth_pixels, "32FC1" if metres else "16UC1", depth_stamp), depth_stamp)
    return float(lines_of(recording / "rgb.txt")[0][0])


def matrix(translation, quaternion):
    """4 x 4, of x, y, z and x, y, z, w."""
    x, y, z, w = numpy.array(quaternion) / numpy.linalg.norm(quaternion)
    pose = numpy.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = translation
    return pose


class Truth:
    """The pose of the camera in the room, whose floor is z = 0."""

    def __init__(self, recording):
        rows = numpy.array(lines_of(pathlib.Path(recording) / "groundtruth.txt"), dtype=float)
        self.times, self.rows = rows[:, 0], rows[:, 1:]

    def room_from_camera(self, seconds):
        row = self.rows[numpy.abs(self.times - seconds).argmin()]  # one every 10 ms
        return matrix(row[:3], row[3:])
