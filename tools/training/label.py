#!/usr/bin/python3
"""Labels photographs with the teachers. What has been labelled before is left as it is."""

import argparse
import os
import random
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402

from sources import ARCHIVES, photographs  # noqa: E402
from class_labels import ClassTeacher  # noqa: E402
from teachers import Teachers  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('models', type=Path,
                        help='folder with deeplabv3_mnv2_voc21.onnx, bodypix_mnv1_075_person.onnx')
    parser.add_argument('--source', action='append', choices=ARCHIVES, help='default: all')
    parser.add_argument('--classes', action='store_true',
                        help='all classes by DeepLab, for the SegNet, instead of people')
    parser.add_argument('--masked', action='store_true', help='those with a true mask, too')
    parser.add_argument('--threads', type=int, default=2)
    return parser.parse_args()


def write_whole(path, image):
    """Never leaves half a file behind."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix('.part.png')
    cv2.imwrite(str(unfinished), image)
    os.replace(unfinished, path)


def to_label(args):
    """Photographs and the files for their labels, mixed: whoever stops early has some of each. A true
    mask says nothing of other classes."""
    photos = photographs(args.work, args.source or ARCHIVES)
    random.Random(0).shuffle(photos)
    if args.classes:
        return [(photo, photo.classes_path) for photo in photos]
    return [(photo, photo.teachers_path) for photo in photos
            if args.masked or not photo.mask_path]


def main():
    args = arguments()
    cv2.setNumThreads(args.threads)
    teacher = ClassTeacher(args.models) if args.classes else Teachers(args.models)
    missing = [(photo, path) for photo, path in to_label(args) if not path.exists()]
    start = time.monotonic()
    for count, (photo, path) in enumerate(missing, 1):
        write_whole(path, teacher.label(cv2.imread(str(photo.path))))
        if count % 200 == 0 or count == len(missing):
            print(f'{count} of {len(missing)}, {time.monotonic() - start:.0f} s', flush=True)


main()
