"""A SegNet as Caffe's files: prototxt (text) and caffemodel (protocol buffer), written and read."""

import re

import numpy as np

from onnx_weights import fields, integers
from segnet import CLASSES

NET_LAYER = 100
LAYER_NAME, LAYER_KIND, LAYER_BLOB = 1, 2, 7
BLOB_VALUES, BLOB_SHAPE = 5, 7
SHAPE_SIZE = 1
BYTES = 2

CONVOLUTION = '''layer {{
  name: "{name}" type: "Convolution" bottom: "{bottom}" top: "{name}"
  convolution_param {{ num_output: {outputs} kernel_size: 3 pad: 1 }}
}}
'''
RELU = 'layer {{ name: "{name}_relu" type: "ReLU" bottom: "{name}" top: "{name}" }}\n'
POOLING = '''layer {{
  name: "{name}" type: "Pooling" bottom: "{bottom}" top: "{name}" top: "{name}_mask"
  pooling_param {{ pool: MAX kernel_size: 2 stride: 2 }}
}}
'''
UPSAMPLE = '''layer {{
  name: "{name}" type: "Upsample" bottom: "{bottom}" bottom: "{mask}" top: "{name}"
  upsample_param {{ scale: 2 }}
}}
'''


class Definition:
    """The prototxt, layer by layer, and the weights beside it."""

    def __init__(self, width, height):
        self.text = (f'name: "segnet"\n# classes: {" ".join(CLASSES)}\ninput: "data"\n'
                     f'input_shape {{ dim: 1 dim: 3 dim: {height} dim: {width} }}\n')
        self.top, self.weights = 'data', []

    def convolution(self, name, layer, relu=True):
        self.text += CONVOLUTION.format(name=name, bottom=self.top, outputs=layer.out_channels)
        self.text += RELU.format(name=name) if relu else ''
        self.weights.append((name, [layer.weight, layer.bias]))
        self.top = name

    def add(self, template, name, **more):
        self.text += template.format(name=name, bottom=self.top, **more)
        self.top = name


def definition_of(network, width, height):
    """`network`: without batch normalisation."""
    net = Definition(width, height)
    for level, part in enumerate(network.encoder, 1):
        for number, layer in enumerate(part, 1):
            net.convolution(f'conv{level}_{number}', layer.conv)
        net.add(POOLING, f'pool{level}')
    for level, part in zip(range(len(network.encoder), 1, -1), network.decoder):
        net.add(UPSAMPLE, f'upsample{level}', mask=f'pool{level}_mask')
        for number, layer in enumerate(part, 1):
            net.convolution(f'conv{level}_{number}_decoder', layer.conv)
    net.add(UPSAMPLE, 'upsample1', mask='pool1_mask')
    net.convolution('scores', network.scores, relu=False)
    return net


def varint(value):
    data = b''
    while value >= 128:
        data, value = data + bytes([value & 127 | 128]), value >> 7
    return data + bytes([value])


def field(number, data):
    return varint(number << 3 | BYTES) + varint(len(data)) + data


def blob(array):
    shape = field(SHAPE_SIZE, b''.join(map(varint, array.shape)))
    return field(BLOB_VALUES, array.astype('<f4').tobytes()) + field(BLOB_SHAPE, shape)


def write(network, model, width, height):
    """Writes `model` (a path that ends in .caffemodel) and the prototxt beside it."""
    net = definition_of(network, width, height)
    data = b''
    for name, values in net.weights:
        layer = field(LAYER_NAME, name.encode()) + field(LAYER_KIND, b'Convolution')
        for value in values:
            layer += field(LAYER_BLOB, blob(value.detach().numpy()))
        data += field(NET_LAYER, layer)
    model.write_bytes(data)
    model.with_suffix('.prototxt').write_text(net.text, encoding='utf-8')


def array_of(data):
    message = dict(fields(data))
    shape = [size for number, value in fields(message[BLOB_SHAPE]) if number == SHAPE_SIZE
             for size in integers(value)]
    return np.frombuffer(bytes(message[BLOB_VALUES]), '<f4').reshape(shape).copy()


def read(model):
    """Pairs of kernel and bias of the convolutions, in their order."""
    data = memoryview(model.read_bytes())
    try:
        layers = [layer for number, layer in fields(data) if number == NET_LAYER]
        return [tuple(array_of(value) for number, value in fields(layer) if number == LAYER_BLOB)
                for layer in layers]
    except (IndexError, KeyError, ValueError, TypeError) as error:
        raise ValueError(f'{model}: no caffemodel that this can read ({error})') from error


def input_size(model):
    """Width and height, from the prototxt beside the weights."""
    text = model.with_suffix('.prototxt').read_text(encoding='utf-8')
    found = re.search(r'input_shape \{ dim: 1 dim: 3 dim: (\d+) dim: (\d+) \}', text)
    if not found:
        raise ValueError(f'{model.with_suffix(".prototxt")}: not written by export.py')
    return int(found[2]), int(found[1])
