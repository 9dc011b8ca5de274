#!/usr/bin/python3
"""Measures networks that find people: overlap with true masks, false positives where nobody is,
time; for a SegNet the overlap of its classes, too.

The photographs are those that training holds out, see sources.py. Sets that are not there are left
out."""

import argparse
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402

import caffe_files  # noqa: E402
import class_labels  # noqa: E402
from network import INPUT_HEIGHT, INPUT_WIDTH  # noqa: E402
from samples import Entry, quick_target  # noqa: E402
from segnet import CLASSES, PERSON  # noqa: E402
from segnet_reader import SegNetReader  # noqa: E402
from sources import photographs  # noqa: E402
from teachers import VOC_PERSON, enlarge  # noqa: E402

FR1_EVERY = 5
TIMED_RUNS = 60
ROOMS = 200  # empty rooms looked at
NEAR_PEOPLE = 20  # pixels
MUCH = 3  # per cent of an image called a person where nobody is
THRESHOLDS = (-2, -1.5, -1.25, -1, -0.75, -0.5, 0, 0.5, 1, 2, 3)


def reader_of(path):
    """OpenCV's; its importer knows no SegNet."""
    return SegNetReader(path) if path.suffix == '.caffemodel' else cv2.dnn.readNet(str(path))


class Network:
    """A network, its input, and the score of a pixel: a person where it is above the margin."""

    def __init__(self, path, size, scale, mean, score, output=None, margin=0.0):
        self.name, self.size, self.scale, self.mean = Path(path).stem, size, scale, mean
        self.reader, self.output, self.score_of = reader_of(path), output, score
        self.margin = margin

    def forward(self, image):
        blob = cv2.dnn.blobFromImage(image, self.scale, self.size, (self.mean,) * 3, True)
        self.reader.setInput(blob)
        return (self.reader.forward(self.output) if self.output else self.reader.forward())[0]

    def scores(self, image):
        return self.score_of(self.forward(image), self.size, image.shape[1::-1])


def from_logits(planes, _, size):
    return cv2.resize(planes[0], size)


def from_probabilities(planes, _, size):
    return cv2.resize(planes[0], size) - 0.5


def from_classes(planes, network_size, size):
    """How far the person's logit lies above the best other."""
    large = np.stack([enlarge(plane, network_size, size) for plane in planes])
    person = large[VOC_PERSON].copy()
    large[VOC_PERSON] = -np.inf
    return person - large.max(axis=0)


def from_segnet(planes, _, size):
    others = np.delete(planes, PERSON, axis=0).max(axis=0)
    return cv2.resize(planes[PERSON] - others, size)


def own_network(path, margin):
    if path.suffix == '.caffemodel':  # the plugin takes the best class: no margin
        size = caffe_files.input_size(path)
        return Network(path, size, 1 / 128, 128, from_segnet)
    size = (INPUT_WIDTH, INPUT_HEIGHT)
    return Network(path, size, 1 / 128, 128, from_logits, margin=margin)


def known_networks(folder):
    """Published ones to compare with, as far as they are in the folder."""
    makers = {
        'selfie_segmentation_landscape.onnx':
            lambda path: Network(path, (256, 144), 1 / 255, 0, from_probabilities),
        'deeplabv3_mnv2_dm05_voc21.onnx':
            lambda path: Network(path, (385, 289), 1 / 128, 128, from_classes, 'logits'),
        'deeplabv3_mnv2_voc21.onnx':
            lambda path: Network(path, (513, 385), 1 / 128, 128, from_classes, 'logits')}
    return [make(folder / name) for name, make in makers.items() if (folder / name).exists()]


class Overlap:
    def __init__(self):
        self.both = self.found = self.truth = 0

    def add(self, person, truth, known=True):
        self.both += np.count_nonzero(person & truth & known)
        self.found += np.count_nonzero(person & known)
        self.truth += np.count_nonzero(truth & known)

    def __str__(self):
        either = self.found + self.truth - self.both
        return (f'{self.both / max(1, either):.3f}/{self.both / max(1, self.found):.2f}/'
                f'{self.both / max(1, self.truth):.2f}')


class Share:
    """Of pixels that are called a person where there is nobody."""

    def __init__(self):
        self.shares = []

    def add(self, person):
        self.shares.append(100 * person.mean())

    def largest_above(self, percent):
        return f'{100 * np.mean(np.array(self.shares) > percent):.0f} % of images'

    def __str__(self):
        return f'{np.mean(self.shares):.2f} % (most {np.max(self.shares):.1f} %)'


def read(path):
    return cv2.imread(str(path))


def annotated_frames(shared):
    """Image, truth, and which pixels are known, of two frames of TUM fr3."""
    for path in sorted((shared / 'photos').glob('*_gt.png')):
        truth = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        yield read(path.with_name(path.name.replace('_gt', ''))), truth > 192, truth != 128


def masked_photographs(work, source):
    for photo in photographs(work, (source,)):
        if photo.held_out and photo.mask_path:
            mask = cv2.imread(str(photo.mask_path), cv2.IMREAD_GRAYSCALE)
            yield read(photo.path), mask > 127, True


def empty_rooms(work):
    """Held out; the teachers agree that nobody is there."""
    rooms = []
    for photo in photographs(work, ('rooms',)):
        target = quick_target(photo) if photo.held_out else None
        if target is not None and Entry(photo, target).is_empty():
            rooms.append(photo)
    return [read(photo.path) for photo in rooms[:ROOMS]]


def frames(folder, every=1):
    paths = sorted(path for path in folder.glob('*') if path.suffix in ('.png', '.jpg'))
    return [read(path) for path in paths[::every]]


def masked_sets(args):
    sets = {}
    if args.shared:
        sets['annotated TUM frames'] = list(annotated_frames(args.shared))
    if args.work:
        for source in ('clothing', 'pennfudan'):
            sets[f'{source}, held out'] = list(masked_photographs(args.work, source))
    return {name: images for name, images in sets.items() if images}


def empty_sets(args):
    sets = {}
    if args.shared:
        sets['fr1_xyz'] = frames(args.shared / 'data/tum_fr1_xyz/rgb', FR1_EVERY)
    if args.work:
        sets['empty rooms, held out'] = empty_rooms(args.work)
    return {name: images for name, images in sets.items() if images}


def overlaps(network, images, thresholds=None):
    """One Overlap per threshold of the score; of the network's margin when none is given."""
    thresholds = thresholds or (network.margin,)
    results = [Overlap() for _ in thresholds]
    for image, truth, known in images:
        scores = network.scores(image)
        for result, threshold in zip(results, thresholds):
            result.add(scores > threshold, truth, known)
    return results


def shares(network, images, thresholds=None):
    thresholds = thresholds or (network.margin,)
    results = [Share() for _ in thresholds]
    for image in images:
        scores = network.scores(image)
        for result, threshold in zip(results, thresholds):
            result.add(scores > threshold)
    return results


def shares_elsewhere(network, other, images):
    """Of pixels called a person away from the people whom another network sees."""
    result = Share()
    for image in images:
        seen = (other.scores(image) > other.margin).astype(np.uint8)
        near = cv2.dilate(seen, np.ones((2 * NEAR_PEOPLE + 1,) * 2)) > 0
        result.add((network.scores(image) > network.margin) & ~near)
    return result


def agreement(network, other, images):
    result = Overlap()
    for image in images:
        result.add(network.scores(image) > network.margin, other.scores(image) > other.margin)
    return result


def milliseconds(networks, image):
    """Median and least time of blob and forward pass of each network, taking turns."""
    times = {network.name: [] for network in networks}
    for _ in range(TIMED_RUNS):
        for network in networks:
            start = time.perf_counter()
            network.forward(image)
            times[network.name].append(1000 * (time.perf_counter() - start))
    return {name: f'{np.median(taken[5:]):.1f} ms (least {min(taken):.1f})'
            for name, taken in times.items()}


def table(rows, networks):
    names = [network.name for network in networks]
    print('| set | ' + ' | '.join(names) + ' |\n|---|' + '---|' * len(names))
    for title, values in rows.items():
        print(f'| {title} | ' + ' | '.join(str(value) for value in values) + ' |', flush=True)


def compare(networks, masked, empty, args):
    rows = {}
    for title, images in masked.items():
        rows[f'{title}: IoU/precision/recall'] = [overlaps(network, images)[0]
                                                  for network in networks]
    for title, images in empty.items():
        rows[f'{title}: called a person'] = [shares(network, images)[0] for network in networks]
    best = [network for network in networks if network.name == 'deeplabv3_mnv2_voc21']
    if best and 'fr1_xyz' in empty:
        elsewhere = [shares_elsewhere(network, best[0], empty['fr1_xyz']) for network in networks]
        rows['fr1_xyz: called a person where VOC21 sees nobody near'] = elsewhere
        rows[f'fr1_xyz: the same, more than {MUCH} %'] = [share.largest_above(MUCH)
                                                         for share in elsewhere]
    if best and args.shared:
        images = frames(args.shared / 'data/tum_fr3_walking_halfsphere_rgb')
        rows['fr3_walking_halfsphere: IoU/precision/recall against VOC21'] = [
            agreement(network, best[0], images) for network in networks]
    table(rows, networks)


def class_overlaps(network, photos):
    """IoU per class against the teacher's sure labels, and the share of pixels that agree."""
    seen = np.zeros((len(CLASSES),) * 2)  # by the teacher's class and the network's
    for photo in photos:
        image = read(photo.path)
        found = class_labels.read(photo, image.shape[1::-1])
        if found is None:
            continue
        classes = cv2.resize(network.forward(image).argmax(axis=0).astype(np.uint8),
                             image.shape[1::-1], interpolation=cv2.INTER_NEAREST)
        sure = found[1] > 0.5
        pairs = len(CLASSES) * found[0][sure].astype(int) + classes[sure]
        seen += np.bincount(pairs, minlength=seen.size).reshape(seen.shape)
    either = seen.sum(axis=0) + seen.sum(axis=1) - np.diag(seen)
    return np.diag(seen) / np.maximum(1, either), np.trace(seen) / max(1, seen.sum())


def print_classes(network, work):
    rooms = [photo for photo in photographs(work, ('rooms',)) if photo.held_out]
    ious, agreeing = class_overlaps(network, rooms)
    print(f'\n{network.name}, held-out rooms, IoU against VOC21 where it is sure; '
          f'{100 * agreeing:.1f} % of pixels agree')
    for name, iou in zip(CLASSES, ious):
        print(f'{name}: {iou:.3f}')


def sweep(network, masked, empty):
    """What another threshold of the logit would give."""
    columns = [overlaps(network, images, THRESHOLDS) for images in masked.values()]
    columns += [shares(network, images, THRESHOLDS) for images in empty.values()]
    titles = list(masked) + list(empty)
    print(f'\n{network.name}\n| threshold | ' + ' | '.join(titles) + ' |\n|---|' +
          '---|' * len(titles))
    for threshold, values in zip(THRESHOLDS, zip(*columns)):
        print(f'| {threshold} | ' + ' | '.join(map(str, values)) + ' |')


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('onnx', type=Path, nargs='*',
                        help="networks of this project's own; a SegNet's .caffemodel, too")
    parser.add_argument('--work', type=Path, help='working folder: the photographs held out')
    parser.add_argument('--shared', type=Path, help='shared folder: data, photos')
    parser.add_argument('--compare', type=Path, action='append', default=[],
                        help='folder with published networks, by their names')
    parser.add_argument('--margin', type=float, default=-0.25,
                        help='least logit of a person for the own networks, as in person.yaml')
    parser.add_argument('--sweep', action='store_true', help='thresholds of the own networks, too')
    parser.add_argument('--time', action='store_true', help='time instead of accuracy')
    parser.add_argument('--threads', type=int, default=2)
    return parser.parse_args()


def main():
    args = arguments()
    cv2.setNumThreads(args.threads)
    own = [own_network(path, args.margin) for path in args.onnx]
    networks = own + [network for folder in args.compare for network in known_networks(folder)]
    if args.time:
        image = np.random.RandomState(0).randint(0, 256, (480, 640, 3), np.uint8)
        for name, taken in milliseconds(networks, image).items():
            print(f'{name}: {taken}')
        return
    masked, empty = masked_sets(args), empty_sets(args)
    compare(networks, masked, empty, args)
    for network in own if args.work else []:
        if isinstance(network.reader, SegNetReader):
            print_classes(network, args.work)
    for network in own if args.sweep else []:
        sweep(network, masked, empty)


if __name__ == '__main__':
    main()
