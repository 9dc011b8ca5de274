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
VOC_CHAIR = 9

try:
    import cv2
    import numpy as np
    import torch
except ImportError as error:
    print(f'skipped: {error}; see tools/training/README.md')
    sys.exit(SKIPPED)

import caffe_files  # noqa: E402
import export  # noqa: E402
import onnx_weights  # noqa: E402
from batches import Images  # noqa: E402
from checkpoint import averaged_network  # noqa: E402
from class_labels import load as load_classes  # noqa: E402
from network import PersonNetwork, folded, normalised_input, set_weights  # noqa: E402
from samples import Collection, load  # noqa: E402
from scene import Scene  # noqa: E402
from segnet import CLASSES, SegNet, person_margin  # noqa: E402
from sources import Photograph, is_held_out, photographs  # noqa: E402
from teachers import input_size, label_size  # noqa: E402

HERE = Path(__file__).parent
IMAGES = 4  # of each source
SIZE = (320, 256)  # of the person network's input
SMALL = (96, 64)  # of a SegNet's first training


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
    for photo in photographs(work):
        photo.classes_path.parent.mkdir(parents=True, exist_ok=True)
        classes = np.zeros((48, 64, 3), np.uint8)
        classes[:, :, 1] = 255
        classes[30:, :20, 0] = VOC_CHAIR
        cv2.imwrite(str(photo.classes_path), classes)


def made_up_work(root):
    archives, work = root / 'archives', root / 'work'
    archives.mkdir()
    make_archives(archives)
    call('prepare.py', archives, work)
    make_teachers(work)
    return work


class Trained(unittest.TestCase):
    """Two iterations, interrupted after the first of them."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.work, cls.output, cls.onnx = made_up_work(root), root / 'run', root / 'net.onnx'
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
        late = Images(collection, 3, 5, 4, SIZE)[0]
        early = Images(collection, 3, 0, 9, SIZE)[5]
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


class TrainedSegNet(unittest.TestCase):
    """The same tool: first with small images, then further at the full size."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.work = made_up_work(root)
        small, cls.full, cls.caffe = root / 'small', root / 'full', root / 'net.caffemodel'
        begin = ('--network', 'segnet', '--batch', 2, '--workers', 0, '--device', 'cpu',
                 '--iterations', 1)
        call('train.py', cls.work, small, *begin, '--size', *SMALL)
        call('train.py', cls.work, cls.full, *begin, '--start', small / 'checkpoint.pt')
        call('export.py', cls.full / 'checkpoint.pt', cls.caffe)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_caffe_weights_are_read_back(self):
        network = averaged_network(self.full / 'checkpoint.pt')
        copy = SegNet(normalise=False).eval()
        set_weights(copy, caffe_files.read(self.caffe))
        image = normalised_input(torch.full((1, 3, 64, 96), 100.0))
        with torch.no_grad():
            self.assertTrue(torch.allclose(network(image), copy(image), atol=1e-4))
        self.assertEqual(caffe_files.input_size(self.caffe), (256, 192))

    def test_a_segnet_is_evaluated_with_its_classes(self):
        said = call('evaluate.py', self.caffe, '--work', self.work)
        self.assertIn('clothing, held out', said)

    def test_checkpoints_of_another_network_are_refused(self):
        with self.assertRaisesRegex(AssertionError, 'is of the network segnet'):
            call('train.py', self.work, self.full, '--iterations', 2)

    def test_things_that_somebody_covers_are_no_longer_there(self):
        photos = [photo for photo in photographs(self.work) if photo.source == 'clothing']
        sample = load_classes(photos[1])
        self.assertEqual(set(np.unique(sample.things)), {0, CLASSES.index('chair')})
        scene = Scene(sample.image, sample.target, sample.weight, sample.things)
        scene.cover(np.zeros_like(sample.image), np.ones(sample.target.shape, np.float32), True)
        self.assertFalse(scene.things.any())

    def test_refuses_a_truncated_caffemodel(self):
        cut = self.work.parent / 'cut.caffemodel'
        cut.write_bytes(self.caffe.read_bytes()[:100000])
        with self.assertRaisesRegex(ValueError, 'no caffemodel'):
            caffe_files.read(cut)


class Parts(unittest.TestCase):
    def test_a_segnets_person_is_who_scores_above_all_other_classes(self):
        scores = torch.zeros(1, len(CLASSES), 1, 2)
        scores[0, CLASSES.index('person'), 0, 0] = 2
        scores[0, CLASSES.index('sofa'), 0, 1] = 3
        self.assertEqual(person_margin(scores).flatten().tolist(), [2, -3])

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
