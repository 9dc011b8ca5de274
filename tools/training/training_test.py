#!/usr/bin/python3
"""Trains on a few made-up images: prepare, train, resume, export, read back, evaluate.

Skips (exit code 77) without the packages that training needs."""

import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
SKIPPED = 77

try:
    import cv2
    import numpy as np
    import torch
except ImportError as error:
    print(f'skipped: {error}; see tools/training/README.md')
    sys.exit(SKIPPED)

import export  # noqa: E402
import onnx_weights  # noqa: E402
from batches import Images  # noqa: E402
from checkpoint import averaged_network  # noqa: E402
from network import PersonNetwork, folded, normalised_input, set_weights  # noqa: E402
from samples import Collection, load  # noqa: E402
from sources import Photograph, is_held_out, photographs  # noqa: E402
from teachers import input_size, label_size  # noqa: E402

HERE = Path(__file__).parent
IMAGES = 4  # of each source


def call(script, *arguments):
    """Runs a script as a user does; what it printed."""
    done = subprocess.run([sys.executable, str(HERE / script), *map(str, arguments)],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(f'{script}: {done.stderr}')
    return done.stdout


def picture(rng):
    return rng.integers(0, 256, (96, 128, 3), np.uint8)


def make_archives(folder):
    """People are rectangles with true masks; rooms and kitchens are noise, rooms with labels."""
    rng = np.random.default_rng(1)
    for source in ('clothing', 'kitchen', 'rooms'):
        for number in range(IMAGES):
            stem = folder / f'{source}_{number}'
            cv2.imwrite(f'{stem}.webp', picture(rng))
            if source == 'clothing':
                mask = np.zeros((96, 128), np.uint8)
                mask[20:90, 40:80] = 255
                cv2.imwrite(f'{stem}.png', mask)
        with tarfile.open(folder / f'{source}.tar', 'w') as tar:
            for path in sorted(folder.glob(f'{source}_*')):
                tar.add(path, f'{source}/{path.name}')


def make_teachers(work):
    for photo in photographs(work, ('rooms',)):
        photo.teachers_path.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(photo.teachers_path), np.zeros((48, 64, 3), np.uint8))


class Trained(unittest.TestCase):
    """Two iterations, interrupted after the first of them."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.work, cls.output, cls.onnx = root / 'work', root / 'run', root / 'net.onnx'
        archives = root / 'archives'
        archives.mkdir()
        make_archives(archives)
        call('prepare.py', archives, cls.work)
        make_teachers(cls.work)
        cls.said = [cls.train(1), cls.train(2)]
        call('export.py', cls.output / 'checkpoint.pt', cls.onnx)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def train(cls, iterations, *more):
        return call('train.py', cls.work, cls.output, '--iterations', iterations, '--batch', 2,
                    '--workers', 0, '--save-every', 1, '--device', 'cpu', '--precision', 'float',
                    *more)

    def test_goes_on_where_it_stopped(self):
        self.assertIn('1 of 1', self.said[0])
        self.assertIn('2 of 2', self.said[1])
        self.assertNotIn('1 of 2', self.said[1])

    def test_opencv_computes_what_torch_does(self):
        network = averaged_network(self.output / 'checkpoint.pt')
        self.assertLess(export.difference(network, self.onnx), 1e-3)

    def test_weights_are_read_back(self):
        network = averaged_network(self.output / 'checkpoint.pt')
        copy = PersonNetwork(normalise=False).eval()
        set_weights(copy, onnx_weights.read(self.onnx))
        image = normalised_input(torch.full((1, 3, 64, 96), 100.0))
        with torch.no_grad():
            self.assertTrue(torch.allclose(network(image), copy(image), atol=1e-5))

    def test_trains_further_from_exported_weights(self):
        output = self.work.parent / 'further'
        said = call('train.py', self.work, output, '--iterations', 1, '--batch', 2, '--workers', 0,
                    '--device', 'cpu', '--start', self.onnx)
        self.assertIn('1 of 1', said)
        self.assertFalse(torch.load(output / 'checkpoint.pt')['normalise'])

    def test_evaluates_held_out_photographs(self):
        said = call('evaluate.py', self.onnx, '--work', self.work)
        self.assertIn('clothing, held out', said)
        self.assertIn('empty rooms, held out', said)

    def test_images_do_not_depend_on_when_they_are_made(self):
        collection = Collection(photo for photo in photographs(self.work) if not photo.held_out)
        late = Images(collection, 3, 5, 4)[0]
        early = Images(collection, 3, 0, 9)[5]
        self.assertTrue(all(torch.equal(a, b) for a, b in zip(late, early)))

    def test_refuses_weights_of_another_network(self):
        other = self.work.parent / 'other.onnx'
        torch.onnx.export(torch.nn.Conv2d(3, 4, 1), torch.zeros(1, 3, 8, 8), str(other))
        with self.assertRaisesRegex(ValueError, 'another network'):
            set_weights(PersonNetwork(normalise=False), onnx_weights.read(other))

    def test_refuses_a_truncated_file(self):
        cut = self.work.parent / 'cut.onnx'
        cut.write_bytes(self.onnx.read_bytes()[:100000])
        with self.assertRaisesRegex(ValueError, 'no ONNX network'):
            onnx_weights.read(cut)


class Parts(unittest.TestCase):
    def test_every_tenth_image_of_three_sources_is_held_out(self):
        self.assertTrue(is_held_out('rooms', 0) and is_held_out('pennfudan', 20))
        self.assertFalse(is_held_out('rooms', 1) or is_held_out('kitchen', 0))

    def test_folding_keeps_the_output(self):
        network = PersonNetwork(normalise=True).eval()
        image = torch.rand(1, 3, 64, 96)
        with torch.no_grad():
            self.assertTrue(torch.allclose(network(image), folded(network)(image), atol=1e-5))

    def test_sizes_for_teachers(self):
        self.assertEqual(input_size(384, 256), (385, 257))
        self.assertEqual(input_size(256, 256), (385, 385))
        self.assertEqual(label_size(384, 256), (192, 128))

    def test_nothing_is_known_of_a_photograph_without_labels(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / 'images/rooms/a.webp'
            path.parent.mkdir(parents=True)
            cv2.imwrite(str(path), picture(np.random.default_rng(2)))
            self.assertIsNone(load(Photograph(folder, 'rooms', path, 1)))


if __name__ == '__main__':
    unittest.main()
