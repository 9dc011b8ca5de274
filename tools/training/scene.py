"""Composes training images: photographs, pasted people, drawn clutter, shapes in front of it all.

Everything happens on a canvas of the network's input size. Random numbers come from the caller, so
the same generator gives the same image."""

import cv2
import numpy as np

from network import INPUT_HEIGHT as HEIGHT
from network import INPUT_WIDTH as WIDTH
from objects import any_object, colour, outline

STRETCH = HEIGHT / 240  # images of 4:3 are stretched to the input's size
SHADOW = 10  # pixels around an object that its shadow may reach


def log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def canvas_from_image(scale, turn, image_point, canvas_point):
    """2 x 3 matrix. `scale`: canvas pixels (before the stretch) per image pixel, (x, y), negative
    in x for a mirror; `turn` in radians."""
    cosine, sine = np.cos(turn), np.sin(turn)
    matrix = np.array([[cosine * scale[0], -sine * scale[1]], [sine * scale[0], cosine * scale[1]]])
    matrix[1] *= STRETCH
    offset = np.array(canvas_point) - matrix @ np.array(image_point)
    return np.hstack([matrix, offset[:, None]])


def shrunk(plane, scale):
    """The plane at a half, a quarter, ... of its size, for scales at which it would alias."""
    factor = 1.0
    while scale < 0.6 and min(plane.shape[:2]) > 8:
        plane = cv2.resize(plane, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
        scale, factor = 2 * scale, factor / 2
    return plane, factor


def warped(plane, matrix, border):
    scale = float(np.sqrt(abs(np.linalg.det(matrix[:, :2]))))
    plane, factor = shrunk(plane, scale)
    matrix = matrix.copy()
    matrix[:, :2] /= factor
    return cv2.warpAffine(plane, matrix, (WIDTH, HEIGHT), flags=cv2.INTER_LINEAR, borderMode=border)


class Scene:
    """`image`: 8-bit BGR; `target`, `weight` (float) and `things` as in samples.py."""

    def __init__(self, image, target, weight, things=None):
        self.image, self.target, self.weight, self.things = image, target, weight, things

    def cover(self, image, opacity, is_person=False, corner=(0, 0)):
        """Puts an image over what is there; `opacity` from 0 to 1. Both may be smaller than the
        scene: `corner` is where their upper left pixel goes, as x, y."""
        part = (slice(corner[1], corner[1] + opacity.shape[0]),
                slice(corner[0], corner[0] + opacity.shape[1]))
        below = np.ascontiguousarray(self.image[part])
        self.image[part] = cv2.blendLinear(image, below, opacity, 1 - opacity)
        self.target[part] *= 1 - opacity
        if is_person:
            self.target[part] += opacity
        if self.things is not None:
            self.things[part][opacity > 0.5] = 0
        self.weight[part] = np.maximum(self.weight[part], opacity)


def plain(bgr):
    """A canvas of one colour (0 to 255)."""
    return np.full((HEIGHT, WIDTH, 3), np.clip(bgr, 0, 255), np.uint8)


def mirrored(rng, scale):
    return -scale if rng.random() < 0.5 else scale


def view(rng, sample, zoom, focus=None):
    """A part of a photograph as a scene. `zoom`: 1 fills the canvas with the whole photograph, as
    far as its shape allows; `focus`: image point to look at."""
    height, width = sample.image.shape[:2]
    size = np.array([width, height], float)
    scale = zoom * max(WIDTH / width, HEIGHT / STRETCH / height)
    shape = np.exp(rng.uniform(-0.08, 0.08))
    scales = np.array([scale * shape, scale / shape])
    half = np.array([WIDTH, HEIGHT / STRETCH]) / 2 / scales
    point = rng.uniform(0, 1, 2) * size if focus is None else np.array(focus)
    inside = np.clip(point, half, np.maximum(half, size - half))
    point = np.where(2 * half < size, inside, size / 2)
    turn = rng.normal(0, 0.35 if rng.random() < 0.25 else 0.1)
    scales[0] = mirrored(rng, scales[0])
    matrix = canvas_from_image(scales, turn, point, (WIDTH / 2, HEIGHT / 2))
    planes = [warped(plane, matrix, cv2.BORDER_REFLECT_101)
              for plane in (sample.image, sample.target, sample.weight)]
    things = sample.things
    if things is not None:
        things = cv2.warpAffine(things, matrix, (WIDTH, HEIGHT), flags=cv2.INTER_NEAREST,
                                borderMode=cv2.BORDER_REFLECT_101)
    return Scene(*planes, things)


def placed_person(rng, sample, box, any_turn=False):
    """A person cut out of a photograph, somewhere on the canvas, up to several times its height:
    8-bit image and opacity. `box`: of the people, see samples.Entry."""
    height, width = sample.image.shape[:2]
    x0, y0, x1, y1 = np.array(box) * (width, height, width, height)
    canvas_height = HEIGHT / STRETCH
    tall = log_uniform(rng, 0.3, 2.6) * canvas_height
    scale, shape = tall / max(20.0, y1 - y0), np.exp(rng.uniform(-0.1, 0.1))
    scales = np.array([scale * shape, scale / shape])
    low, high = sorted((canvas_height - tall / 2, tall / 2))
    x = rng.uniform(-0.08, 1.08) * WIDTH
    y = rng.uniform(low - 0.25 * canvas_height, high + 0.3 * canvas_height)
    turn = rng.normal(0, 0.5 if rng.random() < 0.25 else 0.13)  # some bend down
    if box[3] > 0.97:  # cut off below in the photograph: below the edge here too
        y, turn = max(y, canvas_height - (y1 - y0) / 2 * scales[1] + 2), turn * 0.3
    if any_turn:
        turn = rng.uniform(-np.pi, np.pi)
    scales[0] = mirrored(rng, scales[0])
    matrix = canvas_from_image(scales, turn, ((x0 + x1) / 2, (y0 + y1) / 2), (x, y * STRETCH))
    image = warped(sample.image, matrix, cv2.BORDER_REPLICATE)
    target = warped(sample.target, matrix, cv2.BORDER_CONSTANT)
    return image, np.clip((target - 0.3) / 0.4, 0, 1)


def checked(rng, image):
    """The image with stripes or checks, as of clothes."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    turn, period = rng.uniform(0, np.pi), log_uniform(rng, 3, 30)
    u, v = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    pattern = np.clip(np.sin(2 * np.pi / period * u) * rng.uniform(1, 4), -1, 1)
    if rng.random() < 0.6:
        pattern = pattern + np.clip(np.sin(2 * np.pi / period * v) * rng.uniform(1, 4), -1, 1)
    change = pattern[:, :, None] * rng.uniform(-60, 60) * rng.uniform(0.3, 1, 3)
    return cv2.add(image, change.astype(np.float32), dtype=cv2.CV_8U)


def half_plane(rng, lowest=0.1, highest=0.95):
    """Opacity of everything below a line, such as a desk's edge."""
    tilt = np.tan(rng.uniform(-0.35, 0.35))
    level = rng.uniform(lowest, highest) * HEIGHT
    left, right = level - tilt * WIDTH / 2, level + tilt * WIDTH / 2
    opacity = np.zeros((HEIGHT, WIDTH), np.uint8)
    corners = np.array([(-1, left), (WIDTH, right), (WIDTH, HEIGHT), (-1, HEIGHT)], np.int32)
    cv2.fillPoly(opacity, [corners], 255, cv2.LINE_AA)
    return opacity.astype(np.float32) / 255


def any_shape(rng):
    """Opacity of a rectangle, a lump or a half plane."""
    kind = rng.random()
    if kind < 0.3:
        return half_plane(rng)
    opacity = np.zeros((HEIGHT, WIDTH), np.uint8)
    centre = rng.uniform(0, 1, 2) * (WIDTH, HEIGHT)
    if kind < 0.65:
        size = rng.uniform(0.1, 0.7) * WIDTH, rng.uniform(0.08, 0.6) * HEIGHT
        corners = cv2.boxPoints((tuple(centre), size, float(rng.uniform(0, 180))))
    else:
        size = int(rng.uniform(0.15, 0.9) * WIDTH)
        corners = outline(rng, size, rng.uniform(0.2, 1.2)) - size / 2 + centre
    cv2.fillPoly(opacity, [corners.astype(np.int32)], 255, cv2.LINE_AA)
    return opacity.astype(np.float32) / 255


def seen_from_somewhere(rng, patch, size, centre):
    """Where the corners of a flat patch lie on the canvas; `size`: of its longer side in pixels."""
    height, width = patch.shape[:2]
    corners = np.float32([(0, 0), (width, 0), (width, height), (0, height)])
    turn = rng.normal(0, 0.5) if rng.random() < 0.8 else rng.uniform(0, 2 * np.pi)
    cosine, sine = np.cos(turn), np.sin(turn)
    turned = (corners - (width / 2, height / 2)) @ np.array([[cosine, sine], [-sine, cosine]])
    flattened = turned * (1, rng.uniform(0.5, 1.1)) * size / max(width, height)
    return corners, np.float32(flattened * rng.uniform(0.9, 1.1, (4, 2)) + centre)


def stamp(scene, rng, patch, opacity, centre, size):
    """Puts a drawn object on the scene, seen from somewhere, with a soft shadow below it."""
    corners, target = seen_from_somewhere(rng, patch, size, centre)
    x0, y0 = np.maximum(target.min(axis=0).astype(int) - SHADOW, 0).tolist()
    x1, y1 = np.minimum(target.max(axis=0).astype(int) + SHADOW, (WIDTH, HEIGHT)).tolist()
    if x1 - x0 < 2 or y1 - y0 < 2:
        return
    matrix = cv2.getPerspectiveTransform(corners, target - np.float32((x0, y0)))
    box = (x1 - x0, y1 - y0)
    image = cv2.warpPerspective(patch, matrix, box)
    deep = cv2.warpPerspective(opacity, matrix, box).astype(np.float32) / 255
    if rng.random() < 0.6:
        moved = np.float32([[1, 0, rng.uniform(-6, 6)], [0, 1, rng.uniform(1, 8)]])
        shadow = cv2.warpAffine(cv2.blur(deep, (9, 9)), moved, box)
        shadow *= np.float32(rng.uniform(0.1, 0.6))
        below = scene.image[y0:y1, x0:x1]
        below[:] = below * (1 - shadow)[:, :, None]
    scene.cover(image, deep, corner=(x0, y0))


def table_top(rng, texture):
    """An image of one material: plain, often white or of wood, or from a photograph."""
    image, kind = plain(colour(rng)), rng.random()
    if kind < 0.35:
        image = plain(rng.uniform(150, 255) + rng.uniform(-10, 10, 3))
    elif kind < 0.6:
        image = plain(np.array([75, 125, 180]) * rng.uniform(0.4, 1.3))
    elif kind < 0.7:
        image = texture(rng, WIDTH, HEIGHT)
    shape = int(rng.integers(4, 60)), int(rng.integers(2, 12))
    grain = rng.standard_normal(shape, np.float32)
    grain = cv2.resize(grain, (WIDTH, HEIGHT), interpolation=cv2.INTER_CUBIC) * rng.uniform(0, 15)
    light = np.linspace(0, rng.uniform(-100, 100), HEIGHT, dtype=np.float32)[:, None]
    change = cv2.merge([(grain + light).astype(np.float32)] * 3)
    return cv2.add(image, change, dtype=cv2.CV_8U)


def cables(scene, rng, count):
    for _ in range(count):
        start = rng.uniform(0, 1, 2) * (WIDTH, HEIGHT)
        points = start + np.cumsum(rng.normal(0, 25, (8, 2)), axis=0)
        smooth = cv2.resize(points.astype(np.float32), (2, 60), interpolation=cv2.INTER_CUBIC)
        ink = np.zeros((HEIGHT, WIDTH), np.uint8)
        width = int(rng.integers(1, 5))
        cv2.polylines(ink, [smooth.astype(np.int32)], False, 255, width, cv2.LINE_AA)
        scene.cover(plain(colour(rng)), ink.astype(np.float32) / 255)


def add_clutter(scene, rng, texture):
    """A desk or shelf full of drawn objects over a part of the scene or all of it."""
    horizon = rng.uniform(-0.4, 0.75)
    if rng.random() < 0.8:
        scene.cover(table_top(rng, texture), half_plane(rng, horizon - 0.02, horizon + 0.02))
    near = log_uniform(rng, 0.6, 3.5)
    rows = np.sort(rng.uniform(max(horizon, 0) - 0.05, 1.1, int(rng.integers(4, 18))))
    for row in rows:
        size = near * (30 + 55 * max(0.0, row - min(horizon, 0.3))) * log_uniform(rng, 0.5, 1.8)
        centre = rng.uniform(-0.05, 1.05) * WIDTH, row * HEIGHT - rng.uniform(0, 0.3) * size
        stamp(scene, rng, *any_object(rng, texture), centre, size)
    cables(scene, rng, int(rng.integers(0, 4)))
