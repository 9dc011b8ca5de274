"""Photographs with what is known about the people in them, and which of them serve for what."""

import cv2
import numpy as np

from sources import EMPTY_SOURCES, INCOMPLETE_MASKS

DEEPLAB_SHARE = 0.55  # of the two teachers' mean; DeepLab's outlines are better
MASK_MARGIN = 13  # pixels around a true mask where teachers may well be wrong
SURE_OF_NOBODY = 0.12  # highest probability, averaged over PEAK_CELLS, in an empty photograph
PEAK_CELLS = 7  # of the stored labels
SOURCES_OF_PEOPLE = ('clothing', 'pennfudan', 'sport')  # in all others most images are empty


class Sample:
    """A BGR image; `target`: probability of a person; `weight`: how far to believe it (0 to 1);
    `things`: the SegNet's class of what is no person, where that is asked for (class_labels.py)."""

    def __init__(self, image, target, weight, things=None):
        self.image, self.target, self.weight, self.things = image, target, weight, things


def teachers_opinion(photo):
    """Mean probability of the teachers and how much it is worth, at the size they are stored."""
    stored = cv2.imread(str(photo.teachers_path), cv2.IMREAD_COLOR).astype(np.float32) / 255
    deeplab, bodypix = stored[:, :, 0], stored[:, :, 1]
    mean = DEEPLAB_SHARE * deeplab + (1 - DEEPLAB_SHARE) * bodypix
    sure = np.maximum(np.abs(2 * mean - 1), 0.15)
    return mean, sure * (1 - 0.6 * np.abs(deeplab - bodypix))


def resized(plane, size):
    return cv2.resize(plane, size, interpolation=cv2.INTER_LINEAR)


def ignore_strangers(photo, mask, weight):
    """Takes the weight of people whom the teachers see and the true mask leaves out."""
    if photo.source not in INCOMPLETE_MASKS or not photo.teachers_path.exists():
        return
    seen = resized(teachers_opinion(photo)[0], mask.shape[::-1]) > 0.2
    near_mask = cv2.dilate((mask > 0.5).astype(np.uint8), np.ones((2 * MASK_MARGIN + 1,) * 2))
    weight[seen & (near_mask == 0)] = 0


def load(photo):
    """The photograph as a Sample (8-bit image, the rest float), or None when nothing labels it."""
    image = cv2.imread(str(photo.path))
    height, width = image.shape[:2]
    if photo.source in EMPTY_SOURCES:
        nobody = np.zeros((height, width), np.float32)
        return Sample(image, nobody, nobody + 1)
    if photo.mask_path:
        mask = cv2.imread(str(photo.mask_path), cv2.IMREAD_GRAYSCALE).astype(np.float32) / 255
        mask = resized(mask, (width, height))
        weight = np.ones_like(mask)
        ignore_strangers(photo, mask, weight)
        return Sample(image, mask, weight)
    if not photo.teachers_path.exists():
        return None
    target, weight = teachers_opinion(photo)
    return Sample(image, resized(target, (width, height)), resized(weight, (width, height)))


class Entry:
    """What the choice of a photograph needs to know of it; `box`: of its people, as x0, y0, x1, y1
    in shares of the image's size."""

    def __init__(self, photo, target):
        self.photo = photo
        person = target > 0.5
        self.share = float(person.mean())
        self.unsure = float(((target > 0.2) & (target < 0.8)).mean())
        self.peak = float(cv2.blur(target, (PEAK_CELLS, PEAK_CELLS)).max())
        self.box = box_of(person)

    def has_people(self):
        return self.share > 0.01 and self.peak > 0.8 and self.unsure < 1.5 * self.share + 0.01

    def has_good_outline(self):
        return (self.photo.source in SOURCES_OF_PEOPLE and self.share > 0.02 and
                self.peak > 0.9 and self.unsure < 0.7 * self.share)

    def is_empty(self):
        return self.photo.source not in SOURCES_OF_PEOPLE and self.share == 0 and (
            self.peak < SURE_OF_NOBODY)


def box_of(person):
    rows, columns = np.flatnonzero(person.any(axis=1)), np.flatnonzero(person.any(axis=0))
    if rows.size == 0:
        return 0.0, 0.0, 1.0, 1.0
    height, width = person.shape
    return (columns[0] / width, rows[0] / height, (columns[-1] + 1) / width,
            (rows[-1] + 1) / height)


def quick_target(photo):
    """The target at whatever size is cheapest, or None when nothing labels the photograph."""
    if photo.source in EMPTY_SOURCES:
        return np.zeros((8, 8), np.float32)
    if photo.mask_path:
        mask = cv2.imread(str(photo.mask_path), cv2.IMREAD_GRAYSCALE)
        return cv2.resize(mask, None, fx=0.5, fy=0.5).astype(np.float32) / 255
    if not photo.teachers_path.exists():
        return None
    return teachers_opinion(photo)[0]


class Collection:
    """The photographs by use: `people` as they are, `cut_outs` to paste, `empty` rooms."""

    def __init__(self, photos):
        self.people, self.cut_outs, self.empty = [], [], []
        for photo in photos:
            target = quick_target(photo)
            if target is None:
                continue
            entry = Entry(photo, target)
            if entry.has_people():
                self.people.append(entry)
            if entry.has_good_outline():
                self.cut_outs.append(entry)
            if entry.is_empty():
                self.empty.append(entry)

    def __str__(self):
        return (f'{len(self.people)} photographs with people, {len(self.cut_outs)} to cut out, '
                f'{len(self.empty)} empty')
