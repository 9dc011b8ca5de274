"""Reads what a conversion needs from a TensorFlow Lite file (schema version 3, a flatbuffer)."""

import struct
from array import array

OPERATORS = {
    0: 'ADD', 1: 'AVERAGE_POOL_2D', 2: 'CONCATENATION', 3: 'CONV_2D', 4: 'DEPTHWISE_CONV_2D',
    6: 'DEQUANTIZE', 14: 'LOGISTIC', 17: 'MAX_POOL_2D', 18: 'MUL', 19: 'RELU', 21: 'RELU6',
    23: 'RESIZE_BILINEAR', 25: 'SOFTMAX', 32: 'CUSTOM', 34: 'PAD', 40: 'MEAN', 41: 'SUB',
    56: 'ARG_MAX', 97: 'RESIZE_NEAREST_NEIGHBOR', 114: 'QUANTIZE', 117: 'HARD_SWISH'}
FLOAT32, FLOAT16, INT32, UINT8, INT64, INT8 = 0, 1, 2, 3, 4, 9
FORMATS = {FLOAT32: 'f', FLOAT16: 'e', INT32: 'i', UINT8: 'B', INT64: 'q', INT8: 'b'}


class Bytes:
    """The file. Parts of it may be read more than once, but a damaged one could have everything refer
    to the same large part: all that is read together is limited to some eight times its size."""

    def __init__(self, data):
        self.data, self.left = data, 8 * len(data) + 1000

    def unpack(self, form, position):
        size = struct.calcsize(form)
        self.left -= size
        if position < 0 or self.left < 0:
            raise struct.error('beyond the limits of the file')
        return struct.unpack_from(form, self.data, position)


class Table:
    """A flatbuffer table; fields are numbered as in the schema."""

    def __init__(self, data, position):
        self.data, self.position = data, position

    def _unpack(self, code, position):
        return self.data.unpack('<' + code, position)[0]

    def _field(self, index):
        vtable = self.position - self._unpack('i', self.position)
        if 4 + 2 * index >= self._unpack('H', vtable):
            return 0
        offset = self._unpack('H', vtable + 4 + 2 * index)
        return self.position + offset if offset else 0

    def _target(self, field):
        return field + self._unpack('I', field)

    def number(self, index, code, default=0):
        field = self._field(index)
        return self._unpack(code, field) if field else default

    def table(self, index):
        field = self._field(index)
        return Table(self.data, self._target(field)) if field else None

    def vector(self, index, code):
        field = self._field(index)
        if not field:
            return ()
        start = self._target(field)
        count = self._unpack('I', start)
        return self.data.unpack(f'<{count}{code}', start + 4)

    def text(self, index):
        return bytes(self.vector(index, 'B')).decode()

    def tables(self, index):
        field = self._field(index)
        if not field:
            return []
        start = self._target(field)
        elements = range(start + 4, start + 4 + 4 * self._unpack('I', start), 4)
        return [Table(self.data, self._target(element)) for element in elements]


class Tensor:
    def __init__(self, table, buffers):
        self.shape = list(table.vector(0, 'i'))
        self.type = table.number(1, 'b')
        self.name = table.text(3)
        raw = bytes(buffers[table.number(2, 'I')].vector(0, 'B'))
        self.values = None  # of a constant
        if raw and self.type in FORMATS:
            code = FORMATS[self.type]
            self.values = struct.unpack(f'<{len(raw) // struct.calcsize(code)}{code}', raw)
        quantisation = table.table(4)
        self.scale = quantisation.vector(2, 'f') if quantisation else ()
        self.zero_point = quantisation.vector(3, 'q') if quantisation else ()
        self.quantised_axis = quantisation.number(6, 'i') if quantisation else 0

    def floats(self):
        """The constant as 32-bit floats, dequantised where it is quantised."""
        if not self.scale:
            return array('f', self.values)
        inner = 1
        for size in self.shape[self.quantised_axis + 1:]:
            inner *= size
        count = len(self.scale)
        return array('f', ((value - self.zero_point[i // inner % count]) *
                           self.scale[i // inner % count]
                           for i, value in enumerate(self.values)))

    def quantised_range(self):
        """The values that the tensor can hold, or None when it is not quantised."""
        if self.type not in (UINT8, INT8) or not self.scale:
            return None
        lowest = (0 if self.type == UINT8 else -128) - self.zero_point[0]
        return self.scale[0] * lowest, self.scale[0] * (lowest + 255)


class Operator:
    def __init__(self, table, codes):
        code = codes[table.number(0, 'I')]
        number = max(code.number(0, 'b'), code.number(3, 'i'))
        self.custom_name = code.text(1)
        self.name = OPERATORS.get(number, f'operator {number}')
        self.inputs = table.vector(1, 'i')
        self.output = table.vector(2, 'i')[0]
        self.options = table.table(4) or Table(Bytes(struct.pack('<iHH', 4, 4, 0)), 0)
        self.custom_options = bytes(table.vector(5, 'B'))

    def __str__(self):
        return f'{self.name} {self.custom_name}'.strip()


class Model:
    def __init__(self, path):
        with open(path, 'rb') as stream:
            data = stream.read()
        if data[4:8] != b'TFL3':
            raise ValueError(f'{path}: this is no TensorFlow Lite file')
        try:
            file = Bytes(data)
            root = Table(file, file.unpack('<I', 0)[0])
            graph, codes, buffers = root.tables(2)[0], root.tables(1), root.tables(4)
            self.tensors = [Tensor(table, buffers) for table in graph.tables(0)]
            self.inputs, self.outputs = graph.vector(1, 'i'), graph.vector(2, 'i')
            self.operators = [Operator(table, codes) for table in graph.tables(3)]
        except (struct.error, IndexError, UnicodeDecodeError) as error:
            raise ValueError(f'{path}: the file is truncated or damaged') from error
