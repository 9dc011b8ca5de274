#!/usr/bin/python3
"""Makes images of the simulator's rooms, with people who walk and sit near the camera, and their
true classes: a source of its own, WORK/images/rendered, WORK/classes/rendered. Interrupted, it goes
on with the recording after the last whole one."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402

from sources import photographs  # noqa: E402
from teachers import VOC_PERSON  # noqa: E402

SIZE = (384, 288)  # kept
CHAIRS = ((-1.02, 0.28, 33), (0.95, 0.22, 142))  # x, y, heading of who sits at the desks
PHOTOGRAPHIC = 0.6  # share of the recordings


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('stillpoint', type=Path, help='the program')
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('--recordings', type=int, default=40)
    parser.add_argument('--frames', type=int, default=12, help='of each, a second apart')
    return parser.parse_args()


def numbers(values):
    return '[' + ', '.join(f'{value:.2f}' for value in values) + ']'


def somebody(rng):
    looks = (f'height: {rng.uniform(1.55, 1.95):.2f}, seed: {rng.integers(1000)}, '
             f'shirt: {rng.choice(["plaid", "striped", "plain"])}')
    if rng.random() < 0.4:
        x, y, heading = CHAIRS[int(rng.integers(2))]
        place, heading = numbers((x, y) + rng.normal(0, 0.08, 2)), heading + rng.normal(0, 25)
        return f'    - {{pose: sit, path: {place}, heading: {heading:.0f}, {looks}}}\n'
    path = np.column_stack([rng.uniform(-1.6, 1.6, 5), rng.uniform(-1.3, 0.1, 5)]).ravel()
    return (f'    - {{pose: walk, path: {numbers(path)}, speed: {rng.uniform(0.5, 1.1):.2f}, '
            f'{looks}}}\n')


def scene(rng, office, rooms):
    """A scene file: as `office`, with a camera, pictures and people of its own."""
    kind = rng.choice(['xyz', 'rpy', 'halfsphere'])
    extent = rng.uniform(0.2, 0.5) if kind == 'rpy' else rng.uniform(0.8, 1.8)
    position = rng.uniform((-1.2, -2.3, 1.1), (1.2, -1.2, 1.7))
    target = rng.uniform((-1.2, 0.0, 0.6), (1.2, 1.2, 1.3))
    photographs_of = f', photographs: {rooms}' if rng.random() < PHOTOGRAPHIC else ''
    people = ''.join(somebody(rng) for _ in range(rng.choice(4, p=(0.25, 0.25, 0.3, 0.2))))
    return (f'version: 1\nextends: {office}\nsource:\n  rate: 1\n'
            f'  room: {{seed: {rng.integers(10, 10000)}{photographs_of}}}\n'
            f'  motion: {{kind: {kind}, position: {numbers(position)}, '
            f'look_at: {numbers(target)}, extent: {extent:.2f}}}\n' +
            (f'  people:\n{people}' if people else ''))


def keep(recording, work, number):
    """Frames, masks of people and classes of a recording, at SIZE."""
    images, classes = work / 'images/rendered', work / 'classes/rendered'
    for index, path in enumerate(sorted((recording / 'rgb').glob('*.png'))):
        name = f'{number:04}_{index:02}'
        found = cv2.resize(cv2.imread(str(recording / 'labels' / path.name), cv2.IMREAD_GRAYSCALE),
                           SIZE, interpolation=cv2.INTER_NEAREST)
        sure = np.stack([found, np.full_like(found, 255), 0 * found], axis=2)
        cv2.imwrite(str(classes / f'{name}.png'), sure)
        person = np.where(found == VOC_PERSON, np.uint8(255), np.uint8(0))
        cv2.imwrite(str(images / f'{name}.png'), person)
        image = cv2.resize(cv2.imread(str(path)), SIZE, interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(images / f'{name}.webp'), image, [cv2.IMWRITE_WEBP_QUALITY, 95])


def main():
    args = arguments()
    office = Path(__file__).resolve().parents[2] / 'configs/scenes/office.yaml'
    for kind in ('images', 'classes'):
        (args.work / kind / 'rendered').mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / 'rooms').mkdir()
        for photo in photographs(args.work, ('rooms',))[:2000]:
            if not photo.held_out:
                (folder / 'rooms' / photo.path.name).symlink_to(photo.path.resolve())
        for number in range(args.recordings):
            if (args.work / f'images/rendered/{number:04}_{args.frames - 1:02}.webp').exists():
                continue
            path, recording = folder / 'scene.yaml', folder / f'{number}'
            path.write_text(scene(np.random.default_rng(number), office, folder / 'rooms'))
            subprocess.run([args.stillpoint, 'simulate', path, '-o', recording, '--frames',
                            str(args.frames)], check=True, stdout=subprocess.DEVNULL)
            keep(recording, args.work, number)


if __name__ == '__main__':
    main()
