"""A quick look at how training goes, on photographs that it never sees."""

import cv2
import numpy as np
import torch

from checkpoint import averaged_network
from network import normalised_input
from samples import Entry, load, quick_target

MOST_IMAGES = 100  # of each kind
AT_ONCE = 10


class HeldOut:
    """`photos`: held out; those with true masks and those of empty rooms are used."""

    def __init__(self, photos, kind, size):
        self.kind, self.size = kind, size
        masked = [photo for photo in photos if photo.mask_path][:MOST_IMAGES]
        rooms = [photo for photo in photos if photo.source == 'rooms']
        targets = [quick_target(photo) for photo in rooms]
        empty = [photo for photo, target in zip(rooms, targets)
                 if target is not None and Entry(photo, target).is_empty()]
        self.masked = [load(photo) for photo in masked]
        self.empty = [load(photo) for photo in empty[::max(1, len(empty) // MOST_IMAGES)]]

    def measure(self, checkpoint_file):
        """A line of text about the averaged weights."""
        network = averaged_network(checkpoint_file)
        both = either = 0
        for sample, person in zip(self.masked, self.found(network, self.masked)):
            truth, known = sample.target > 0.5, sample.weight > 0.5
            both += (person & truth & known).sum()
            either += ((person | truth) & known).sum()
        shares = [person.mean() for person in self.found(network, self.empty)]
        return (f'held out: IoU {both / max(1, either):.3f}, '
                f'{100 * np.mean(shares or [0]):.2f} % of empty rooms')

    def found(self, network, samples):
        """Yields the mask of people for each sample, at its size."""
        for first in range(0, len(samples), AT_ONCE):
            part = samples[first:first + AT_ONCE]
            images = np.stack([cv2.resize(sample.image, self.size)[:, :, ::-1].transpose(2, 0, 1)
                               for sample in part])
            with torch.no_grad():
                output = network(normalised_input(torch.from_numpy(images).float()))
                margins = self.kind.person(output).numpy()
            for sample, plane in zip(part, margins):
                yield cv2.resize(plane[0], sample.target.shape[::-1]) > 0
