"""The SegNet of the paper (Badrinarayanan, Kendall and Cipolla, PAMI 2017), with fewer channels.

Convolutions of 3 x 3; pooling remembers where its maxima were, and the decoder puts values back
there. Input: RGB / 128 - 1, of a size that 32 divides. Output: a score per class and pixel."""

import torch.nn.functional as F
from torch import nn

from network import Convolution

INPUT_WIDTH, INPUT_HEIGHT = 256, 192
# As VOC names them; those that the teacher finds in rooms.
CLASSES = ('background', 'bottle', 'chair', 'diningtable', 'person', 'pottedplant', 'sofa',
           'tvmonitor')
VOC_IDS = (0, 5, 9, 11, 15, 16, 18, 20)
PERSON = CLASSES.index('person')
CHANNELS = (16, 32, 64, 96, 96)  # at strides 1, 2, 4, 8, 16
CONVOLUTIONS = (1, 1, 2, 2, 2)  # of each level, in the encoder and in the decoder


def chain(channels, normalise):
    """Convolutions from each number of channels to the next."""
    return nn.Sequential(*[Convolution(inputs, outputs, 3, normalise=normalise)
                           for inputs, outputs in zip(channels, channels[1:])])


class SegNet(nn.Module):
    """Its convolutions are made in the order in which they run. The last of the decoder's is the
    classifier; the decoder's convolutions of a level end with the channels of the next finer."""

    def __init__(self, normalise=True):
        super().__init__()
        finer = (3,) + CHANNELS[:-1]
        levels = list(zip(finer, CHANNELS, CONVOLUTIONS))
        self.encoder = nn.ModuleList(
            chain([inputs] + [width] * count, normalise) for inputs, width, count in levels)
        self.decoder = nn.ModuleList(
            chain([width] * count + [next_width], normalise)
            for next_width, width, count in reversed(levels[1:]))
        self.scores = nn.Conv2d(CHANNELS[0], len(CLASSES), 3, padding=1)

    def forward(self, x):
        return self.decode(self.encode(x))

    def encode(self, x):
        """The output of every level, and where the maxima of its pooling are."""
        levels = []
        for level in self.encoder:
            before = level(x)
            x, places = F.max_pool2d(before, 2, 2, return_indices=True)
            levels.append((before, places))
        return x, levels

    def decode(self, encoded):
        x, levels = encoded
        levels = list(levels)
        for level in self.decoder:
            x = level(unpooled(x, *levels.pop()))
        return self.scores(unpooled(x, *levels.pop()))

    def convolutions(self):
        return [module for module in self.modules() if isinstance(module, nn.Conv2d)]


def unpooled(x, pooled, places):
    return F.max_unpool2d(x, places, 2, 2, output_size=pooled.shape)


def person_margin(scores):
    """How far the person's score lies above the best other, as n x 1 x height x width."""
    others = scores.clone()
    others[:, PERSON] = float('-inf')
    return scores[:, PERSON:PERSON + 1] - others.amax(dim=1, keepdim=True)
