#!/usr/bin/python3
"""Trains on a few made-up images: prepare, train, resume, export, read back, evaluate.

Skips (exit code 77) without the packages that training needs."""

import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile
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

import cache  # noqa: E402
import caffe_files  # noqa: E402
import export  # noqa: E402
import models  # noqa: E402
import onnx_weights  # noqa: E402
import render_desks  # noqa: E402
from batches import Images  # noqa: E402
from checkpoint import averaged_network  # noqa: E402
from class_labels import UNKNOWN  # noqa: E402
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

    def test_a_segnet_may_have_another_size(self):
        other = self.work.parent / 'other.caffemodel'
        call('export.py', self.full / 'checkpoint.pt', other, '--size', 160, 128)
        self.assertEqual(caffe_files.input_size(other), (160, 128))
        self.assertEqual(other.read_bytes(), self.caffe.read_bytes())
        with self.assertRaisesRegex(AssertionError, '32 must divide'):
            call('export.py', self.full / 'checkpoint.pt', other, '--size', 160, 120)

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


CATALOGUE = """id=test
name#1=Wooden chair
category#1=Office
model#1=/things/box.obj
width#1=40
depth#1=60
height#1=20
name#2=Male
category#2=Characters
model#2=/things/box.obj
width#2=40
depth#2=60
height#2=170
"""
BOX = """mtllib box.mtl
v -1 0 -2
v 1 0 -2
v 1 1 -2
v -1 1 -2
v -1 0 2
v 1 0 2
v 1 1 2
v -1 1 2
usemtl red
f 1 2 3 4
f 5 6 7 8
f 1 2 6 5
f 4 3 7 8
f 1 4 8 5
f -7 -6 -2 -3
"""


class Desks(unittest.TestCase):
    """One model, a red box that is called a chair."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.work, cls.furniture = made_up_work(root), root / 'furniture'
        cls.furniture.mkdir()
        with zipfile.ZipFile(cls.furniture / 'Things.sh3f', 'w') as archive:
            archive.writestr('PluginFurnitureCatalog.properties', CATALOGUE)
            archive.writestr('things/box.obj', BOX)
            archive.writestr('things/box.mtl', 'newmtl red\nKd 0.9 0.1 0.2\nmap_Kd missing.jpg\n')
        call('render_desks.py', cls.furniture, cls.work, '--count', 2)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_people_are_no_things(self):
        found = models.catalogue(self.work)
        self.assertEqual([model.voc_id for model in found], [VOC_CHAIR])

    def test_a_model_stands_upright_in_its_size_and_colour(self):
        surface = models.load_surface(models.catalogue(self.work)[0])
        low, high = surface.points.min(axis=0), surface.points.max(axis=0)
        np.testing.assert_allclose(low, (-0.2, -0.3, 0), atol=1e-3)
        np.testing.assert_allclose(high, (0.2, 0.3, 0.2), atol=1e-3)
        np.testing.assert_allclose(surface.colours.mean(axis=0), (0.2, 0.1, 0.9), atol=0.01)
        area = 2 * (0.4 * 0.6 + 0.4 * 0.2 + 0.6 * 0.2)
        self.assertAlmostEqual(surface.spacing, np.sqrt(area / models.POINTS), places=5)

    def test_a_square_is_where_the_camera_sees_it(self):
        view = render_desks.View(np.random.default_rng(1))
        forward = view.camera_from_world[2]
        pixels, depth = view.project((view.position + 2 * forward)[None])
        np.testing.assert_allclose(pixels, [[render_desks.WIDTH / 2, render_desks.HEIGHT / 2]])
        np.testing.assert_allclose(depth, [2])

    def test_what_is_nearer_covers_what_is_farther(self):
        picture = render_desks.Picture()
        pixels = np.array([[10.5, 20.5], [10.5, 20.5]])
        colours = np.array([[1, 0, 0], [0, 1, 0]], np.float32)
        picture.splat(pixels, np.array([1, 2], np.float32), colours, 1, VOC_CHAIR)
        picture.splat(pixels[:1], np.array([3], np.float32), colours[1:], 0, 0)
        self.assertEqual(picture.image[20, 10].tolist(), [1, 0, 0])
        self.assertEqual(picture.image[19:22, 9:12, 0].sum(), 9)
        self.assertEqual(int((picture.classes == VOC_CHAIR).sum()), 9)

    def test_desks_are_empty_photographs_with_classes(self):
        photos = photographs(self.work, ('desks',))
        self.assertEqual(len(photos), 2)
        for photo in photos:
            sample = load_classes(photo)
            self.assertGreater(sample.image.std(), 1)
            self.assertFalse(sample.target.any())
            self.assertTrue(sample.things.any())
        self.assertIn('desks', {entry.photo.source for entry in
                                Collection(photographs(self.work)).empty})

    def test_goes_on_where_it_stopped(self):
        first = photographs(self.work, ('desks',))[0].path
        before = first.read_bytes()
        first.unlink()
        call('render_desks.py', self.furniture, self.work, '--count', 2)
        self.assertEqual(first.read_bytes(), before)


class Distilled(unittest.TestCase):
    """A SegNet from images of a cache, with features beside them; all are noise."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        cls.work, cls.output = made_up_work(root), root / 'run'
        (cls.work / 'cache').mkdir()
        data = np.random.default_rng(3).bytes(cache.RECORDS * cache.RECORD.itemsize)
        records = np.frombuffer(data, cache.RECORD).copy()
        records['things'] = np.where(records['things'] < 100, CLASSES.index('sofa'), UNKNOWN)
        records.tofile(cls.work / 'cache/000000.images')

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_first_only_hints_then_all_and_goes_on(self):
        for iterations in (1, 2):
            said = call('train.py', self.work, self.output, '--network', 'segnet', '--cache',
                        '--hints', 1, '--hints-only', 1, '--size', *SMALL, '--batch', 2,
                        '--iterations', iterations, '--device', 'cpu')
            self.assertIn(f'{iterations} of {iterations}', said)
        state = torch.load(self.output / 'checkpoint.pt')
        self.assertEqual(state['iteration'], 2)
        self.assertIn('adapters.layers.deeplab.weight', state['task'])

    def test_the_same_batch_follows_from_the_same_number(self):
        stored = cache.Cache(self.work / 'cache')
        one, two = (stored.batch(np.random.default_rng(5), 3, SMALL) for _ in range(2))
        self.assertTrue(all(torch.equal(a, b) for a, b in zip(one, two)))
        self.assertEqual(one[0].shape, (3, 3, 64, 96))
        self.assertTrue(torch.allclose(one[1].sum(dim=1), torch.ones(3, 64, 96), atol=1e-4))


class Parts(unittest.TestCase):
    def test_cells_are_cut_out_as_pixels_are(self):
        across = np.tile(np.linspace(0, 200, 240, dtype=np.float32), (192, 1))
        coarse = torch.from_numpy(cv2.resize(across, (40, 32), interpolation=cv2.INTER_AREA))
        for seed in range(4):
            part = cache.Part(np.random.default_rng(seed))
            maps = torch.from_numpy(part.map())[None]
            cells = cache.cells_of(coarse[None, None], maps, (20, 16), False)[0, 0].numpy()
            pixels = cv2.resize(part.of(across, (80, 64)), (20, 16), interpolation=cv2.INTER_AREA)
            self.assertLess(np.abs(cells - pixels)[:, 1:-1].max(), 2)

    def test_people_are_as_labelled_and_other_classes_as_known_or_taught(self):
        chair, sofa, somebody = (CLASSES.index(name) for name in ('chair', 'sofa', 'person'))
        opinion = torch.zeros(1, len(CLASSES), 1, 4)
        opinion[0, chair], opinion[0, 0] = 0.5, 0.4
        opinion[0, :, 0, 3] = torch.eye(len(CLASSES))[somebody]
        things = torch.tensor([[[UNKNOWN, sofa, UNKNOWN, UNKNOWN]]])
        person = torch.tensor([[[[0, 0.25, 1, 0]]]])
        target = cache.soft_target(person, things, opinion)[0, :, 0]
        self.assertGreater(target[chair, 0], 0.7)
        self.assertEqual(target[sofa, 1], 0.75)
        self.assertEqual(target[somebody].tolist(), [0, 0.25, 1, 0])
        self.assertEqual(target[0, 3], 1)

    def test_images_with_rare_things_are_used_more_often(self):
        shares = np.zeros((4, len(CLASSES) - 2))
        shares[1, 0], shares[2, 1], shares[3, 1] = 0.1, 0.1, 0.2
        chances = cache.chances(shares)
        self.assertAlmostEqual(chances.sum(), 1)
        self.assertTrue(chances[1] > chances[3] > chances[2] > chances[0])

    def test_true_things_count_before_the_teachers(self):
        records = np.zeros(2, cache.RECORD)
        records['things'] = [[[CLASSES.index('sofa')]], [[UNKNOWN]]]
        records['probabilities'][:, CLASSES.index('bottle')] = 255
        shares = cache.shares_of_things(records)
        self.assertEqual(shares.tolist(), [[0, 0, 0, 0, 1, 0], [1, 0, 0, 0, 0, 0]])

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
