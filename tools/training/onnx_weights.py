"""Weights out of an ONNX file: just enough of the protocol buffer format to train further from an
exported network, without the package onnx."""

import numpy as np

VARINT, EIGHT_BYTES, BYTES, FOUR_BYTES = 0, 1, 2, 5
MODEL_GRAPH = 7
GRAPH_NODE, GRAPH_INITIALIZER = 1, 5
NODE_INPUT, NODE_KIND = 1, 4
TENSOR_SHAPE, TENSOR_TYPE, TENSOR_FLOATS, TENSOR_NAME, TENSOR_RAW = 1, 2, 4, 8, 9
FLOAT = 1


def varint(data, position):
    value = shift = 0
    while True:
        byte = data[position]
        value |= (byte & 127) << shift
        position, shift = position + 1, shift + 7
        if byte < 128:
            return value, position


def fields(data):
    """Yields number and value of every field of a message: an integer, or a part of `data`."""
    position = 0
    while position < len(data):
        key, position = varint(data, position)
        number, kind = key >> 3, key & 7
        if kind == VARINT:
            value, position = varint(data, position)
        else:
            if kind == BYTES:
                size, position = varint(data, position)
            else:
                size = {FOUR_BYTES: 4, EIGHT_BYTES: 8}[kind]
            if position + size > len(data):
                raise IndexError('the file ends too early')
            value, position = data[position:position + size], position + size
        yield number, value


def integers(value):
    """A repeated integer field holds one of them, or many, packed."""
    if isinstance(value, int):
        return [value]
    found, position = [], 0
    while position < len(value):
        number, position = varint(value, position)
        found.append(number)
    return found


def tensor(data):
    """Name and array of a tensor; the array is None unless it holds 32-bit floats."""
    shape, name, values, kind = [], '', b'', 0
    for number, value in fields(data):
        if number == TENSOR_SHAPE:
            shape += integers(value)
        elif number == TENSOR_TYPE:
            kind = value
        elif number == TENSOR_NAME:
            name = bytes(value).decode()
        elif number in (TENSOR_RAW, TENSOR_FLOATS):
            values = bytes(value)
    return name, np.frombuffer(values, '<f4').reshape(shape).copy() if kind == FLOAT else None


def convolutions(graph):
    """Names of kernel and bias of the convolutions, in their order."""
    found = []
    for number, value in fields(graph):
        if number != GRAPH_NODE:
            continue
        node = list(fields(value))
        kind = [bytes(item) for key, item in node if key == NODE_KIND]
        if kind == [b'Conv']:
            found.append([bytes(item).decode() for key, item in node if key == NODE_INPUT][1:])
    return found


def read(path):
    """Pairs of kernel and bias of the convolutions of a network, in the order in which they run."""
    with open(path, 'rb') as file:
        model = memoryview(file.read())
    try:
        graph = dict(fields(model))[MODEL_GRAPH]
        tensors = dict(tensor(value) for key, value in fields(graph) if key == GRAPH_INITIALIZER)
        return [tuple(tensors[name] for name in names) for names in convolutions(graph)]
    except (IndexError, KeyError, ValueError) as error:
        raise ValueError(f'{path}: no ONNX network that this can read ({error})') from error
