#!/usr/bin/python3
"""Bags that ROS 1's own library writes of a recording give the very trajectory of that recording.

usage: ros1_bags.py PROGRAM FOLDER

Exits with 77, skipped, where Debian's python3-rosbag, python3-sensor-msgs or python3-pil is missing."""
import pathlib
import shutil
import struct
import subprocess
import sys

try:
    import numpy
    import PIL.Image
    import rosbag
    import rospy
    from sensor_msgs.msg import CameraInfo, CompressedImage, Image
except ImportError as missing:
    print(f"skipped: {missing}; apt-get install python3-rosbag python3-sensor-msgs python3-pil")
    sys.exit(77)

FRAMES = 20
WIDTH, HEIGHT, FX, FY, CX, CY = 320, 240, 267.7, 269.6, 159.8, 123.6
FACTOR = 5000  # of the recording's depth images
CAMERA = (f"camera: {{name: small, width: {WIDTH}, height: {HEIGHT}, fx: {FX}, fy: {FY}, cx: {CX}, "
          f"cy: {CY}, depth_factor: {FACTOR}}}\n")


def stillpoint(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"stillpoint {' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def trajectory(dataset, *arguments):
    out = FOLDER / "out"
    shutil.rmtree(out, ignore_errors=True)
    stillpoint("run", "orb_baseline", "--dataset", dataset, "-o", out, "--set", "runtime.mode=inline",
               *arguments)
    return (out / "trajectory.txt").read_bytes()


def images(stream):
    for line in (RECORDING / f"{stream}.txt").read_text().splitlines():
        if not line.startswith("#"):
            time, name = line.split()
            whole, fraction = time.split(".")
            yield rospy.Time(int(whole), int(fraction.ljust(9, "0"))), RECORDING / name


def with_header(message, stamp):
    message.header.stamp = stamp
    message.header.frame_id = "camera_color_optical_frame"
    return message


def raw(stamp, pixels, encoding):
    message = with_header(Image(), stamp)
    message.height, message.width = pixels.shape[:2]
    message.encoding = encoding
    message.step = pixels.strides[0]
    message.data = pixels.tobytes()
    return message


def compressed(stamp, form, data):
    message = with_header(CompressedImage(), stamp)
    message.format, message.data = form, data
    return message


def color_message(kind, stamp, file):
    if kind == "compressed":
        return "/compressed", compressed(stamp, "rgb8; png compressed bgr8", file.read_bytes())
    pixels = numpy.asarray(PIL.Image.open(file).convert("RGB"))
    return "", raw(stamp, pixels if kind == "rgb8" else pixels[:, :, ::-1].copy(), kind)


def depth_message(kind, stamp, file):
    if kind == "compressedDepth":
        header = struct.pack("<iff", 0, 0, 0)
        return "/compressedDepth", compressed(stamp, "16UC1; compressedDepth", header + file.read_bytes())
    pixels = numpy.asarray(PIL.Image.open(file)).astype(numpy.uint16)
    if kind == "32FC1":
        pixels = pixels.astype(numpy.float32) / numpy.float32(FACTOR)
        pixels[pixels == 0] = numpy.nan
    return "", raw(stamp, pixels, kind)


def camera_info(stamp):
    info = with_header(CameraInfo(), stamp)
    info.width, info.height, info.distortion_model = WIDTH, HEIGHT, "plumb_bob"
    info.D = [0.0] * 5
    info.K = [FX, 0, CX, 0, FY, CY, 0, 0, 1]
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = [FX, 0, CX, 0, 0, FY, CY, 0, 0, 0, 1, 0]
    return info


def write_bag(file, compression, color, depth):
    with rosbag.Bag(str(file), "w", compression=compression, chunk_threshold=1 << 20) as bag:
        for (stamp, color_file), (depth_stamp, depth_file) in zip(images("rgb"), images("depth")):
            topic, message = color_message(color, stamp, color_file)
            bag.write("/camera/color/image_raw" + topic, message, stamp)
            bag.write("/camera/color/camera_info", camera_info(stamp), stamp)
            topic, message = depth_message(depth, depth_stamp, depth_file)
            bag.write("/camera/aligned_depth_to_color/image_raw" + topic, message, depth_stamp)


def expect(condition, text):
    print(("ok      " if condition else "FAILED  ") + text)
    if not condition:
        sys.exit(1)


PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
RECORDING = FOLDER / "recording"
shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
small = [f"camera.{key}={value}" for key, value in
         dict(width=WIDTH, height=HEIGHT, fx=FX, fy=FY, cx=CX, cy=CY).items()]
stillpoint("simulate", "fr3_walking_xyz_empty", "--frames", FRAMES, "-o", RECORDING,
           *(word for setting in small for word in ("--set", setting)))
(FOLDER / "camera.yaml").write_text("version: 1\n" + CAMERA)
truth = trajectory(RECORDING, "--camera", FOLDER / "camera.yaml")
expect(truth.count(b"\n") >= FRAMES, "the recording is tracked")

for name, color, depth in (("none", "rgb8", "16UC1"), ("bz2", "bgr8", "32FC1"),
                           ("lz4", "compressed", "compressedDepth")):
    file = FOLDER / f"{name}.bag"
    write_bag(file, name, color, depth)
    factor = [] if depth == "32FC1" else ["--set", f"source.depth_factor={FACTOR}"]
    expect(trajectory(file, *factor) == truth, f"{name}, {color}, {depth}: the same trajectory")
    text = stillpoint("inspect", file, "--camera", FOLDER / "camera.yaml")  # for its depth factor
    expect(f"pairs             {FRAMES} images" in text and "No problems found" in text, f"{name}: inspect finds no problem")

cut = FOLDER / "cut.bag"
cut.write_bytes((FOLDER / "none.bag").read_bytes()[:(FOLDER / "none.bag").stat().st_size * 7 // 10])
text = stillpoint("run", "orb_baseline", "--dataset", cut, "-o", FOLDER / "out", "--set",
                  f"source.depth_factor={FACTOR}")
expect("cut off" in text, "of a bag that is cut off the beginning is run, with a warning")
