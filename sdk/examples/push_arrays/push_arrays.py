"""NumPy arrays through Stillpoint, cell by cell as in a notebook.

The images come from a camera that circles, without turning, in front of a painted wall two metres away;
a plate slides through the picture in front of it. Yours come from a driver.
"""
# %% Images with known truth
import numpy as np
import stillpoint

FOCAL, WALL, PLATE, COUNT = 400.0, 2.0, 1.0, 90  # px, metres, metres, frames
camera = stillpoint.Camera(width=640, height=480, fx=FOCAL, fy=FOCAL, cx=319.5, cy=239.5,
                           depth_factor=1000)  # of depth images of uint16, in millimetres


def painting(height, width, seed):
    noise = np.random.default_rng(seed).integers(0, 256, (height // 4, width // 4, 3))
    return np.kron(noise, np.ones((4, 4, 1))).astype(np.uint8)


wall, plate = painting(640, 800, seed=1), painting(160, 120, seed=2)
angles = 2 * np.pi * np.arange(COUNT) / COUNT
shifts = np.rint(60 * np.stack([1 - np.cos(angles), np.sin(angles)], 1)).astype(int)  # px on the wall
truth = np.tile(np.eye(4), (COUNT, 1, 1))
truth[:, :2, 3] = shifts * WALL / FOCAL  # metres


def picture(frame):
    x, y = shifts[frame] + [20, 80]
    bgr = wall[y:y + 480, x:x + 640].copy()
    depth = np.full((480, 640), WALL, np.float32)  # metres
    left = 5 * frame  # px
    bgr[160:320, left:left + 120] = plate
    depth[160:320, left:left + 120] = PLATE
    return bgr, depth


# %% Track
slam = stillpoint.Engine("stillpoint", camera, settings=["runtime.mode=inline"])  # repeats exactly
times = np.arange(COUNT) / 30  # seconds
for i, time in enumerate(times):
    report = slam.process(time, *picture(i))
slam.finish()

# %% How well?
found_times, found = slam.trajectory()
error = stillpoint.evaluate((times, truth), (found_times, found))["ate"]["se3_m"]["rmse"]
print(f"{len(found)} of {COUNT} frames tracked, error {1e3 * error:.1f} mm (RMSE)")

# %% What moves in the last frame: points on the plate, and what they do to the weights
pixels, moving = report.moving_points
weights = report.track_weights
print(f"{moving.sum()} of {len(moving)} points move;",
      f"weights: plate {weights[180:300, 465:545].mean():.0f}, wall {weights[340:].mean():.0f}")

# %% The map
points, rgb, labels = slam.dense_map()
near = np.abs(points[:, 2] - PLATE) < 0.2
print(f"{len(slam.landmarks())} landmarks, {len(points)} voxels, {near.sum()} of them at the plate")
