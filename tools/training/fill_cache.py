#!/usr/bin/python3
"""Makes images for the SegNet's training and shows them to the teachers: see cache.py. Goes on where
it stopped; training may use what there is meanwhile."""

import argparse
import os
import pickle
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402
import torch  # noqa: E402

import cache  # noqa: E402
import class_labels  # noqa: E402
import hints  # noqa: E402
from batches import CLASS_EMPTY_WEIGHTS, CLASS_KINDS, Maker  # noqa: E402
from samples import Collection  # noqa: E402
from sources import photographs  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('person', type=Path, help='person_320x256.onnx')
    parser.add_argument('deeplab', type=Path, help='deeplabv3_mnv2_voc21.onnx')
    parser.add_argument('--count', type=int, default=20000, help='images')
    return parser.parse_args()


def small(plane):
    return cv2.resize(plane, (cache.WIDTH, cache.HEIGHT), interpolation=cv2.INTER_AREA)


def records_of(maker, teachers, number):
    """The records of one file, but for features: these are as the teachers have them."""
    records, features = np.zeros(cache.RECORDS, cache.RECORD), []
    for index, record in enumerate(records):
        image, scene = maker.make(np.random.default_rng([number, index]))
        found, probabilities = teachers.look_at(scene.image)  # without noise and blur
        features.append(found)
        record['image'] = small(image)[:, :, ::-1]
        labels = np.stack([small(scene.target), small(scene.weight)], axis=2)
        record['labels'] = np.round(255 * np.clip(labels, 0, 1))
        record['things'] = cv2.resize(scene.things, (cache.WIDTH, cache.HEIGHT),
                                      interpolation=cv2.INTER_NEAREST)
        record['probabilities'] = np.round(255 * probabilities)
    return records, {name: np.stack([found[name] for found in features]) for name in hints.SHAPES}


def scales_of(folder, features):
    """Those of the first file, for all."""
    path = folder / 'scales.pickle'
    if not path.exists():
        scales = {name: hints.Scale(values) for name, values in features.items()}
        path.write_bytes(pickle.dumps(scales))
    return pickle.loads(path.read_bytes())


def main():
    args = arguments()
    cv2.setNumThreads(1)
    torch.set_num_threads(1)
    folder = args.work / 'cache'
    folder.mkdir(exist_ok=True)
    collection = Collection(photo for photo in photographs(args.work) if not photo.held_out)
    print(collection, flush=True)
    maker = Maker(collection, class_labels.load_true, CLASS_KINDS, CLASS_EMPTY_WEIGHTS)
    teachers = hints.Teachers(args.person, args.deeplab)
    start = time.monotonic()
    for number in range(args.count // cache.RECORDS):
        path = folder / f'{number:06}.images'
        if path.exists():
            continue
        records, features = records_of(maker, teachers, number)
        for name, scale in scales_of(folder, features).items():
            records[name] = scale.stored(features[name])
        unfinished = path.with_suffix('.part')
        records.tofile(unfinished)
        os.replace(unfinished, path)
        print(f'{number}, {time.monotonic() - start:.0f} s', flush=True)


main()
