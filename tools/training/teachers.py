"""Two published networks that label photographs which have no true mask."""

import cv2
import numpy as np

LONG_SIDE = 384  # pixels, of the image that a teacher sees
CELL = 16  # pixels of the input from one cell of the output to the next
VOC_PERSON = 15


def input_size(width, height):
    """Width and height, both 16 k + 1: the image with its longer side scaled to LONG_SIDE."""
    scale = LONG_SIDE / max(width, height)
    return tuple(max(2, round(side * scale / CELL)) * CELL + 1 for side in (width, height))


def label_size(width, height):
    """Width and height of the stored labels: half of the scaled image; teachers are coarse."""
    scale = LONG_SIDE / max(width, height) / 2
    return tuple(max(1, round(side * scale)) for side in (width, height))


def enlarge(cells, network_size, size):
    """Scores of cells that lie on the input's pixels 0, 16, 32 ... for the pixels of an image."""
    scale = [network_size[axis] / size[axis] for axis in (0, 1)]
    cells_from_pixels = np.array([[scale[0], 0, 0.5 * scale[0] - 0.5],
                                  [0, scale[1], 0.5 * scale[1] - 0.5]]) / CELL
    return cv2.warpAffine(cells, cells_from_pixels, size, borderMode=cv2.BORDER_REPLICATE,
                          flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)


class Teacher:
    """A network that OpenCV reads, as probabilities of a person."""

    def __init__(self, path, output, probabilities):
        self.network, self.output = cv2.dnn.readNet(str(path)), output
        self.probabilities = probabilities

    def label(self, image):
        """Probability of a person (float, label_size) on a BGR image."""
        height, width = image.shape[:2]
        size = input_size(width, height)
        self.network.setInput(cv2.dnn.blobFromImage(image, 1 / 128, size, (128, 128, 128), True))
        cells = self.probabilities(self.network.forward(self.output)[0])
        return np.clip(enlarge(cells, size, label_size(width, height)), 0, 1)


def softmax_person(logits):
    scores = np.exp(logits - logits.max(axis=0))
    return scores[VOC_PERSON] / scores.sum(axis=0)


def sigmoid(logits):
    return 1 / (1 + np.exp(-np.clip(logits[0], -30, 30)))


class Teachers:
    """DeepLab sees the image as it is, BodyPix in a mirror: two views in two passes."""

    def __init__(self, models):
        self.deeplab = Teacher(models / 'deeplabv3_mnv2_voc21.onnx', 'logits', softmax_person)
        self.bodypix = Teacher(models / 'bodypix_mnv1_075_person.onnx', 'segments', sigmoid)

    def label(self, image):
        """8-bit image: channel 0 is DeepLab's probability of a person, 1 BodyPix's, 2 is zero."""
        deeplab = self.deeplab.label(image)
        bodypix = self.bodypix.label(image[:, ::-1])[:, ::-1]
        planes = [np.round(255 * plane) for plane in (deeplab, bodypix, 0 * deeplab)]
        return np.stack(planes, axis=2).astype(np.uint8)
