"""Training images that are made once and used often, with the teachers' features beside them.

    WORK/cache/NUMBER.images    RECORDS of the type RECORD

Each use sees another part of an image, or its mirror image, a little brighter or darker. Images
with things in them, and of these the rarer classes, are used more often than others."""

import cv2
import numpy as np
import torch
import torch.nn.functional as F

import hints
from class_labels import UNKNOWN
from segnet import CLASSES, PERSON

WIDTH, HEIGHT = 240, 192  # of stored images
RECORDS = 64  # per file
RECORD = np.dtype([('image', 'u1', (HEIGHT, WIDTH, 3)),
                   ('labels', 'u1', (HEIGHT, WIDTH, 2)),  # person and weight, 0 to 255
                   ('things', 'u1', (HEIGHT, WIDTH)),
                   ('probabilities', 'u1', (len(CLASSES),) + hints.SHAPES['deeplab'][1:])] +
                  [(name, 'i1', shape) for name, shape in hints.SHAPES.items()])
SMALLEST_PART = 0.75  # of an image's sides that is used
COARSE = 4  # pixels, in which the teacher's probabilities are brought to an image's size
SHARPNESS = 2  # power of the teacher's probabilities
TAUGHT_BACKGROUND = 0.5  # factor of its background: it overlooks more than it makes up
# An image is used as often as it has things, compared with all others, plus one.
MOST_THINGS = 3


class Part:
    """Of a stored image, in shares of its sides."""

    def __init__(self, rng):
        sides = rng.uniform(SMALLEST_PART, 1) * np.exp(rng.uniform(-0.06, 0.06, 2))
        self.sides = np.minimum(sides, 1)
        self.corner = rng.uniform(0, 1, 2) * (1 - self.sides)
        self.mirrored = rng.random() < 0.5

    def of(self, plane, size, interpolation=cv2.INTER_LINEAR):
        """`plane`: rows x columns, of any number of channels."""
        shape = plane.shape[1::-1]
        x0, y0 = np.round(self.corner * shape).astype(int)
        x1, y1 = np.round((self.corner + self.sides) * shape).astype(int)
        part = cv2.resize(plane[y0:y1, x0:x1], size, interpolation=interpolation)
        return part[:, ::-1] if self.mirrored else part

    def map(self):
        """Affine, from places in the result to places in the stored image, both -1 to 1."""
        scale = self.sides * (-1 if self.mirrored else 1, 1)
        offset = 2 * self.corner + self.sides - 1
        return np.float32([[scale[0], 0, offset[0]], [0, scale[1], offset[1]]])


def cells_of(planes, maps, size, on_edges):
    """Planes of coarse cells; `on_edges`: the outer ones lie on the image's edges, as DeepLab's."""
    grid = F.affine_grid(maps, (len(maps), 1, size[1], size[0]), align_corners=False)
    return F.grid_sample(planes.float(), grid, padding_mode='border', align_corners=on_edges)


def soft_target(person, things, probabilities):
    """Probability of each class: people as labelled, the rest by true labels or by the teacher;
    who is a person to the teacher only is background."""
    others = probabilities ** SHARPNESS
    others[:, 0] = TAUGHT_BACKGROUND * (others[:, 0] + others[:, PERSON]) + 1e-3
    others[:, PERSON] = 0
    others /= others.sum(dim=1, keepdim=True)
    known = things != UNKNOWN
    truth = F.one_hot(torch.where(known, things, 0).long(), len(CLASSES)).permute(0, 3, 1, 2)
    target = torch.where(known[:, None], truth, others) * (1 - person)
    target[:, PERSON] = person[:, 0]
    return target


def shares_of_things(records):
    """Of the classes of things, background and people left out, for each record: n x classes."""
    known = records['things'][:, ::COARSE, ::COARSE]
    taught = records['probabilities'].mean(axis=(2, 3), dtype=np.float32) / 255
    unknown = (known == UNKNOWN).mean(axis=(1, 2), dtype=np.float32)
    true = np.stack([(known == number).mean(axis=(1, 2), dtype=np.float32)
                     for number in range(len(CLASSES))], axis=1)
    return np.delete(true + taught * unknown[:, None], (0, PERSON), axis=1)


def chances(shares):
    """How often each record is taken; `shares`: of things, see above."""
    things = (shares / np.maximum(shares.mean(axis=0), 1e-6)).mean(axis=1)
    weights = 1 + np.minimum(things, MOST_THINGS)
    return weights / weights.sum()


class Cache:
    def __init__(self, folder):
        self.folder, self.files, self.shares = folder, [], []
        self.look_again()

    def look_again(self):
        """Another process may have made more."""
        paths = sorted(self.folder.glob('*.images'))[len(self.files):]
        if not paths:
            return
        more = [np.memmap(path, RECORD, 'r') for path in paths]
        self.files += more
        self.shares += [shares_of_things(records) for records in more]
        self.chances = chances(np.concatenate(self.shares))

    def __len__(self):
        return RECORDS * len(self.files)

    def batch(self, rng, count, size, with_hints=True):
        """Images (0 to 255), target, weight; then hints in the order of hints.SHAPES."""
        chosen = rng.choice(len(self), count, p=self.chances)
        records = [self.files[number // RECORDS][number % RECORDS] for number in chosen]
        parts = [Part(rng) for _ in records]
        maps = torch.from_numpy(np.stack([part.map() for part in parts]))

        def pixels(name, interpolation=cv2.INTER_LINEAR):
            return torch.from_numpy(np.stack([part.of(record[name], size, interpolation)
                                              for part, record in zip(parts, records)]))

        def cells(name, stride):
            planes = torch.from_numpy(np.stack([record[name] for record in records]))
            return cells_of(planes, maps, [side // stride for side in size],
                            planes.shape[2:] == hints.SHAPES['deeplab'][1:])

        gains = np.exp(rng.normal(0, 0.12, (count, 1)) + rng.normal(0, 0.04, (count, 3)))
        images = pixels('image') * torch.from_numpy(gains.astype(np.float32))[:, None, None]
        labels = (pixels('labels') / 255).permute(0, 3, 1, 2)
        probabilities = F.interpolate(cells('probabilities', COARSE) / 255, scale_factor=COARSE,
                                      mode='bilinear', align_corners=False)
        target = soft_target(labels[:, :1], pixels('things', cv2.INTER_NEAREST), probabilities)
        features = [hints.STEP * cells(name, 2 ** hints.LEVELS[name])
                    for name in hints.SHAPES if with_hints]
        return images.clamp(0, 255).permute(0, 3, 1, 2), target, labels[:, 1:], *features
