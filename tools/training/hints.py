"""What trained networks see in an image: hints for the SegNet's encoder (Romero et al., FitNets,
ICLR 2015). Some hundred numbers per cell teach it sooner than one label per pixel."""

import cv2
import numpy as np
import torch
import torch.nn.functional as F
from torch import nn

import onnx_weights
import segnet
from class_labels import CLASS_OF_VOC
from network import INPUT_HEIGHT, INPUT_WIDTH, PersonNetwork, normalised_input, set_weights

# Name, channels, rows and columns, of images of INPUT_WIDTH x INPUT_HEIGHT.
SHAPES = {'person8': (64, 32, 40), 'person16': (96, 16, 20), 'person32': (160, 8, 10),
          'deeplab': (256, 17, 21)}
# The level of the SegNet's encoder, from 0, that is to predict it.
LEVELS = {'person8': 2, 'person16': 3, 'person32': 4, 'deeplab': 4}
DEEPLAB_SIZE = (INPUT_WIDTH + 1, INPUT_HEIGHT + 1)
BEFORE_CLASSIFIER = 'onnx_node!clip_240'  # of deeplabv3_mnv2_voc21.onnx
STEP = 1 / 32  # of a stored feature, in standard deviations


class Teachers:
    """The project's person network, and DeepLab with its opinion on classes."""

    def __init__(self, person, deeplab):
        self.person = PersonNetwork(normalise=False).eval()
        set_weights(self.person, onnx_weights.read(person))
        self.deeplab = cv2.dnn.readNet(str(deeplab))

    def look_at(self, image):
        """`image`: BGR, INPUT_WIDTH x INPUT_HEIGHT. The features by name, and the probabilities of
        the SegNet's classes for cells as of `deeplab`; background is all else."""
        self.deeplab.setInput(cv2.dnn.blobFromImage(image, 1 / 128, DEEPLAB_SIZE, (128,) * 3, True))
        logits, deeplab = self.deeplab.forward(['logits', BEFORE_CLASSIFIER])
        features = self._person_features(image)
        features['deeplab'] = deeplab[0]
        return features, class_probabilities(logits[0])

    @torch.no_grad()
    def _person_features(self, image):
        planes = np.ascontiguousarray(image[:, :, ::-1].transpose(2, 0, 1))
        x = self.person.encode4(self.person.stem(normalised_input(
            torch.from_numpy(planes)[None].float())))
        features = {}
        for name, part in (('person8', self.person.encode8), ('person16', self.person.encode16),
                           ('person32', self.person.encode32)):
            x = part(x)
            features[name] = x[0].numpy()
        return features


def class_probabilities(logits):
    cells = np.exp(logits - logits.max(axis=0))
    cells /= cells.sum(axis=0)
    found = np.zeros((len(segnet.CLASSES),) + cells.shape[1:], np.float32)
    np.add.at(found, CLASS_OF_VOC[:len(cells)], cells)
    return found


class Scale:
    """Mean and deviation per channel, by which features become whole numbers and all weigh alike."""

    def __init__(self, values):
        self.mean = values.mean(axis=(0, 2, 3), dtype=np.float64).astype(np.float32)[:, None, None]
        self.deviation = values.std(axis=(0, 2, 3), dtype=np.float64).astype(np.float32)[
            :, None, None] + 1e-3

    def stored(self, values):
        steps = np.round((values - self.mean) / self.deviation / STEP)
        return np.clip(steps, -127, 127).astype(np.int8)


class Adapters(nn.Module):
    """From the SegNet's features to the teachers': thrown away after training."""

    def __init__(self):
        super().__init__()
        self.layers = nn.ModuleDict({name: nn.Conv2d(segnet.CHANNELS[LEVELS[name]], shape[0], 1)
                                     for name, shape in SHAPES.items()})

    def loss(self, levels, found):
        """`levels`: outputs of the encoder's levels; `found`: the teachers' features, of the size
        of the levels that predict them."""
        losses = [F.mse_loss(layer(levels[LEVELS[name]]).float(), features)
                  for (name, layer), features in zip(self.layers.items(), found)]
        return sum(losses) / len(losses)
