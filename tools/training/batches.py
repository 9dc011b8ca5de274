"""Training batches: which photographs become which kinds of scenes."""

import cv2
import numpy as np
import torch
from torch.utils.data import Dataset

import class_labels
import samples
from camera import Camera, colours
from scene import add_clutter, any_shape, checked, log_uniform, placed_person, plain, view
from segnet import PERSON

# Shares of the kinds of images.
KINDS = {
    'people': 0.31,  # as photographed
    'pasted': 0.26,  # people in rooms and before desks
    'people_clutter': 0.12,  # people behind or in front of drawn clutter
    'clutter': 0.09,  # the same without people
    'room': 0.17,  # nobody
    'close': 0.05,  # a small part of a room fills the image
}
# The same for the SegNet, which learns the things in rooms, too.
CLASS_KINDS = {'people': 0.32, 'pasted': 0.18, 'people_clutter': 0.1, 'clutter': 0.06, 'room': 0.29,
               'close': 0.05}
# How often photographs of a source are taken, for those with people in them.
WEIGHTS = {'clothing': 1.0, 'pennfudan': 1.5, 'rooms': 3.0, 'sport': 2.0,
           'rendered': 8.0}
# The same for people to cut out: few photographs of sport have good outlines.
CUT_OUT_WEIGHTS = {'clothing': 1.0, 'pennfudan': 1.0, 'sport': 1.5}
# Of those without people the few by an RGB-D camera are most like what the network will see.
EMPTY_WEIGHTS = {'desks': 1.5, 'kitchen': 3.0, 'rendered': 2.0, 'rooms': 1.0}
# For a cache of the SegNet, from a few hundred desks.
CLASS_EMPTY_WEIGHTS = dict(EMPTY_WEIGHTS, desks=5.0)


def shares(entries, weights):
    found = np.array([weights[entry.photo.source] for entry in entries])
    return found / found.sum()


def piece_of(sample):
    """A function that gives random parts of a photograph, see objects.py."""
    def texture(rng, width, height):
        rows, columns = sample.image.shape[:2]
        part = rng.uniform(0.15, 0.6)
        y0, x0 = (int(rng.uniform(0, 1 - part) * side) for side in (rows, columns))
        crop = sample.image[y0:y0 + max(2, int(part * rows)), x0:x0 + max(2, int(part * columns))]
        return cv2.resize(crop, (width, height), interpolation=cv2.INTER_AREA)
    return texture


class Maker:
    """Makes single images, each from a random generator that is its own."""

    def __init__(self, collection, load=samples.load, kinds=None, empty_weights=None):
        self.collection, self.camera, self.load = collection, Camera(), load
        self.kinds = kinds or KINDS
        self.people_shares = shares(collection.people, WEIGHTS)
        self.empty_shares = shares(collection.empty, empty_weights or EMPTY_WEIGHTS)
        self.cut_out_shares = shares(collection.cut_outs, CUT_OUT_WEIGHTS)

    def make(self, rng):
        """An 8-bit BGR image and the scene that it shows."""
        kind = rng.choice(list(self.kinds), p=list(self.kinds.values()))
        texture_sample = self.load(self._empty(rng))
        texture = piece_of(texture_sample)
        scene = self._people(rng) if kind == 'people' else self._room(rng, kind == 'close')
        scene.image = colours(rng, scene.image, 0.8)
        if rng.random() < 0.3:
            self._decoy(rng, scene, texture_sample)
        clutter_first = rng.random() < 0.4
        if 'clutter' in kind and clutter_first:
            add_clutter(scene, rng, texture)
        for chance in {'people': (0.18,), 'pasted': (1, 0.3), 'people_clutter': (1, 0.25)}.get(
                kind, ()):
            if rng.random() < chance:
                self._paste_person(rng, scene)
        if 'clutter' in kind and not clutter_first:
            add_clutter(scene, rng, texture)
        if rng.random() < 0.25:
            scene.cover(self._filling(rng, texture_sample), any_shape(rng))
        return self.camera.photograph(rng, scene.image), scene

    def _empty(self, rng):
        return self.collection.empty[rng.choice(len(self.empty_shares), p=self.empty_shares)].photo

    def _people(self, rng):
        entry = self.collection.people[rng.choice(len(self.people_shares), p=self.people_shares)]
        sample = self.load(entry.photo)
        height, width = sample.image.shape[:2]
        if rng.random() < 0.15:
            return view(rng, sample, log_uniform(rng, 0.8, 2.2))
        x0, y0, x1, y1 = entry.box
        focus = rng.uniform(x0, x1) * width, rng.uniform(y0, y1) * height
        return view(rng, sample, log_uniform(rng, 0.6, 2.8), focus)

    def _room(self, rng, close):
        zoom = log_uniform(rng, 2, 5) if close else log_uniform(rng, 0.8, 2.2)
        return view(rng, self.load(self._empty(rng)), zoom)

    def _cut_out(self, rng, any_turn=False):
        entry = self.collection.cut_outs[rng.choice(len(self.cut_out_shares),
                                                    p=self.cut_out_shares)]
        return placed_person(rng, self.load(entry.photo), entry.box, any_turn)

    def _filling(self, rng, sample):
        """An image to fill a shape with."""
        if rng.random() < 0.3:
            return plain(rng.uniform(0, 255, 3) * rng.uniform(0.3, 1))
        return colours(rng, view(rng, sample, log_uniform(rng, 0.8, 3)).image)

    def _decoy(self, rng, scene, sample):
        """Something that has the outline of a person, or any, and is none."""
        opacity = self._cut_out(rng, True)[1] if rng.random() < 0.25 else any_shape(rng)
        scene.cover(self._filling(rng, sample), opacity)

    def _paste_person(self, rng, scene):
        """Brightness is brought towards that of the scene, or it would tell who was pasted."""
        image, opacity = self._cut_out(rng)
        image = colours(rng, image)
        if rng.random() < 0.25:
            image = np.ascontiguousarray(image[:, :, rng.permutation(3)])
        if rng.random() < 0.2:
            image = checked(rng, image)
        mine = np.mean(cv2.mean(image, (opacity > 0.5).astype(np.uint8))[:3])
        theirs = np.mean(cv2.mean(scene.image)[:3])
        gain = np.clip(theirs / max(12, mine), 0.3, 3) ** rng.uniform(0, 1)
        scene.cover(cv2.convertScaleAbs(image, alpha=gain), opacity, is_person=True)


class Images(Dataset):
    """Image `i` of a training is the same whenever it is made: a resumed training goes on with the
    images that it would have had. `size`: width and height for the network."""

    def __init__(self, collection, seed, first, count, size):
        self.maker, self.size = self.make_maker(collection), size
        self.seed, self.first, self.count = seed, first, count

    def make_maker(self, collection):
        return Maker(collection)

    def target_of(self, scene):
        return self.resized(scene.target)

    def resized(self, plane, interpolation=cv2.INTER_AREA):
        if plane.shape[1::-1] == self.size:
            return plane
        return cv2.resize(plane, self.size, interpolation=interpolation)

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        if index >= self.count:
            raise IndexError(index)
        image, scene = self.maker.make(np.random.default_rng([self.seed, self.first + index]))
        pixels = np.ascontiguousarray(self.resized(image)[:, :, ::-1].transpose(2, 0, 1))
        planes = [torch.from_numpy(plane.astype(np.float32))[None]
                  for plane in (self.target_of(scene), self.resized(scene.weight))]
        return torch.from_numpy(pixels), *planes


class ClassImages(Images):
    """The same scenes; the target is the SegNet's class of every pixel."""

    def make_maker(self, collection):
        return Maker(collection, class_labels.load, CLASS_KINDS)

    def target_of(self, scene):
        classes = np.where(scene.target > 0.5, np.uint8(PERSON), scene.things)
        return self.resized(classes, cv2.INTER_NEAREST)
