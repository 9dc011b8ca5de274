"""The Python module: what goes in, what comes out, and what is refused."""
import gc
import os
import tempfile
import threading
import unittest

import numpy as np
import stillpoint

CAMERA = dict(width=320, height=240, fx=200.0, fy=200.0, cx=159.5, cy=119.5, depth_factor=5000.0)
DISTANCE, STEP = 2.0, 0.01  # metres: to the wall, per frame along it


def painted_wall():
    """240 x 400 x 3: smooth noise, so that features lie everywhere."""
    noise = np.random.default_rng(1).integers(0, 256, (60, 100, 3)).astype(np.float64)
    wall = np.kron(noise, np.ones((4, 4, 1)))
    for axis in (0, 1):
        wall = (np.roll(wall, 1, axis) + wall + np.roll(wall, -1, axis)) / 3
    return wall.astype(np.uint8)


WALL = painted_wall()
DEPTH = np.full((240, 320), DISTANCE * 5000, np.uint16)


def image(frame):
    shift = frame  # px: 1 cm at 2 m with fx = 200
    return WALL[:, shift:shift + 320]


def engine(pipeline="orb_baseline", **more):
    more.setdefault("settings", []).append("runtime.mode=inline")
    return stillpoint.Engine(pipeline, stillpoint.Camera(**CAMERA), **more)


def after(frames, slam=None):
    slam = slam or engine()
    for i in range(frames):
        slam.process(i / 30, image(i), DEPTH)
    return slam


class Tracking(unittest.TestCase):
    def test_the_pose_follows_the_camera(self):
        slam = engine()
        for i in range(30):
            report = slam.process(i / 30, image(i), DEPTH)
            self.assertTrue(report.tracked)
            self.assertEqual(report.index, i)
            np.testing.assert_allclose(report.world_from_camera[:3, 3], [i * STEP, 0, 0], atol=5e-3)
        slam.finish()
        times, poses = slam.trajectory()
        np.testing.assert_allclose(times, np.arange(30) / 30)
        self.assertEqual(poses.shape, (30, 4, 4))
        np.testing.assert_allclose(poses[:, 0, 3], STEP * np.arange(30), atol=5e-3)

    def test_metres_and_raw_depth_are_the_same(self):
        raw, metres = engine(), engine()
        for i in range(5):
            raw.process(i, image(i), DEPTH)
            metres.process(i, image(i), DEPTH.astype(np.float32) / 5000)
        np.testing.assert_array_equal(raw.trajectory()[1], metres.trajectory()[1])

    def test_threaded(self):
        slam = stillpoint.Engine("orb_baseline", stillpoint.Camera(**CAMERA))
        after(30, slam).finish()
        np.testing.assert_allclose(slam.trajectory()[1][:, 0, 3], STEP * np.arange(30), atol=5e-3)

    def test_other_threads_may_look(self):
        slam, lengths, ended = engine(), [], threading.Event()

        def look():
            while not ended.is_set():
                lengths.append(len(slam.trajectory()[0]))

        looking = threading.Thread(target=look)
        looking.start()
        after(30, slam)
        ended.set()
        looking.join()
        self.assertEqual(lengths, sorted(lengths))
        self.assertEqual(len(slam.trajectory()[0]), 30)

    def test_no_pose_is_none(self):
        report = engine().process(0, np.zeros((240, 320, 3), np.uint8), DEPTH)
        self.assertFalse(report.tracked)
        self.assertFalse(report.lost)
        self.assertIsNone(report.world_from_camera)


class Reports(unittest.TestCase):
    def test_images_share_the_pixels_and_outlive_everything_else(self):
        slam = engine()
        report = slam.process(0, image(0), DEPTH)
        bgr, depth = report.bgr, report.depth
        self.assertTrue(np.shares_memory(bgr, report.bgr))
        self.assertFalse(bgr.flags.writeable)
        del report, slam
        gc.collect()
        np.testing.assert_array_equal(bgr, image(0))
        np.testing.assert_array_equal(depth, np.full((240, 320), DISTANCE, np.float32))

    def test_the_callers_array_may_change_afterwards(self):
        mine = np.ascontiguousarray(image(0))
        report = engine().process(0, mine, DEPTH)
        mine[:] = 0
        np.testing.assert_array_equal(report.bgr, image(0))

    def test_labels_and_weights(self):
        slam = engine("stillpoint")
        report = slam.process(0, image(0), DEPTH)
        self.assertEqual(report.labels.shape, (240, 320))
        self.assertIn("person", slam.classes)
        self.assertLess(report.labels.max(), len(slam.classes))
        report = slam.process(1 / 30, image(1), DEPTH)
        self.assertEqual(report.track_weights.dtype, np.uint8)
        pixels, moving = report.moving_points
        self.assertEqual(pixels.shape, (len(moving), 2))
        self.assertGreater(len(moving), 50)
        self.assertLess(moving.mean(), 0.1)

    def test_without_a_segmenter_nothing_is_known(self):
        report = engine().process(0, image(0), DEPTH)
        self.assertIsNone(report.labels)
        self.assertIsNone(report.track_weights)
        self.assertEqual(engine().classes, [])


class Maps(unittest.TestCase):
    def test_landmarks_lie_on_the_wall(self):
        slam = after(30)
        slam.finish()
        landmarks = slam.landmarks()
        self.assertGreater(len(landmarks), 100)
        np.testing.assert_allclose(landmarks[:, 2], DISTANCE, atol=0.02)
        times, poses = slam.keyframes()
        self.assertEqual(poses.shape, (len(times), 4, 4))

    def test_the_dense_map_is_that_of_the_files(self):
        with tempfile.TemporaryDirectory() as folder:
            slam = after(10, engine("stillpoint", output=folder))
            slam.finish()
            positions, rgb, labels = slam.dense_map()
            with open(os.path.join(folder, "map", "map.ply"), "rb") as file:
                header, points = file.read().split(b"end_header\n", 1)
            self.assertIn(b"element vertex %d\n" % len(positions), header)
            columns = np.frombuffer(points, np.dtype("3<f4, 3u1, u1"))
            np.testing.assert_array_equal(columns["f0"], positions)
            np.testing.assert_array_equal(columns["f1"], rgb)
            np.testing.assert_array_equal(columns["f2"], labels)
            np.testing.assert_allclose(positions[:, 2], DISTANCE, atol=0.1)
            self.assertIn("trajectory.txt", os.listdir(folder))

    def test_a_saved_map_is_gone_on_with(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "wall.map")
            slam = after(30)
            slam.finish()
            slam.save_map(file)
            known = engine(load_map=file, localise_only=True)
            report = known.process(0, image(12), DEPTH)
            self.assertTrue(report.tracked)
            np.testing.assert_allclose(report.world_from_camera[0, 3], 12 * STEP, atol=5e-3)
            self.assertEqual(len(known.landmarks()), len(slam.landmarks()))


class Refusals(unittest.TestCase):
    def refuses(self, kind, text, call):
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(text, str(caught.exception))

    def test_shapes_and_types(self):
        slam = engine()
        self.refuses(ValueError, "bgr must be H x W x 3 of uint8, but it is 240 x 320 of uint8",
                     lambda: slam.process(0, image(0)[..., 0], DEPTH))
        self.refuses(ValueError, "but it is 240 x 320 x 3 of float64",
                     lambda: slam.process(0, image(0).astype(float), DEPTH))
        self.refuses(ValueError, "its pixels one after the other",
                     lambda: slam.process(0, WALL[:, 0:640:2][:, ::-1], DEPTH))
        self.refuses(ValueError, "depth must be H x W of uint16 or float32",
                     lambda: slam.process(0, image(0), DEPTH.astype(np.int64)))
        self.refuses(stillpoint.Error, "320 x 200 pixels, but camera 'camera' has 320 x 240",
                     lambda: slam.process(0, image(0)[:200], DEPTH))
        self.assertEqual(slam.process(0, image(0), DEPTH).index, 0)

    def test_depth_in_millimetres(self):
        millimetres = np.full((240, 320), 1e3 * DISTANCE, np.float32)
        slam = engine()
        for _ in range(2):
            self.refuses(ValueError, "lies beyond 2000 m: float32 depth is in metres",
                         lambda: slam.process(0, image(0), millimetres))

    def test_cameras_without_a_depth_factor(self):
        without_factor = {key: CAMERA[key] for key in CAMERA if key != "depth_factor"}
        with self.assertWarnsRegex(UserWarning, "millimetres need depth_factor=1000"):
            stillpoint.Camera(**without_factor)

    def test_camera_files_without_a_depth_factor(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("camera: {width: 320, height: 240, fx: 200, fy: 200, cx: 159.5, cy: 119.5}\n")
            file.flush()
            with self.assertWarnsRegex(UserWarning, "depth_factor"):
                stillpoint.Engine("orb_baseline", file.name)

    def test_time_that_runs_backwards(self):
        slam = after(3)
        self.refuses(stillpoint.Error, "older than the one before",
                     lambda: slam.process(0.0, image(3), DEPTH))

    def test_pipelines_and_cameras(self):
        self.refuses(stillpoint.Error, "did you mean 'orb_baseline'",
                     lambda: stillpoint.Engine("orb_basline", stillpoint.Camera(**CAMERA)))
        self.refuses(stillpoint.Error, "no camera named 'tum_fr9'",
                     lambda: stillpoint.Engine("orb_baseline", "tum_fr9"))
        self.refuses(stillpoint.Error, "--set tracker.feature=2000",
                     lambda: engine(settings=["tracker.feature=2000"]))
        self.refuses(stillpoint.Error, "Camera: fx = -1 is not at least 1",
                     lambda: stillpoint.Camera(**{**CAMERA, "fx": -1.0}))

    def test_frames_after_the_end(self):
        slam = after(2)
        slam.finish()
        self.refuses(stillpoint.Error, "after finish()",
                     lambda: slam.process(1, image(2), DEPTH))
        self.refuses(stillpoint.Error, "finished already", slam.finish)

    def test_map_files(self):
        self.refuses(stillpoint.Error, "there is no such file",
                     lambda: engine(load_map="/nowhere/room.map"))


class Evaluation(unittest.TestCase):
    def truth(self):
        times = np.arange(50) / 30
        poses = np.tile(np.eye(4), (50, 1, 1))
        poses[:, 0, 3] = np.sin(times)
        poses[:, 1, 3] = np.cos(2 * times)
        return times, poses

    def test_a_moved_copy_has_no_error(self):
        times, poses = self.truth()
        turn = np.array([[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]], float)
        result = stillpoint.evaluate((times, poses), (times, turn @ poses))
        self.assertAlmostEqual(result["ate"]["se3_m"]["rmse"], 0, places=9)

    def test_a_known_error(self):
        times, poses = self.truth()
        bent = poses.copy()
        bent[:, 2, 3] = 0.01 * (-1.0) ** np.arange(50)
        result = stillpoint.evaluate((times, poses), (times, bent))
        self.assertAlmostEqual(result["ate"]["se3_m"]["rmse"], 0.01, places=4)

    def test_refusals(self):
        times, poses = self.truth()
        for reference in [(times[:-1], poses), (times, poses[:, :3]), (times[::-1], poses),
                          (times, 2 * poses), (times[:0], poses[:0])]:
            with self.assertRaises(ValueError):
                stillpoint.evaluate(reference, (times, poses))
        with self.assertRaises(stillpoint.Error):
            stillpoint.evaluate("/nowhere.txt", (times, poses))


if __name__ == "__main__":
    unittest.main()
