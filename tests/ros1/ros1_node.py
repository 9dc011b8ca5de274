#!/usr/bin/python3
"""The node of sdk/ros1 in a ROS of its own: a bag is played, and what the node publishes compared with the truth.

usage: ros1_node.py PACKAGE RECORDING FOLDER

PACKAGE is the folder of the installed node.

Exits with 77, skipped, where the node was not built or a package of ROS is missing."""
import itertools
import os
import pathlib
import shutil
import signal
import socket
import sys

try:
    import genpy.dynamic
    import numpy
    import rospy
    import tf2_ros
    from diagnostic_msgs.msg import DiagnosticStatus
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import CameraInfo, Image
    from std_srvs.srv import Trigger
    from inbox import PATIENCE, Inbox, expect
    from processes import Processes
    from recording_bag import CAMERA, CAMERA_FRAME, Truth, image_message, info_message, matrix, write_bag
except ImportError as missing:
    print(f"skipped: {missing}; tools/setup --tests installs the packages")
    sys.exit(77)

PACKAGE, RECORDING, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
FRAMES = 60
LIMIT = 0.03   # metres, of the worst pose, not aligned; it is 0.011
MD5_OF_OCTOMAP = "9a45536b45c5e409cd49f04bb2d9999f"  # of octomap_msgs/Octomap
# 1.2 m above the floor, looking forward: z of the camera is x of the base.
BASE_FROM_CAMERA = matrix([0.1, 0.0, 1.2], [-0.5, 0.5, -0.5, 0.5])
ODOM_FROM_BASE = matrix([0.5, 0.2, 0.0], [0, 0, 0.1, 0.99])
PARAMETERS = {"pipeline": "orb_baseline", "set": ["map_backend.type=octomap"], "queue_size": 100,
              "map_period": 0.5, "map_file": str(FOLDER / "room.map")}
NODE = (PACKAGE / "stillpoint_node", "__name:=stillpoint", f"rgb/image_raw:={CAMERA}/color/image_raw",
        f"rgb/camera_info:={CAMERA}/color/camera_info",
        f"depth_registered/image_raw:={CAMERA}/aligned_depth_to_color/image_raw")
LAUNCH = ("roslaunch", "--wait", "stillpoint_ros", "stillpoint.launch", "pipeline:=orb_baseline")
WITH_ROBOT = {"base_frame": "base_link", "odom_frame": "odom", "depth_factor": 5000.0}


def values(state):
    return {pair.key: pair.value for pair in state.values}


def pose_matrix(pose):
    p, q = pose.position, pose.orientation
    return matrix([p.x, p.y, p.z], [q.x, q.y, q.z, q.w])


def transform_matrix(transform):
    t, q = transform.translation, transform.rotation
    return matrix([t.x, t.y, t.z], [q.x, q.y, q.z, q.w])


def static_transform(target, source, target_from_source):
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = target, source
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = target_from_source[:3, 3]
    r = target_from_source[:3, :3]
    q.w = numpy.sqrt(1 + numpy.trace(r)) / 2
    q.x, q.y, q.z = (r[2, 1] - r[1, 2]) / (4 * q.w), (r[0, 2] - r[2, 0]) / (4 * q.w), (r[1, 0] - r[0, 1]) / (4 * q.w)
    return message


def start_node(processes, parameters, command=NODE):
    if rospy.has_param("/stillpoint"):
        rospy.delete_param("/stillpoint")
    rospy.set_param("/stillpoint", parameters)
    processes.start("node", *command)
    rospy.wait_for_service("/stillpoint/reset", PATIENCE)


def start_playing(processes, inbox, bag):
    inbox.clear()
    processes.start("play", "rosbag", "play", "-q", "-r", "0.7", "--wait-for-subscribers", bag)


def play(processes, inbox, bag, last_frame=FRAMES - 1):
    start_playing(processes, inbox, bag)
    expect(processes.wait("play", PATIENCE) == 0, f"{bag.name} is played")
    inbox.wait("state", lambda its: values(its).get("frame") == str(last_frame), "all frames come through")


def call(service):
    return rospy.ServiceProxy(f"/stillpoint/{service}", Trigger)()


def worst_error(poses, truth, map_from_room, base_from_camera, offset=0.0):
    """Metres between the cameras of `poses` (of the base) and the truth, without alignment."""
    return max(numpy.linalg.norm((pose_matrix(its.pose) @ base_from_camera -
                                  map_from_room @ truth.room_from_camera(its.header.stamp.to_sec() - offset))[:3, 3])
               for its in poses)


def check_poses(inbox, map_from_room, truth, tf_buffer):
    poses = inbox.messages["pose"]
    inbox.wait("pose", lambda _: len(poses) >= FRAMES, "the last pose comes")
    error = worst_error(poses, truth, map_from_room, BASE_FROM_CAMERA)
    expect(len(poses) == FRAMES and error < LIMIT, f"all poses of the base are right, to {error * 1000:.1f} mm")
    expect(all(pose.header.frame_id == "map" for pose in poses), "they are in the map")
    last = poses[-1]
    odometry = inbox.wait("odom", lambda its: its.header.stamp == last.header.stamp, "odom has the last one")
    covariance = numpy.array(odometry.pose.covariance).reshape(6, 6)
    deviation = numpy.sqrt(numpy.linalg.eigvalsh(covariance))
    expect(odometry.child_frame_id == "base_link" and numpy.allclose(covariance, covariance.T) and
           1e-5 < deviation[0] and deviation[-1] < 0.05, f"its deviation is {deviation[-1]:.5f} at most")
    path = inbox.wait("path", lambda its: len(its.poses) == FRAMES, "path has all poses")
    error = worst_error(path.poses, truth, map_from_room, BASE_FROM_CAMERA)
    expect(error < LIMIT, f"path is right, to {error * 1000:.1f} mm")
    check_tf(inbox, tf_buffer, last)


def check_tf(inbox, tf_buffer, last):
    links = {(its.header.frame_id, its.child_frame_id) for message in inbox.messages["tf"] for its in message.transforms}
    expect(links == {("map", "odom")}, "the only link is from map to odom")
    base = tf_buffer.lookup_transform("map", "base_link", last.header.stamp, rospy.Duration(PATIENCE))
    expect(numpy.allclose(transform_matrix(base.transform), pose_matrix(last.pose), atol=1e-6),
           "tf has the base where pose has it")
    world = tf_buffer.lookup_transform("map", "map_optical", rospy.Time(0), rospy.Duration(PATIENCE))
    expect(numpy.allclose(transform_matrix(world.transform), BASE_FROM_CAMERA, atol=1e-6),
           "map_optical is where the first camera was")


def check_maps(inbox, map_from_room):
    landmarks = inbox.wait("landmarks", lambda its: its.width > 500, "there are landmarks")
    expect(landmarks.header.frame_id == "map_optical", "they are in map_optical")
    inbox.clear()
    octomap = octomap_of(inbox.wait("octomap", lambda its: True, "there is an octree"))
    dense = inbox.wait("dense_map", lambda its: its.width in octree_sizes(inbox), "dense_map has an octree's voxels")
    expect(octomap.id == "OcTree" and octomap.resolution == 0.05 and octomap.header.frame_id == "map_optical" and
           [field.name for field in dense.fields] == ["x", "y", "z", "rgb", "label"], "both are described rightly")
    check_grid(inbox.wait("grid", lambda its: True, "there is a grid"), map_from_room)


def octree_sizes(inbox):
    """In occupied voxels: the map may still grow from one message to the next."""
    return {occupied_voxels(numpy.array(octomap_of(message).data, numpy.int8).view(numpy.uint8))
            for message in inbox.messages["octomap"]}


def octomap_of(message):
    header = message._connection_header
    expect(header["type"] == "octomap_msgs/Octomap" and header["md5sum"] == MD5_OF_OCTOMAP, "of the type that all know")
    kind = genpy.dynamic.generate_dynamic(header["type"], header["message_definition"])[header["type"]]
    return kind().deserialize(message._buff)


def occupied_voxels(data):
    """In OctoMap's binary format: two bits per child, 1 free, 2 occupied, 3 with children, which follow."""
    position, occupied, depths = 0, 0, [0]
    while depths:
        depth = depths.pop()
        bits = int(data[position]) | int(data[position + 1]) << 8
        position += 2
        children = [bits >> 2 * child & 3 for child in range(8)]
        occupied += children.count(2) * 8 ** (15 - depth)
        depths += [depth + 1] * children.count(3)
    expect(position == len(data), "its bytes are a whole tree")
    return occupied


def check_grid(grid, map_from_room):
    cells = numpy.array(grid.data)
    expect(grid.header.frame_id == "map" and abs(grid.info.resolution - 0.05) < 1e-6 and
           len(cells) == grid.info.width * grid.info.height, "it is described rightly")
    expect((cells == 0).sum() > 200 and (cells == 100).sum() > 50, "with free and occupied cells")
    room_from_grid = numpy.linalg.inv(map_from_room) @ pose_matrix(grid.info.origin)
    expect(room_from_grid[2, 2] > 0.999, "it lies level")
    expect(abs(room_from_grid[2, 3]) < 0.06, f"on the floor, {room_from_grid[2, 3] * 1000:.0f} mm off")


def check_services(processes, inbox, truth, map_from_room):
    rospy.set_param("/stillpoint/map_file", str(FOLDER / "none.map"))
    answer = call("load_map")
    expect(not answer.success and "none.map" in answer.message, f"a missing map is named: {answer.message}")
    rospy.set_param("/stillpoint/map_file", str(FOLDER / "room.map"))
    answer = call("save_map")
    expect(answer.success and (FOLDER / "room.map").stat().st_size > 10000, answer.message)
    answer = call("reset")
    expect(answer.success, answer.message)
    expect(not call("save_map").success, "then there is no map to be saved")
    answer = call("load_map")
    expect(answer.success, answer.message)
    bag = FOLDER / "later.bag"
    write_bag(RECORDING, bag, offset=10.0)
    play(processes, inbox, bag)
    error = worst_error(inbox.messages["pose"], truth, map_from_room, BASE_FROM_CAMERA, 10.0)
    expect(len(inbox.messages["pose"]) > FRAMES - 10 and error < LIMIT,
           f"{len(inbox.messages['pose'])} frames are found in the loaded map, to {error * 1000:.1f} mm")


def check_other_images(inbox):
    inbox.clear()
    publishers = [rospy.Publisher(topic, Image, queue_size=1, latch=True)
                  for topic in (f"{CAMERA}/color/image_raw", f"{CAMERA}/aligned_depth_to_color/image_raw")]
    depth = numpy.full((240, 320), 5000, numpy.uint16)
    publishers[0].publish(image_message(numpy.zeros((240, 320, 3), numpy.uint8), "rgb8", rospy.Time(2000)))
    publishers[1].publish(image_message(depth, "16UC1", rospy.Time(2000)))
    state = inbox.wait("state", lambda its: "frame" in values(its), "a black image is answered")
    expect(state.message == "lost" and state.level == DiagnosticStatus.WARN and not inbox.messages["pose"] and
           not inbox.messages["tf"], "the camera is lost, and there is no pose")
    publishers[0].publish(image_message(numpy.zeros((240, 320, 2), numpy.uint8), "yuv422", rospy.Time(2001)))
    publishers[1].publish(image_message(depth, "16UC1", rospy.Time(2001)))
    state = inbox.wait("state", lambda its: its.level == DiagnosticStatus.ERROR, "an encoding is refused")
    expect("'yuv422'" in state.message, state.message)
    for publisher in publishers:
        publisher.unregister()


def check_another_camera(inbox):
    """Of 480 x 360 pixels: it is taken after a reset."""
    kinds = {"color/image_raw": Image, "aligned_depth_to_color/image_raw": Image, "color/camera_info": CameraInfo}
    publishers = [rospy.Publisher(f"{CAMERA}/{topic}", kind, queue_size=1) for topic, kind in kinds.items()]
    color, depth = numpy.zeros((360, 480, 3), numpy.uint8), numpy.full((360, 480), 5000, numpy.uint16)
    camera = {"width": 480, "height": 360, "fx": 400.0, "fy": 400.0, "cx": 240.0, "cy": 180.0}
    seconds = itertools.count(3000)

    def publish():
        stamp = rospy.Time(next(seconds))
        images = image_message(color, "rgb8", stamp), image_message(depth, "16UC1", stamp)
        for publisher, message in zip(publishers, (*images, info_message(camera, stamp))):
            publisher.publish(message)

    inbox.clear()
    state = inbox.wait_while(publish, "state", lambda its: "service reset" in its.message, "another size is refused")
    expect(state.level == DiagnosticStatus.ERROR and "480 x 360" in state.message, state.message)
    answer = call("reset")
    expect(answer.success, answer.message)
    inbox.clear()
    state = inbox.wait_while(publish, "state", lambda its: "frame" in values(its), "it is tracked after a reset")
    expect(state.message == "waiting", "black images begin no map")
    for publisher in publishers:
        publisher.unregister()


def check_second_play(processes, inbox, bag, truth, map_from_room):
    """Of the same bag, whose player is killed in the middle of it."""
    answer = call("reset")
    expect(answer.success, answer.message)
    start_playing(processes, inbox, bag)
    inbox.wait("state", lambda its: values(its).get("frame") == "20", "after a reset, the same bag is tracked again")
    processes.kill("play")
    error = worst_error(list(inbox.messages["pose"]), truth, map_from_room, numpy.eye(4))
    expect(error < LIMIT, f"its poses are right, to {error * 1000:.1f} mm")
    inbox.clear()
    state = inbox.wait("state", lambda its: its.message.startswith("no pair of images for "), "then no images come")
    expect(state.level == DiagnosticStatus.WARN, state.message)


def robot_with_odometry(processes, inbox, truth, tf_buffer):
    bag = FOLDER / "exact.bag"
    first = write_bag(RECORDING, bag)
    map_from_room = BASE_FROM_CAMERA @ numpy.linalg.inv(truth.room_from_camera(first))
    broadcaster = tf2_ros.StaticTransformBroadcaster()
    broadcaster.sendTransform([static_transform("base_link", CAMERA_FRAME, BASE_FROM_CAMERA),
                               static_transform("odom", "base_link", ODOM_FROM_BASE)])
    start_node(processes, {**PARAMETERS, **WITH_ROBOT})
    play(processes, inbox, bag)
    check_poses(inbox, map_from_room, truth, tf_buffer)
    check_maps(inbox, map_from_room)
    check_services(processes, inbox, truth, map_from_room)
    check_other_images(inbox)
    check_another_camera(inbox)
    expect(processes.stop("node") == 0, "the node ends at Ctrl-C")


def camera_alone(processes, inbox, truth):
    bag = FOLDER / "approximate.bag"
    first = write_bag(RECORDING, bag, metres=True, depth_offset=0.004)
    start_node(processes, {"approximate": True, "queue_size": 100}, LAUNCH)
    play(processes, inbox, bag, FRAMES - 2)  # the last pair waits for a later one that might fit better
    optical = numpy.eye(4)
    optical[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]
    map_from_room = optical @ numpy.linalg.inv(truth.room_from_camera(first))
    error = worst_error(inbox.messages["pose"], truth, map_from_room, numpy.eye(4))
    expect(error < LIMIT, f"depth in metres, 4 ms later: the camera's poses are right, to {error * 1000:.1f} mm")
    expect(inbox.messages["tf"][-1].transforms[0].child_frame_id == CAMERA_FRAME, "tf goes from map to the camera")
    check_second_play(processes, inbox, bag, truth, map_from_room)
    expect(processes.stop("node") == 0, "the launched node ends at Ctrl-C")


def faulty_parameters(processes):
    for code, parameters, message in (
            (2, {"pipeline": "stillpiont"}, "did you mean 'stillpoint'?"),
            (2, {"aproximate": True}, "aproximate: there is no such parameter; did you mean 'approximate'?"),
            (2, {"max_difference": 2.0}, "/stillpoint/max_difference: must be from 0 to 1 s"),
            (2, {"queue_size": "many"}, "/stillpoint/queue_size: the parameter has another type"),
            (3, {"load_map": True, "map_file": "/no/such.map"}, "/no/such.map: this map cannot be used")):
        rospy.delete_param("/stillpoint")
        rospy.set_param("/stillpoint", parameters)
        processes.start("faulty", *NODE)
        expect(processes.wait("faulty", PATIENCE) == code and message in processes.log("faulty"), message)


def environment():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    return port, {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(FOLDER / "home"),
                  "ROS_LOG_DIR": str(FOLDER / "home/log"), "ROS_PACKAGE_PATH": str(PACKAGE.parent), "PATH": "/usr/bin:/bin"}


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    (FOLDER / "home").mkdir(parents=True)
    port, variables = environment()
    with Processes(FOLDER, variables) as processes:
        processes.start("roscore", "roscore", "-p", port)
        # This process is a node as well; it reads the variables that the others have been given.
        os.environ.update(variables)
        rospy.init_node("test", disable_signals=True)
        inbox, truth = Inbox(), Truth(RECORDING)
        tf_buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(tf_buffer)
        try:
            robot_with_odometry(processes, inbox, truth, tf_buffer)
            camera_alone(processes, inbox, truth)
            faulty_parameters(processes)
        except BaseException:
            print(processes.log("node")[-4000:])
            raise
        finally:
            del listener
            rospy.signal_shutdown("the test is over")


def give_up(*_):
    raise TimeoutError("the test takes too long")


if not NODE[0].exists():
    print(f"skipped: {NODE[0]} was not built")
    sys.exit(77)
signal.signal(signal.SIGALRM, give_up)
signal.signal(signal.SIGTERM, give_up)
signal.alarm(150)
main()
