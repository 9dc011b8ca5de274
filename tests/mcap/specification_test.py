#!/usr/bin/env python3
"""specification_test.py PROGRAM FOLDER: records a small simulated scene, runs the recording, and compares what is in
the MCAP files with the other files of the same run. The MCAP files stay in the folder, for foreign_reader_test.py."""
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

from read_mcap import Mcap

PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
FRAMES = 24
SCENE = f"""version: 1
source: {{type: simulation, frames: {FRAMES}, people: [], balls: []}}
camera: {{name: small, width: 320, height: 240, fx: 267.7, fy: 269.6, cx: 159.8, cy: 123.6, depth_factor: 5000}}
"""
RECORDED = f"version: 1\nsource: {{type: tum_rgbd, path: {FOLDER / 'recording'}}}\n"
CAMERA = "--camera", FOLDER / "recording/camera.yaml"
RUN = RECORDED + """tracker: {type: orb}
local_mapper: {type: orb}
map_backend: {type: octomap, cost_map: {floor: [0, -1, 0, -1]}}
outputs:
  - {type: trajectory}
  - {type: keyframes}
  - {type: mcap, file: zstd.mcap, images: true}
  - {type: mcap, file: lz4.mcap, compression: lz4}
  - {type: mcap, file: none.mcap, compression: none}
  - {type: mcap, file: often.mcap, map_period: 0.19}
runtime: {mode: inline}
"""
FULL = """tracker: {type: orb}
local_mapper: {type: orb}
outputs:
  - {type: mcap, file: full.mcap}
  - {type: trajectory}
"""


def stillpoint(*arguments, exit_code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != exit_code:
        raise RuntimeError(f"stillpoint {arguments[0]} ended with {done.returncode}: {done.stderr}")
    return done


def mcap(name):
    return Mcap((FOLDER / name).read_bytes())


def poses_of_file(name):
    """Time and x, y, z, qx, qy, qz, qw, in Stillpoint's world: x right, y down, z forward."""
    lines = (FOLDER / "run" / name).read_text().splitlines()
    return [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]


def seconds(stamp):
    return stamp["sec"] + 1e-9 * stamp["nanosec"]


def rotated(quaternion, vector):
    x, y, z, w = (quaternion[key] for key in "xyzw")
    t = [2 * c for c in cross((x, y, z), vector)]
    return [v + w * a + b for v, a, b in zip(vector, t, cross((x, y, z), t))]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def png(file):
    """(width, height, bits, rows of bytes) of a PNG file whose rows have the filter Sub."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        content = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack_from(">IIBB", content)
        elif kind == b"IDAT":
            packed += content
        at += 12 + length
    step = bits // 8 * (3 if color == 2 else 1)
    raw, rows = zlib.decompress(packed), []
    for y in range(height):
        row = bytearray(raw[y * (step * width + 1) + 1:(y + 1) * (step * width + 1)])
        assert raw[y * (step * width + 1)] == 1
        for i in range(step, len(row)):
            row[i] = (row[i] + row[i - step]) & 255
        rows.append(bytes(row))
    return width, height, bits, rows


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.file = mcap("run/zstd.mcap")
        cls.messages = cls.file.messages

    def test_topics_have_the_types_of_ros_2(self):
        self.assertEqual(self.file.profile, "ros2")
        self.assertEqual({topic: schema.name for topic, schema in self.file.channels.values()},
                         {"/tf": "tf2_msgs/msg/TFMessage", "/odometry": "nav_msgs/msg/Odometry",
                          "/tracking_state": "std_msgs/msg/String", "/keyframe": "geometry_msgs/msg/PoseStamped",
                          "/path": "nav_msgs/msg/Path", "/keyframes": "nav_msgs/msg/Path",
                          "/landmarks": "sensor_msgs/msg/PointCloud2", "/dense_map": "sensor_msgs/msg/PointCloud2",
                          "/voxels": "visualization_msgs/msg/Marker",
                          "/cost_map": "nav_msgs/msg/OccupancyGrid",
                          "/camera/color/image_raw/compressed": "sensor_msgs/msg/CompressedImage",
                          "/camera/color/camera_info": "sensor_msgs/msg/CameraInfo"})
        self.assertEqual(set(self.messages), {topic for topic, _ in self.file.channels.values()})

    def test_every_compression_holds_the_same(self):
        lz4, none = mcap("run/lz4.mcap"), mcap("run/none.mcap")
        self.assertEqual(lz4.messages, none.messages)
        self.assertEqual([f.chunks[0]["compression"] for f in (self.file, lz4, none)], ["zstd", "lz4", ""])
        for topic, messages in lz4.messages.items():
            self.assertEqual(messages, self.messages[topic], topic)

    def test_paths_are_the_files_of_poses_with_z_up(self):
        for topic, name in ("/path", "trajectory.txt"), ("/keyframes", "keyframes.txt"):
            (_, path), = self.messages[topic]
            poses = poses_of_file(name)
            self.assertEqual(len(path["poses"]), len(poses))
            self.assertEqual(path["header"]["frame_id"], "map")
            for got, (time, x, y, z, *_) in zip(path["poses"], poses):
                self.assertEqual(got["header"]["frame_id"], "map")
                self.assertAlmostEqual(seconds(got["header"]["stamp"]), time, 6)
                position = got["pose"]["position"]
                for value, expected in zip((position[key] for key in "xyz"), (z, -x, -y)):
                    self.assertAlmostEqual(value, expected, 6)

    def test_the_first_camera_looks_along_x(self):
        time, transforms = self.messages["/tf"][0]
        transform, = transforms["transforms"]
        self.assertEqual((transform["header"]["frame_id"], transform["child_frame_id"]),
                         ("map", "camera_color_optical_frame"))
        self.assertEqual(round(1e9 * seconds(transform["header"]["stamp"]) - time, -3), 0)
        for in_camera, in_map in ((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, -1, 0)), ((0, 1, 0), (0, 0, -1)):
            for got, expected in zip(rotated(transform["transform"]["rotation"], in_camera), in_map):
                self.assertAlmostEqual(got, expected, 9)

    def test_odometry_follows_the_camera(self):
        odometry = [message for _, message in self.messages["/odometry"]]
        self.assertEqual(len(odometry), FRAMES)
        self.assertEqual([message["data"] for _, message in self.messages["/tracking_state"]], ["tracking"] * FRAMES)
        for (_, tf), message in zip(self.messages["/tf"], odometry):
            pose, transform = message["pose"]["pose"], tf["transforms"][0]["transform"]
            self.assertEqual((pose["position"], pose["orientation"]), (transform["translation"], transform["rotation"]))
        for before, after in zip(odometry, odometry[1:]):
            dt = seconds(after["header"]["stamp"]) - seconds(before["header"]["stamp"])
            linear = after["twist"]["twist"]["linear"]
            moved = rotated(before["pose"]["pose"]["orientation"], [linear[key] * dt for key in "xyz"])
            for key, step in zip("xyz", moved):
                got = after["pose"]["pose"]["position"][key] - before["pose"]["pose"]["position"][key]
                self.assertAlmostEqual(got, step, 3)

    def test_images_have_their_camera(self):
        images, cameras = (self.messages["/camera/color/" + name] for name in ("image_raw/compressed", "camera_info"))
        self.assertEqual([time for time, _ in images], [time for time, _ in cameras])
        self.assertEqual(len(images), FRAMES)
        image, camera = images[0][1], cameras[0][1]
        self.assertEqual((image["format"], image["data"][:2], image["data"][-2:]), ("jpeg", b"\xff\xd8", b"\xff\xd9"))
        self.assertEqual(camera["k"], [267.7, 0, 159.8, 0, 269.6, 123.6, 0, 0, 1])
        self.assertEqual(camera["p"], [267.7, 0, 159.8, 0, 0, 269.6, 123.6, 0, 0, 0, 1, 0])
        self.assertEqual((camera["width"], camera["height"], camera["d"]), (320, 240, [0] * 5))

    def test_the_dense_map_is_that_of_its_file(self):
        data = (FOLDER / "run/map/map.ply").read_bytes()
        begin = data.index(b"end_header\n") + 11
        points = {tuple(round(v, 4) for v in (z, -x, -y)) + (r, g, b, label)
                  for x, y, z, r, g, b, label in struct.iter_unpack("<fffBBBB", data[begin:])}
        (_, cloud), = self.messages["/dense_map"]
        self.assertEqual([(f["name"], f["offset"], f["datatype"], f["count"]) for f in cloud["fields"]],
                         [("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("rgb", 12, 7, 1), ("label", 16, 2, 1)])
        self.assertEqual((cloud["point_step"], cloud["height"]), (17, 1))
        self.assertEqual(len(cloud["data"]), 17 * cloud["width"])
        got = {tuple(round(v, 4) for v in (x, y, z)) + (r, g, b, label)
               for x, y, z, b, g, r, _, label in struct.iter_unpack("<fffBBBBB", cloud["data"])}
        self.assertEqual(got, points)
        self.assertGreater(len(points), 100)

    def test_voxels_are_the_points_of_the_dense_map_as_cubes(self):
        (_, cloud), = self.messages["/dense_map"]
        points = sorted((round(x, 4), round(y, 4), round(z, 4), r, g, b)
                        for x, y, z, b, g, r, _, _ in struct.iter_unpack("<fffBBBBB", cloud["data"]))
        (_, marker), = self.messages["/voxels"]
        self.assertEqual((marker["header"], marker["type"], marker["action"]), (cloud["header"], 6, 0))  # CUBE_LIST, ADD
        self.assertEqual((marker["pose"]["orientation"]["w"], set(marker["scale"].values()), marker["color"]["a"]),
                         (1, {0.05}, 1))
        cubes = sorted((round(at["x"], 4), round(at["y"], 4), round(at["z"], 4),
                        *(round(255 * color[key]) for key in "rgb"))
                       for at, color in zip(marker["points"], marker["colors"]))
        self.assertEqual(cubes, points)
        self.assertEqual(len(marker["colors"]), len(points))

    def test_the_cost_map_is_that_of_its_file(self):
        (_, grid), = self.messages["/cost_map"]
        header, pixels = (FOLDER / "run/map/map.pgm").read_bytes().split(b"\n255\n", 1)
        width, height = map(int, header.split()[1:])
        info = grid["info"]
        self.assertEqual((info["width"], info["height"]), (width, height))
        self.assertAlmostEqual(info["resolution"], 0.05, 6)
        values = {0: 100, 205: 255, 254: 0}  # 255: -1 as a byte
        rows = [pixels[y * width:(y + 1) * width] for y in reversed(range(height))]
        self.assertEqual(grid["data"], bytes(values[pixel] for row in rows for pixel in row))
        self.assertIn(100, grid["data"])
        self.assertAlmostEqual(info["origin"]["position"]["z"], -1, 6)  # the floor, a metre below the camera
        for got, expected in zip(rotated(info["origin"]["orientation"], (0, 0, 1)), (0, 0, 1)):
            self.assertAlmostEqual(got, expected, 6)

    def test_landmarks_lie_around_the_camera(self):
        (_, cloud), = self.messages["/landmarks"]
        points = list(struct.iter_unpack("<fff", cloud["data"]))
        self.assertEqual(len(points), cloud["width"])
        self.assertGreater(len(points), 100)
        self.assertGreater(sorted(x for x, _, _ in points)[len(points) // 2], 0.5)  # in front of it

    def test_the_map_grows_while_the_run_goes(self):
        messages = mcap("run/often.mcap").messages
        begin = messages["/tf"][0][0]
        sizes = {"/keyframes": lambda path: len(path["poses"]), "/landmarks": lambda cloud: cloud["width"],
                 "/dense_map": lambda cloud: cloud["width"]}
        for topic, size in sizes.items():
            times = [round(1e-9 * (time - begin), 2) for time, _ in messages[topic]]
            self.assertEqual(times, [0.2, 0.4, 0.6, 0.77], topic)  # and at the end
            self.assertGreater(size(messages[topic][-1][1]), size(messages[topic][0][1]), topic)
            self.assertEqual(messages[topic][-1], self.messages[topic][-1], topic)

    def test_a_torn_file_has_all_of_its_whole_chunks(self):
        data = (FOLDER / "run/zstd.mcap").read_bytes()
        ends = [chunk["at"] + chunk["length"] for chunk in self.file.chunks]
        for cut in (ends[0], ends[0] + 1, ends[-1] - 1, len(data) - 1):
            whole = sum(end <= cut for end in ends)
            if whole == len(ends):  # the end of the file alone is torn
                continue
            torn = Mcap(data[:cut], whole=False)
            self.assertEqual(len(torn.chunks), whole)
            self.assertTrue(all(torn.messages[topic] == self.messages[topic][:len(torn.messages[topic])]
                                for topic in torn.messages))


class FullDisk(unittest.TestCase):
    def test_is_told_once_and_the_other_outputs_are_kept(self):
        out = FOLDER / "full"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        (out / "full.mcap").symlink_to("/dev/full")
        (FOLDER / "full.yaml").write_text(RECORDED + FULL)
        done = stillpoint("run", FOLDER / "full.yaml", *CAMERA, "-o", out, exit_code=1)
        self.assertEqual(done.stderr.count("No space left on device"), 1, done.stderr)
        self.assertIn("error: output (mcap) failed", done.stderr)
        self.assertIn("full.mcap: cannot write", done.stderr)
        self.assertGreater(len((out / "trajectory.txt").read_text().splitlines()), 1)


class Recording(unittest.TestCase):
    def test_pixels_are_those_of_the_folder(self):
        messages = mcap("recording.mcap").messages
        lists = [(FOLDER / "recording" / name).read_text().splitlines()[2:] for name in ("rgb.txt", "depth.txt")]
        topics = "/camera/color/image_raw", "/camera/aligned_depth_to_color/image_raw"
        for topic, lines in zip(topics, lists):
            self.assertEqual(len(messages[topic]), len(lines))
            self.assertEqual([m["header"] for _, m in messages[topic]],
                             [m["header"] for _, m in messages[topic.replace("image_raw", "camera_info")]])
            for (_, image), line in list(zip(messages[topic], lines))[::8]:
                time, name = line.split()
                self.assertAlmostEqual(seconds(image["header"]["stamp"]), float(time), 6)
                width, height, bits, rows = png(FOLDER / "recording" / name)
                self.assertEqual((image["width"], image["height"]), (width, height))
                if bits == 8:
                    self.assertEqual(image["encoding"], "bgr8")
                    swapped = bytearray(image["data"])
                    swapped[0::3], swapped[2::3] = image["data"][2::3], image["data"][0::3]
                    self.assertEqual(bytes(swapped), b"".join(rows))
                else:
                    self.assertEqual(image["encoding"], "32FC1")
                    metres = struct.unpack(f"<{width * height}f", image["data"])
                    raw = struct.unpack(f">{width * height}H", b"".join(rows))
                    self.assertEqual([round(5000 * value) for value in metres], list(raw))


def write_files():
    shutil.rmtree(FOLDER / "run", ignore_errors=True)
    shutil.rmtree(FOLDER / "recording", ignore_errors=True)
    (FOLDER / "recording.mcap").unlink(missing_ok=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "scene.yaml").write_text(SCENE)
    (FOLDER / "run.yaml").write_text(RUN)
    stillpoint("record", FOLDER / "scene.yaml", "-o", FOLDER / "recording")
    stillpoint("record", FOLDER / "scene.yaml", "-o", FOLDER / "recording.mcap")
    stillpoint("run", FOLDER / "run.yaml", *CAMERA, "-o", FOLDER / "run")


if __name__ == "__main__":
    write_files()
    unittest.main(argv=sys.argv[:1])
