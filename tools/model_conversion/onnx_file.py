"""Writes ONNX files: just enough of the protocol buffer format for networks of floats."""

import struct
from array import array

FLOAT, INT64 = 1, 7
INT_ATTRIBUTE, FLOAT_ATTRIBUTE, STRING_ATTRIBUTE, INTS_ATTRIBUTE = 2, 1, 3, 7
IR_VERSION = 4


def _varint(number):
    result = bytearray()
    while number > 127:
        result.append(number & 127 | 128)
        number >>= 7
    result.append(number)
    return bytes(result)


def _number(field, number):
    return _varint(field << 3) + _varint(number)


def _bytes(field, content):
    content = content.encode() if isinstance(content, str) else content
    return _varint(field << 3 | 2) + _varint(len(content)) + content


def _float(field, number):
    return _varint(field << 3 | 5) + struct.pack('<f', number)


def _attribute(name, value):
    if isinstance(value, int):
        content = _number(3, value) + _number(20, INT_ATTRIBUTE)
    elif isinstance(value, float):
        content = _float(2, value) + _number(20, FLOAT_ATTRIBUTE)
    elif isinstance(value, str):
        content = _bytes(4, value) + _number(20, STRING_ATTRIBUTE)
    else:
        content = b''.join(_number(8, item) for item in value) + _number(20, INTS_ATTRIBUTE)
    return _bytes(1, name) + content


class Node:
    def __init__(self, kind, inputs, output, attributes):
        self.kind, self.inputs, self.output, self.attributes = kind, inputs, output, attributes

    def encode(self):
        return (b''.join(_bytes(1, name) for name in self.inputs) + _bytes(2, self.output) +
                _bytes(3, self.output) + _bytes(4, self.kind) +
                b''.join(_bytes(5, _attribute(*item)) for item in sorted(self.attributes.items())))


class Constant:
    """`values`: an array of type f (32-bit floats) or q (64-bit integers)."""

    def __init__(self, shape, values):
        self.shape, self.values = list(shape), values

    def encode(self, name):
        kind = FLOAT if self.values.typecode == 'f' else INT64
        return (b''.join(_number(1, size) for size in self.shape) + _number(2, kind) +
                _bytes(8, name) + _bytes(9, self.values.tobytes()))


def floats(shape, values):
    return Constant(shape, array('f', values))


def integers(values):
    return Constant([len(values)], array('q', values))


def _tensor_type(name, shape):
    dimensions = b''.join(_bytes(1, _number(1, size)) for size in shape)
    return _bytes(1, name) + _bytes(2, _bytes(1, _number(1, FLOAT) + _bytes(2, dimensions)))


def write(path, nodes, constants, inputs, outputs, opset, comment):
    """`constants`, `inputs` and `outputs` are by name; the latter two hold shapes."""
    graph = (b''.join(_bytes(1, node.encode()) for node in nodes) + _bytes(2, 'net') +
             b''.join(_bytes(5, value.encode(name)) for name, value in constants.items()) +
             b''.join(_bytes(11, _tensor_type(*item)) for item in inputs.items()) +
             b''.join(_bytes(12, _tensor_type(*item)) for item in outputs.items()))
    model = (_number(1, IR_VERSION) + _bytes(2, 'tfl2onnx') + _bytes(6, comment) +
             _bytes(7, graph) + _bytes(8, _bytes(1, '') + _number(2, opset)))
    with open(path, 'wb') as file:
        file.write(model)
