#!/usr/bin/python3
"""Makes images of desks full of things with nobody there, out of three-dimensional models: a source
of its own, WORK/images/desks, with the classes of the things in WORK/classes/desks. Interrupted, it
goes on where it stopped.

The models: apt-get download sweethome3d-furniture; dpkg -x sweethome3d-furniture*.deb FOLDER;
they are FOLDER/usr/share/sweethome3d/furniture."""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402

import models  # noqa: E402
from scene import log_uniform  # noqa: E402
from sources import photographs  # noqa: E402

WIDTH, HEIGHT = 768, 576  # rendered; kept at half the size
TABLE_HEIGHT = 0.73  # m
TABLE = 11  # VOC's class
SMALL = 0.7  # m, what stands on desks
CONTACT = 0.05  # m above the table in which things darken
LARGEST_POINT = 5  # pixels to each side; what is so near that it would need more is left out


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('furniture', type=Path, help='folder with .sh3f files')
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('--count', type=int, default=2000)
    parser.add_argument('--first', type=int, default=0, help='number of the first image')
    return parser.parse_args()


class View:
    """A camera (x right, y down, z forward) and a directed light, in a world with z up, in metres."""

    def __init__(self, rng):
        distance, rise = log_uniform(rng, 0.45, 2.2), np.radians(rng.uniform(8, 65))
        turn = rng.normal(0, 0.35)
        target = np.array([rng.normal(0, 0.3), rng.normal(0.35, 0.15), TABLE_HEIGHT])
        self.position = target + distance * np.array(
            [np.sin(turn) * np.cos(rise), -np.cos(turn) * np.cos(rise), np.sin(rise)])
        forward = (target - self.position) / distance
        right = np.cross(forward, (0, 0, 1))
        right /= np.linalg.norm(right)
        roll = rng.normal(0, 0.12)
        down = np.cross(forward, right)
        self.camera_from_world = np.array([np.cos(roll) * right + np.sin(roll) * down,
                                           np.cos(roll) * down - np.sin(roll) * right, forward])
        self.focal_length = WIDTH * rng.uniform(0.7, 1.1)
        light = np.array([rng.normal(0, 0.7), rng.normal(0, 0.7), 1])
        self.light = light / np.linalg.norm(light)
        self.ambient = rng.uniform(0.25, 0.6)

    def project(self, points):
        """Pixel coordinates (n x 2) and depth in metres."""
        seen = (points - self.position) @ self.camera_from_world.T
        depth = seen[:, 2]
        with np.errstate(divide='ignore', invalid='ignore'):
            pixels = seen[:, :2] / depth[:, None] * self.focal_length
        return pixels + (WIDTH / 2, HEIGHT / 2), depth

    def directions(self):
        x, y = np.meshgrid(np.arange(WIDTH) + 0.5 - WIDTH / 2, np.arange(HEIGHT) + 0.5 - HEIGHT / 2)
        rays = np.stack([x, y, np.full_like(x, self.focal_length)], axis=-1) / self.focal_length
        return rays @ self.camera_from_world

    def shade(self, normals):
        return self.ambient + (1 - self.ambient) * np.maximum(0, normals @ self.light)


class Picture:
    """Colours (0 to 1), depths and VOC's classes; what is nearer stays."""

    def __init__(self):
        self.image = np.zeros((HEIGHT, WIDTH, 3), np.float32)
        self.depth = np.full((HEIGHT, WIDTH), np.inf, np.float32)
        self.classes = np.zeros((HEIGHT, WIDTH), np.uint8)

    def put(self, mask, colours, depth, voc_id=0):
        nearer = mask & (depth < self.depth)
        self.image[nearer], self.depth[nearer] = colours[nearer], depth[nearer]
        self.classes[nearer] = voc_id

    def splat(self, pixels, depth, colours, radius, voc_id):
        """Points as squares, of `radius` 0: one pixel."""
        order = np.argsort(-depth)
        order = order[depth[order] > 0.1]
        x, y = np.floor(pixels[order]).T
        for dy in range(-radius, radius + 1):
            for dx in range(-radius, radius + 1):
                inside = (x + dx >= 0) & (x + dx < WIDTH) & (y + dy >= 0) & (y + dy < HEIGHT)
                places = (y[inside] + dy).astype(int) * WIDTH + (x[inside] + dx).astype(int)
                mine = order[inside]
                nearer = depth[mine] < self.depth.ravel()[places]
                places, mine = places[nearer], mine[nearer]
                # Of several assignments to one pixel the last stands: the nearest.
                self.depth.ravel()[places] = depth[mine]
                self.image.reshape(-1, 3)[places] = colours[mine]
                self.classes.ravel()[places] = voc_id


def plane_image(rng, pieces):
    """Function from coordinates in metres (arrays of equal shape) to colours of a surface."""
    kind, base = rng.random(), rng.uniform(0.05, 0.95) + rng.normal(0, 0.06, 3)
    if kind < 0.25:
        base = np.array([0.93, 0.93, 0.93]) * rng.uniform(0.7, 1.05)
    elif kind < 0.5:
        base = np.array([0.28, 0.47, 0.7]) * rng.uniform(0.3, 1.2)
    piece = pieces(rng).astype(np.float32) / 255 if rng.random() < 0.3 else None
    grain = cv2.resize(rng.standard_normal((256, int(rng.integers(4, 64)))).astype(np.float32),
                       (512, 512), interpolation=cv2.INTER_CUBIC) * rng.uniform(0, 0.06)
    metres = rng.uniform(0.6, 2.5)

    def colours(u, v):
        x, y = (u / metres % 1 * 511).astype(int), (v / metres % 1 * 511).astype(int)
        if piece is None:
            return np.clip(base + grain[y, x][..., None], 0, 1)
        return piece[(y * piece.shape[0]) // 512, (x * piece.shape[1]) // 512]
    return colours


def shadow_map(rng, things, view):
    """Share of light that reaches the table, 5 mm cells of 4 m x 4 m around the origin."""
    light = np.ones((800, 800), np.float32)
    for surface in things:
        above = surface.points[:, 2] - TABLE_HEIGHT
        mine = above > 0.002
        foot = surface.points[mine, :2] - above[mine, None] * view.light[:2] / view.light[2]
        cells = np.floor((foot + 2) / 0.005).astype(int)
        inside = ((cells >= 0) & (cells < 800)).all(axis=1)
        light[cells[inside, 1], cells[inside, 0]] = 0
    light = cv2.erode(light, np.ones((3, 3)))
    return cv2.GaussianBlur(light, (0, 0), log_uniform(rng, 1, 8)) * 0.999


def draw_planes(rng, picture, view, things, pieces):
    """Table, floor and two walls."""
    rays = view.directions()
    light = shadow_map(rng, things, view)

    def draw(axis, level, limits, lit=None, voc_id=0):
        with np.errstate(divide='ignore', invalid='ignore'):
            depth = (level - view.position[axis]) / rays[..., axis]
        depth = np.where(np.isfinite(depth), depth, -1)
        points = view.position + depth[..., None] * rays
        mask = depth > 0.05
        for other, (low, high) in limits.items():
            mask &= (points[..., other] > low) & (points[..., other] < high)
        normal = np.zeros(3)
        normal[axis] = 1 if axis == 2 else -np.sign(level)
        u, v = (points[..., other] for other in range(3) if other != axis)
        colours = plane_image(rng, pieces)(u, v) * view.shade(normal)
        if lit is not None:
            x = ((points[..., 0] + 2) / 0.005).clip(0, 799).astype(int)
            y = ((points[..., 1] + 2) / 0.005).clip(0, 799).astype(int)
            colours = colours * (1 - (1 - light[y, x]) * lit)[..., None]
        picture.put(mask, colours.astype(np.float32), depth.astype(np.float32), voc_id)

    half, back = rng.uniform(0.5, 1.4), rng.uniform(0.5, 1.1)
    shadow = rng.uniform(0.3, 0.75)
    draw(2, TABLE_HEIGHT, {0: (-half, half), 1: (-0.4, back)}, shadow, TABLE)
    draw(2, TABLE_HEIGHT - 0.03, {0: (-half, half), 1: (-0.4, back)})
    draw(2, 0.0, {})
    draw(1, back + log_uniform(rng, 0.05, 4), {})
    draw(0, rng.choice([-1, 1]) * rng.uniform(1.5, 4), {})


def placed(rng, surface, scale, position):
    """The surface turned about the vertical (some lie on a side), moved, in other colours."""
    points, normals = surface.points * np.float32(scale), surface.normals
    if rng.random() < 0.2:
        points, normals = points[:, (0, 2, 1)] * (1, -1, 1), normals[:, (0, 2, 1)] * (1, -1, 1)
        points = points - (0, points[:, 1].mean(), points[:, 2].min())
    turn = rng.uniform(0, 2 * np.pi)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0],
                         [0, 0, 1]])
    colours = surface.colours
    if rng.random() < 0.35:
        colours = colours[:, rng.permutation(3)]
    colours = np.clip(colours * rng.uniform(0.6, 1.3) ** rng.uniform(0.5, 2, 3), 0, 1)
    return models.Surface((points @ rotation.T + position).astype(np.float32),
                          (normals @ rotation.T).astype(np.float32),
                          colours.astype(np.float32), surface.spacing * scale,
                          surface.voc_id)


def heap(rng, shelf):
    """Small things on top of each other, as in a mug or a bowl."""
    place, things = rng.normal((0, 0.3), 0.2), []
    for _ in range(int(rng.integers(4, 14))):
        surface, size = shelf.any(rng, small=True)
        height = TABLE_HEIGHT + abs(rng.normal(0, 0.05))
        things.append(placed(rng, surface, log_uniform(rng, 0.04, 0.2) / size,
                             (*rng.normal(place, 0.04), height)))
    return things


def furnish(rng, shelf):
    """Things on the table, and large ones behind it and beside it."""
    things = [thing for _ in range(int(rng.integers(0, 4))) for thing in heap(rng, shelf)]
    crowd = log_uniform(rng, 0.12, 0.7)  # m, how far things spread
    middle = np.array([rng.normal(0, 0.25), rng.normal(0.35, 0.15)])
    for _ in range(int(rng.integers(5, 36))):
        surface, size = shelf.any(rng, small=rng.random() < 0.75)
        largest = log_uniform(rng, 0.06, 0.4) if size > SMALL or rng.random() < 0.3 else size
        place = rng.normal(middle, crowd, 2) if rng.random() < 0.7 else rng.uniform(-0.8, 0.9, 2)
        things.append(placed(rng, surface, largest / size, (*place, TABLE_HEIGHT)))
    for _ in range(int(rng.integers(0, 7))):
        surface, size = shelf.any(rng)
        place = rng.uniform(-2.5, 2.5), rng.uniform(1.2, 4)
        scale = rng.uniform(0.5, 2) / size if size < SMALL else 1
        things.append(placed(rng, surface, scale, (*place, 0)))
    return things


class Shelf:
    """The models, read when they are first taken."""

    def __init__(self, work):
        self.models, self.surfaces = models.catalogue(work), {}
        if not self.models:
            sys.exit(f'render_desks: no models in {work}/models')
        self.small = [i for i, model in enumerate(self.models) if model.size.max() <= SMALL]

    def any(self, rng, small=False):
        """A surface and its largest side in metres."""
        number = int(rng.choice(self.small) if small else rng.integers(len(self.models)))
        if number not in self.surfaces:
            self.surfaces[number] = models.load_surface(self.models[number])
        return self.surfaces[number], self.models[number].size.max()


def render(rng, shelf, pieces):
    """An image and the VOC class of every pixel."""
    view, picture = View(rng), Picture()
    things = furnish(rng, shelf)
    draw_planes(rng, picture, view, things, pieces)
    for surface in things:
        pixels, depth = view.project(surface.points)
        towards = np.sign(np.einsum('ij,ij->i', surface.normals, view.position - surface.points))
        shade = view.shade(surface.normals * towards[:, None])
        low = surface.points[:, 2] - surface.points[:, 2].min()
        shade *= 0.6 + 0.4 * np.clip(low / CONTACT, 0, 1)
        spacing = surface.spacing * view.focal_length / max(0.1, np.quantile(depth, 0.1))
        radius = max(0, int(np.ceil(spacing - 0.5)))
        if radius <= LARGEST_POINT:
            picture.splat(pixels, depth, surface.colours * shade[:, None], radius,
                          surface.voc_id)
    exposure = rng.uniform(0.7, 1.5)
    image = np.clip(picture.image * exposure, 0, 1) ** (1 / rng.uniform(1.0, 1.6)) * 255
    size = WIDTH // 2, HEIGHT // 2
    return (cv2.resize(image.astype(np.uint8), size, interpolation=cv2.INTER_AREA),
            cv2.resize(picture.classes, size, interpolation=cv2.INTER_NEAREST))


def piece_maker(work):
    """Pieces of photographs of rooms that are trained on."""
    rooms = [photo for photo in photographs(work, ('rooms',)) if not photo.held_out]

    def piece(rng):
        image = cv2.imread(str(rooms[int(rng.integers(len(rooms)))].path))
        side = int(rng.integers(40, min(image.shape[:2])))
        y, x = (int(rng.integers(0, n - side + 1)) for n in image.shape[:2])
        return image[y:y + side, x:x + side]
    return piece


def main():
    args = arguments()
    cv2.setNumThreads(1)
    models.unpack(args.furniture, args.work)
    images, classes = args.work / 'images' / 'desks', args.work / 'classes' / 'desks'
    for folder in (images, classes):
        folder.mkdir(parents=True, exist_ok=True)
    shelf, pieces = Shelf(args.work), piece_maker(args.work)
    for number in range(args.first, args.first + args.count):
        file = images / f'{number:05}.webp'
        if file.exists():
            continue
        image, things = render(np.random.default_rng([7, number]), shelf, pieces)
        sure = np.full_like(things, 255)
        cv2.imwrite(str(classes / (file.stem + '.png')),
                    np.stack([things, sure, 0 * things], axis=2))
        cv2.imwrite(str(file), image, [cv2.IMWRITE_WEBP_QUALITY, 90])


if __name__ == '__main__':
    main()
