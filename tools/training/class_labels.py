"""Labels of all classes of the SegNet: what DeepLab says, beside the labels of people.

A working folder holds

    classes/SOURCE/NAME.png     channel 0 the class as VOC counts, 1 its probability, 2 zero
"""

import cv2
import numpy as np

import samples
from segnet import PERSON, VOC_IDS
from sources import TRUE_CLASSES
from teachers import enlarge, input_size, label_size

UNKNOWN = 255  # class of what is no person and has no true label
LEAST_SURE = 0.35  # probability of the teacher's best class below which a pixel says nothing

CLASS_OF_VOC = np.zeros(256, np.uint8)
CLASS_OF_VOC[list(VOC_IDS)] = np.arange(len(VOC_IDS))


class ClassTeacher:
    def __init__(self, models):
        self.network = cv2.dnn.readNet(str(models / 'deeplabv3_mnv2_voc21.onnx'))

    def label(self, image):
        """8-bit image, see above."""
        height, width = image.shape[:2]
        size = input_size(width, height)
        self.network.setInput(cv2.dnn.blobFromImage(image, 1 / 128, size, (128, 128, 128), True))
        logits = self.network.forward('logits')[0]
        cells = np.exp(logits - logits.max(axis=0))
        cells /= cells.sum(axis=0)
        planes = np.stack([enlarge(plane, size, label_size(width, height)) for plane in cells])
        surest = np.round(255 * np.clip(planes.max(axis=0), 0, 1))
        best = planes.argmax(axis=0)
        return np.stack([best, surest, 0 * best], axis=2).astype(np.uint8)


def read(photo, size):
    """Class and probability per pixel, for an image of this size; None where nothing is known."""
    if not photo.classes_path.exists():
        return None
    stored = cv2.imread(str(photo.classes_path), cv2.IMREAD_COLOR)
    classes = cv2.resize(CLASS_OF_VOC[stored[:, :, 0]], size, interpolation=cv2.INTER_NEAREST)
    return classes, cv2.resize(stored[:, :, 1], size).astype(np.float32) / 255


def load(photo):
    """As samples.load, with things. Where nothing labels them, only people are believed."""
    sample = samples.load(photo)
    if sample is None:
        return None
    person = sample.target > 0.5
    found = read(photo, sample.image.shape[1::-1])
    if found is None:
        sample.things = np.zeros(person.shape, np.uint8)
        sample.weight[~person] = 0
        return sample
    things, probability = found
    doubtful = things == PERSON  # and no person by the labels of people
    sample.things = np.where(doubtful, 0, things).astype(np.uint8)
    sure = np.clip((probability - LEAST_SURE) / (1 - LEAST_SURE), 0, 1) * ~doubtful
    sample.weight = np.where(person, sample.weight, sample.weight * sure).astype(np.float32)
    return sample


def load_true(photo):
    """The same; without a teacher's opinion on things, which are UNKNOWN."""
    if photo.source in TRUE_CLASSES:
        return load(photo)
    sample = samples.load(photo)
    if sample is not None:
        sample.things = np.full(sample.target.shape, UNKNOWN, np.uint8)
    return sample
