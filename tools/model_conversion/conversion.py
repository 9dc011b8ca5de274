"""A TensorFlow Lite network, float or quantised, as a float ONNX network for OpenCV 4.6.

Activations change from NHWC to NCHW. Quantised weights are dequantised; the saturation of a
quantised activation becomes a Clip, which the network was trained with."""

import struct
from math import prod

from . import onnx_file
from .onnx_file import Node
from .tflite_file import Model

BINARY = {'ADD': 'Add', 'MUL': 'Mul', 'SUB': 'Sub'}
UNARY = {'LOGISTIC': 'Sigmoid', 'RELU': 'Relu'}
# Where the table of an operator's options holds its fused activation.
ACTIVATION_FIELD = {'CONV_2D': 3, 'DEPTHWISE_CONV_2D': 4, 'ADD': 0, 'MUL': 0, 'SUB': 0}
ACTIVATION_RANGE = {0: (None, None), 1: (0.0, None), 2: (-1.0, 1.0), 3: (0.0, 6.0)}


def transpose(values, shape, order):
    """A flat array with its axes in another order, and its new shape."""
    if len(values) != prod(shape):
        raise ValueError(f'{len(values)} values have shape {shape}')
    strides = [1] * len(shape)
    for axis in range(len(shape) - 2, -1, -1):
        strides[axis] = strides[axis + 1] * shape[axis + 1]
    positions = [0]
    for axis in order:
        steps = range(0, shape[axis] * strides[axis], strides[axis])
        positions = [start + step for start in positions for step in steps]
    return [values[i] for i in positions], [shape[axis] for axis in order]


def same_padding(size, kernel, stride, dilation):
    """Output size and the padding before and after, TensorFlow's SAME."""
    output = -(-size // stride)
    padding = max((output - 1) * stride + (kernel - 1) * dilation + 1 - size, 0)
    return output, padding // 2, padding - padding // 2


def window_geometry(valid, size, kernel, strides, dilation=1):
    """Output size (h, w) and ONNX `pads` of a convolution or pooling."""
    if valid:
        output = [(size[i] - (kernel[i] - 1) * dilation - 1) // strides[i] + 1 for i in (0, 1)]
        return output, [0, 0, 0, 0]
    h, top, bottom = same_padding(size[0], kernel[0], strides[0], dilation)
    w, left, right = same_padding(size[1], kernel[1], strides[1], dilation)
    return [h, w], [top, left, bottom, right]


class Conversion:
    """The network's operators one after the other; what it cannot convert is left out, and is an
    error only when an output needs it."""

    def __init__(self, model, size=None, opset=11, skip_padding=False):
        self.model, self.opset, self.skip_padding = model, opset, skip_padding
        first = model.inputs[0]
        self.base_size = model.tensors[first].shape[1:3]
        self.size = list(size or self.base_size)
        self.nodes, self.constants = [], {}
        self.names = {first: 'input'}  # by index of a tensor
        self.shapes = {first: [model.tensors[first].shape[3], *self.size]}  # channels, h, w
        self.left_out = []
        self.serial = 0
        for operator in model.operators:
            self._convert(operator)

    def write(self, path, outputs, comment):
        """`outputs`: pairs of a tensor's name in the model and its new name."""
        shapes, nodes = {}, list(self.nodes)
        for tensor_name, name in outputs:
            index = self._find(tensor_name)
            nodes.append(Node('Identity', [self.names[index]], name, {}))
            shapes[name] = [1, *self.shapes[index]]
        nodes, constants = fold_image_pooling(*without_unused(nodes, self.constants, shapes))
        inputs = {'input': [1, *self.shapes[self.model.inputs[0]]]}
        onnx_file.write(path, nodes, constants, inputs, shapes, self.opset, comment)

    def default_outputs(self):
        tensors = [self.model.tensors[index].name for index in self.model.outputs]
        return [(name, f'output{i}') for i, name in enumerate(tensors)]

    def _find(self, tensor_name):
        for index, tensor in enumerate(self.model.tensors):
            if tensor.name == tensor_name and index in self.names:
                return index
        reason = f'; could not convert: {", ".join(self.left_out)}' if self.left_out else ''
        raise ValueError(f"no tensor '{tensor_name}' can be put out{reason}")

    def _name(self, prefix):
        self.serial += 1
        return f'{prefix}_{self.serial}'

    def _constant(self, value, prefix='w'):
        name = self._name(prefix)
        self.constants[name] = value
        return name

    def _node(self, kind, inputs, **attributes):
        name = self._name(kind.lower())
        self.nodes.append(Node(kind, inputs, name, attributes))
        return name

    def _scalar(self, value):
        return self._constant(onnx_file.floats([1, 1, 1, 1], [value]))

    def _convert(self, operator):
        if operator.name == 'DEQUANTIZE' and operator.inputs[0] not in self.names:
            source, target = (self.model.tensors[i] for i in (operator.inputs[0], operator.output))
            target.values, target.scale = source.floats(), ()
            return
        if operator.inputs[0] not in self.names:
            return
        method = getattr(self, '_' + operator.name.lower(), None)
        if operator.name in BINARY:
            method = self._binary
        elif operator.name in UNARY:
            method = self._unary
        result = method(operator) if method else None
        if result is None:
            self.left_out.append(str(operator))
            return
        self.names[operator.output], self.shapes[operator.output] = result

    def _input(self, operator):
        return self.names[operator.inputs[0]], self.shapes[operator.inputs[0]]

    def _activate(self, name, operator):
        """Fused activation and saturation of the quantised output, as one Clip or Relu."""
        field = ACTIVATION_FIELD.get(operator.name)
        kind = 0 if field is None else operator.options.number(field, 'b')
        low, high = ACTIVATION_RANGE[kind]
        limits = self.model.tensors[operator.output].quantised_range()
        if limits:
            low = limits[0] if low is None else max(low, limits[0])
            high = limits[1] if high is None else min(high, limits[1])
        if low is None:
            return name
        if high is None:
            return self._node('Relu', [name])
        low = 0.0 if abs(low) < 1e-6 else low
        high = 6.0 if abs(high - 6.0) < 2e-3 else high
        return self._node('Clip', [name], min=low, max=high)

    def _conv_2d(self, operator):
        return self._convolution(operator, (0, 3, 1, 2), 1, dilation_field=4)

    def _depthwise_conv_2d(self, operator):
        groups = self.shapes[operator.inputs[0]][0]
        return self._convolution(operator, (3, 0, 1, 2), groups, dilation_field=5)

    def _convolution(self, operator, order, groups, dilation_field):
        name, (_, *size) = self._input(operator)
        weights = self.model.tensors[operator.inputs[1]]
        kernel = weights.shape[1:3]
        stride = operator.options.number(1, 'i', 1)
        dilation = operator.options.number(dilation_field, 'i', 1)
        values, shape = transpose(weights.floats(), weights.shape, order)
        inputs = [name, self._constant(onnx_file.floats(shape, values))]
        if len(operator.inputs) > 2 and operator.inputs[2] >= 0:
            bias = self.model.tensors[operator.inputs[2]]
            inputs.append(self._constant(onnx_file.floats(bias.shape, bias.floats()), 'b'))
        output, pads = window_geometry(operator.options.number(0, 'b'), size, kernel,
                                       [stride, stride], dilation)
        result = self._node('Conv', inputs, kernel_shape=kernel, strides=[stride, stride],
                            dilations=[dilation, dilation], pads=pads, group=groups)
        return self._activate(result, operator), [shape[0], *output]

    def _custom(self, operator):
        if operator.custom_name != 'Convolution2DTransposeBias':  # MediaPipe's
            return None
        name, (_, h, w) = self._input(operator)
        weights, bias = (self.model.tensors[i] for i in operator.inputs[1:3])
        kernel = weights.shape[1:3]
        _, stride_w, stride_h = struct.unpack_from('<3i', operator.custom_options)
        values, shape = transpose(weights.floats(), weights.shape, (3, 0, 1, 2))
        spare = [kernel[0] - stride_h, kernel[1] - stride_w]
        before = [spare[0] // 2, spare[1] // 2]
        result = self._node('ConvTranspose',
                            [name, self._constant(onnx_file.floats(shape, values)),
                             self._constant(onnx_file.floats(bias.shape, bias.floats()))],
                            kernel_shape=kernel, strides=[stride_h, stride_w],
                            pads=[*before, spare[0] - before[0], spare[1] - before[1]])
        return result, [shape[1], h * stride_h, w * stride_w]

    def _binary(self, operator):
        name, shape = self._input(operator)
        other = operator.inputs[1]
        if other in self.names:
            shape = max(shape, self.shapes[other], key=lambda s: s[1] * s[2])
            right = self.names[other]
        else:
            tensor = self.model.tensors[other]
            if tensor.values is None or len(tensor.values) != tensor.shape[-1]:
                return None
            right = self._constant(
                onnx_file.floats([1, tensor.shape[-1], 1, 1], tensor.floats()), 'k')
        return self._activate(self._node(BINARY[operator.name], [name, right]), operator), shape

    def _unary(self, operator):
        name, shape = self._input(operator)
        return self._node(UNARY[operator.name], [name]), shape

    def _relu6(self, operator):
        name, shape = self._input(operator)
        return self._node('Clip', [name], min=0.0, max=6.0), shape

    def _softmax(self, operator):
        name, shape = self._input(operator)
        return self._node('Softmax', [name], axis=1), shape

    def _hard_swish(self, operator):
        name, shape = self._input(operator)
        gate = self._node('Add', [name, self._scalar(3.0)])
        gate = self._node('Clip', [gate], min=0.0, max=6.0)
        gate = self._node('Mul', [gate, self._scalar(1.0 / 6.0)])
        return self._node('Mul', [name, gate]), shape

    def _quantize(self, operator):
        return self._input(operator)

    _dequantize = _quantize

    def _mean(self, operator):
        name, shape = self._input(operator)
        return self._node('GlobalAveragePool', [name]), [shape[0], 1, 1]

    def _average_pool_2d(self, operator):
        window = [operator.options.number(4, 'i', 1), operator.options.number(3, 'i', 1)]
        whole = self.model.tensors[operator.inputs[0]].shape[1:3] == window
        if whole and self.model.tensors[operator.output].shape[1:3] == [1, 1]:
            return self._mean(operator)
        return self._pool('AveragePool', operator)

    def _max_pool_2d(self, operator):
        return self._pool('MaxPool', operator)

    def _pool(self, kind, operator):
        name, (channels, *size) = self._input(operator)
        stride_w, stride_h, w, h = (operator.options.number(i, 'i', 1) for i in (1, 2, 3, 4))
        output, pads = window_geometry(operator.options.number(0, 'b'), size, [h, w],
                                       [stride_h, stride_w])
        result = self._node(kind, [name], kernel_shape=[h, w], strides=[stride_h, stride_w],
                            pads=pads)
        return result, [channels, *output]

    def _pad(self, operator):
        name, (channels, h, w) = self._input(operator)
        if self.skip_padding:
            return name, [channels, h, w]
        _, _, top, bottom, left, right, _, _ = self.model.tensors[operator.inputs[1]].values
        pads = [0, 0, top, left, 0, 0, bottom, right]
        if self.opset < 11:
            result = self._node('Pad', [name], mode='constant', pads=pads)
        else:
            sizes = self._constant(onnx_file.integers(pads), 'pads')
            result = self._node('Pad', [name, sizes], mode='constant')
        return result, [channels, h + top + bottom, w + left + right]

    def _resized(self, size):
        """A size inside the original network as it is for the new input size."""
        if self.size == self.base_size:
            return list(size)
        return [int(round((s - 1) * (new - 1) / (base - 1))) + 1 if s > 1 else 1
                for s, new, base in zip(size, self.size, self.base_size)]

    def _resize_bilinear(self, operator):
        return self._resize(operator, 'linear', align_corners_field=2)

    def _resize_nearest_neighbor(self, operator):
        return self._resize(operator, 'nearest', align_corners_field=0, nearest_mode='floor')

    def _resize(self, operator, mode, align_corners_field, **attributes):
        name, (channels, h, w) = self._input(operator)
        size = self._resized(self.model.tensors[operator.inputs[1]].values)
        if size == [h, w]:
            return name, [channels, h, w]
        if self.opset < 11 and [h, w] == [1, 1]:
            scale = self._constant(onnx_file.floats([4], [1, 1, *size]), 'sc')
            return self._node('Upsample', [name, scale], mode='nearest'), [channels, *size]
        grid = 'asymmetric'
        if operator.options.number(align_corners_field, 'b'):
            grid = 'align_corners'
        elif operator.options.number(align_corners_field + 1, 'b'):
            grid = 'half_pixel'
        inputs = [name, self._constant(onnx_file.floats([0], []), 'roi'),
                  self._constant(onnx_file.floats([0], []), 'sc'),
                  self._constant(onnx_file.integers([1, channels, *size]), 'sz')]
        result = self._node('Resize', inputs, mode=mode, coordinate_transformation_mode=grid,
                            **attributes)
        return result, [channels, *size]

    def _concatenation(self, operator):
        if operator.options.number(0, 'i') not in (3, -1):
            return None
        _, (_, h, w) = self._input(operator)
        result = self._node('Concat', [self.names[i] for i in operator.inputs], axis=1)
        return result, [sum(self.shapes[i][0] for i in operator.inputs), h, w]


def without_unused(nodes, constants, outputs):
    """The nodes and constants that the outputs depend on."""
    needed, kept = set(outputs), []
    for node in reversed(nodes):
        if node.output in needed:
            kept.append(node)
            needed.update(node.inputs)
    kept.reverse()
    return kept, {name: value for name, value in constants.items() if name in needed}


def fold_image_pooling(nodes, constants):
    """Replaces Upsample of one cell, Concat and 1x1 Conv (the image pooling of DeepLab) by two
    convolutions and a broadcast sum, which work for every input size."""
    makers = {node.output: node for node in nodes}
    concat = next((node for node in nodes if node.kind == 'Concat' and any(
        makers[i].kind == 'Upsample' for i in node.inputs if i in makers)), None)
    if concat is None:
        return nodes, constants
    conv = next(node for node in nodes if node.inputs[0] == concat.output)
    upsample = next(makers[i] for i in concat.inputs if makers[i].kind == 'Upsample')
    other = next(i for i in concat.inputs if i != upsample.output)
    weights = constants[conv.inputs[1]]
    outputs, channels = weights.shape[:2]
    half = channels // 2
    pooled = 0 if concat.inputs[0] == upsample.output else half

    def part(first):
        rows = (weights.values[row * channels + first:row * channels + first + half]
                for row in range(outputs))
        return onnx_file.floats([outputs, half, 1, 1], [value for row in rows for value in row])

    folded = []
    for node in nodes:
        if node is conv:
            folded += [
                Node('Conv', [upsample.inputs[0], 'wpool'], 'convpool', {'kernel_shape': [1, 1]}),
                Node('Conv', [other, 'waspp', conv.inputs[2]], 'convaspp',
                     {'kernel_shape': [1, 1]}),
                Node('Add', ['convaspp', 'convpool'], conv.output, {})]
        elif node not in (upsample, concat):
            folded.append(node)
    kept = {name: value for name, value in constants.items()
            if name not in (conv.inputs[1], upsample.inputs[1])}
    return folded, kept | {'wpool': part(pooled), 'waspp': part(half - pooled)}


def convert(source, target, size=None, opset=11, skip_padding=False, outputs=None, comment=''):
    """Makes the ONNX file `target` of the TensorFlow Lite file `source`. Raises ValueError when it is
    damaged or of a kind that cannot be converted; OSError."""
    try:
        conversion = Conversion(Model(source), size, opset, skip_padding)
        conversion.write(target, outputs or conversion.default_outputs(), comment)
    except (ArithmeticError, LookupError, TypeError, struct.error) as error:
        raise ValueError(f'{source}: a damaged network, or one of a kind that cannot be converted '
                         f'({type(error).__name__}: {error})') from error
