"""The person network: encoder of inverted residuals (MobileNet v2), light decoder.

Only Conv, Relu, Add and Resize: what OpenCV 4.6 reads and runs fast. Input: RGB / 128 - 1, of a
size that 32 divides. Output: logit of a person, for cells of STRIDE x STRIDE pixels.

Without `normalise` the batch normalisation is part of the convolutions. That is how the network is
exported, and how it is trained further: twice as fast on a processor."""

import copy

import torch
import torch.nn.functional as F
from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

INPUT_WIDTH, INPUT_HEIGHT = 320, 256
STRIDE = 4  # of the output
ENCODER_CHANNELS = (16, 32, 64, 96, 160)  # at strides 2, 4, 8, 16, 32
ENCODER_BLOCKS = (1, 3, 5, 4)  # after the first of strides 4, 8, 16, 32
EXPANSION = (2, 3, 4, 4)  # of their inner channels
DECODER_CHANNELS = (96, 64, 32)  # at strides 16, 8, 4


class Convolution(nn.Module):
    """A convolution with its batch normalisation, and Relu on request."""

    def __init__(self, inputs, outputs, kernel, stride=1, groups=1, relu=True, normalise=True):
        super().__init__()
        self.conv = nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, groups=groups,
                              bias=not normalise)
        self.norm = nn.BatchNorm2d(outputs, momentum=0.02) if normalise else None
        self.relu = relu

    def forward(self, x):
        x = self.conv(x)
        if self.norm is not None:
            x = self.norm(x)
        return F.relu(x) if self.relu else x

    def fold(self):
        """Makes the normalisation a part of the convolution; the output stays as it is."""
        if self.norm is not None:
            self.conv, self.norm = fuse_conv_bn_eval(self.conv, self.norm), None


class InvertedResidual(nn.Module):
    def __init__(self, inputs, outputs, stride, expansion, normalise):
        super().__init__()
        inner = inputs * expansion
        self.expand = Convolution(inputs, inner, 1, normalise=normalise)
        self.filter = Convolution(inner, inner, 3, stride, inner, normalise=normalise)
        self.reduce = Convolution(inner, outputs, 1, relu=False, normalise=normalise)
        self.residual = stride == 1 and inputs == outputs

    def forward(self, x):
        y = self.reduce(self.filter(self.expand(x)))
        return x + y if self.residual else y


def blocks(inputs, outputs, more, expansion, normalise):
    """One block that halves the size, and `more` that keep it."""
    strides = [2] + [1] * more
    channels = [inputs] + [outputs] * len(strides)
    return nn.Sequential(*[InvertedResidual(channels[i], channels[i + 1], stride, expansion,
                                            normalise) for i, stride in enumerate(strides)])


def enlarge(x):
    return F.interpolate(x, scale_factor=2, mode='bilinear', align_corners=False)


class Fusion(nn.Module):
    """Joins coarse features, enlarged, with those of the encoder at twice the size."""

    def __init__(self, coarse, fine, outputs, separable, normalise):
        super().__init__()
        self.coarse = Convolution(coarse, outputs, 1, normalise=normalise)
        self.fine = Convolution(fine, outputs, 1, relu=False, normalise=normalise)
        if separable:
            self.mix = nn.Sequential(
                Convolution(outputs, outputs, 3, groups=outputs, normalise=normalise),
                Convolution(outputs, outputs, 1, normalise=normalise))
        else:
            self.mix = Convolution(outputs, outputs, 3, normalise=normalise)

    def forward(self, coarse, fine):
        return self.mix(F.relu(enlarge(self.coarse(coarse)) + self.fine(fine)))


class PersonNetwork(nn.Module):
    """Its convolutions are made in the order in which they run: weights are read back by order."""

    def __init__(self, normalise=True):
        super().__init__()
        c2, c4, c8, c16, c32 = ENCODER_CHANNELS
        d16, d8, d4 = DECODER_CHANNELS
        self.stem = Convolution(3, c2, 3, 2, normalise=normalise)
        self.encode4 = nn.Sequential(
            Convolution(c2, c4, 3, 2, normalise=normalise),
            *[InvertedResidual(c4, c4, 1, EXPANSION[0], normalise)
              for _ in range(ENCODER_BLOCKS[0])])
        self.encode8 = blocks(c4, c8, ENCODER_BLOCKS[1], EXPANSION[1], normalise)
        self.encode16 = blocks(c8, c16, ENCODER_BLOCKS[2], EXPANSION[2], normalise)
        self.encode32 = blocks(c16, c32, ENCODER_BLOCKS[3], EXPANSION[3], normalise)
        self.decode16 = Fusion(c32, c16, d16, True, normalise)
        self.decode8 = Fusion(d16, c8, d8, True, normalise)
        self.decode4 = Fusion(d8, c4, d4, False, normalise)
        self.logit = nn.Conv2d(d4, 1, 1)

    def forward(self, x):
        x4 = self.encode4(self.stem(x))
        x8 = self.encode8(x4)
        x16 = self.encode16(x8)
        x32 = self.encode32(x16)
        return self.logit(self.decode4(self.decode8(self.decode16(x32, x16), x8), x4))

    def convolutions(self):
        return [module for module in self.modules() if isinstance(module, nn.Conv2d)]


def folded(network):
    """A copy without batch normalisation that gives the same output."""
    result = copy.deepcopy(network).eval()
    for module in result.modules():
        if isinstance(module, Convolution):
            module.fold()
    return result


def normalised_input(images):
    """Images (n x 3 x h x w, RGB, 0 to 255) as the network's input."""
    return images / 128 - 1


def set_weights(network, weights):
    """`weights`: pairs of kernel and bias (arrays) in the order in which the convolutions run."""
    layers = network.convolutions()
    if len(layers) != len(weights):
        raise ValueError(f'the weights are of {len(weights)} convolutions, the network has '
                         f'{len(layers)}: it is another network')
    with torch.no_grad():
        for number, (layer, (kernel, bias)) in enumerate(zip(layers, weights)):
            if tuple(layer.weight.shape) != kernel.shape:
                raise ValueError(f'convolution {number}: the kernel is {kernel.shape}, that of the '
                                 f'network {tuple(layer.weight.shape)}: it is another network')
            layer.weight.copy_(torch.from_numpy(kernel))
            layer.bias.copy_(torch.from_numpy(bias))
