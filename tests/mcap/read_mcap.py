"""Reads MCAP files with messages of ROS 2, by the specifications alone: https://mcap.dev/spec, OMG DDSI-RTPS for CDR,
and ROS 2's interface definitions. Strict: whatever the specifications do not allow is an error."""
import ctypes
import re
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F


def expect(condition, what):
    if not condition:
        raise ValueError(what)


class Cursor:
    """The fields of a record, one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, code):
        value, = struct.unpack_from("<" + code, self.data, self.at)
        self.at += struct.calcsize("<" + code)
        return value

    def bytes(self, count):
        expect(self.at + count <= len(self.data), "a field ends behind its record")
        self.at += count
        return self.data[self.at - count:self.at]

    def text(self):
        return self.bytes(self.number("I")).decode()

    def pairs(self, first, second):
        part = Cursor(self.bytes(self.number("I")))
        found = []
        while part.at < len(part.data):
            found.append((part.number(first), part.number(second)))
        return found

    def end(self):
        expect(self.at == len(self.data), "a record has bytes behind its fields")


def records(data, at, end):
    """(opcode, content, where it begins) of each; of a torn file, those that are whole."""
    while at + 9 <= end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if at + 9 + length > end:
            return
        yield opcode, data[at + 9:at + 9 + length], at
        at += 9 + length


def decompressed(compression, data, size):
    if compression == "":
        return data
    out = ctypes.create_string_buffer(max(size, 1))
    if compression == "zstd":
        decompress = ctypes.CDLL("libzstd.so.1").ZSTD_decompress
        decompress.restype = ctypes.c_size_t
        got = decompress(out, ctypes.c_size_t(size), data, ctypes.c_size_t(len(data)))
    else:
        expect(compression == "lz4", "no such compression: " + compression)
        lz4, context = ctypes.CDLL("liblz4.so.1"), ctypes.c_void_p()
        lz4.LZ4F_createDecompressionContext(ctypes.byref(context), ctypes.c_uint(100))
        written, read = ctypes.c_size_t(size), ctypes.c_size_t(len(data))
        lz4.LZ4F_decompress.restype = ctypes.c_size_t
        left = lz4.LZ4F_decompress(context, out, ctypes.byref(written), data, ctypes.byref(read), None)
        lz4.LZ4F_freeDecompressionContext(context)
        expect(left == 0 and read.value == len(data), "the chunk is no whole frame of LZ4")
        got = written.value
    expect(got == size, "a chunk has another size than it says")
    return out.raw[:size]


class Definitions:
    """The types of a schema of encoding ros2msg, to decode CDR with."""
    NUMBERS = {"bool": "?", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
               "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}

    def __init__(self, name, text):
        parts = re.split(r"^={80}\nMSG: (\S+)\n", text, flags=re.M)
        self.types = {"": self.fields(parts[0])}
        for type_name, fields in zip(parts[1::2], parts[2::2]):
            self.types[type_name] = self.fields(fields)
        self.name = name

    @staticmethod
    def fields(text):
        lines = [line.split() for line in text.splitlines() if line and "=" not in line]
        return [(words[1], *re.fullmatch(r"([\w/]+)(\[(\d*)\])?", words[0]).group(1, 2, 3)) for words in lines]

    def decode(self, data):
        expect(data[:4] == b"\0\1\0\0", self.name + ": not little-endian CDR")
        self.data, self.at = data[4:], 0
        message = self.one("")
        expect(self.at == len(self.data), f"{self.name}: {len(self.data) - self.at} bytes are left")
        return message

    def number(self, code):
        size = struct.calcsize(code)
        self.at += -self.at % size
        value, = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return value

    def one(self, kind):
        if kind in self.NUMBERS:
            return self.number(self.NUMBERS[kind])
        if kind == "string":
            length = self.number("I")
            text = self.data[self.at:self.at + length]
            expect(len(text) == length and text[-1] == 0, self.name + ": a string without its end")
            self.at += length
            return text[:-1].decode()
        return {name: self.many(part, size) if array else self.one(part)
                for name, part, array, size in self.types[kind]}

    def many(self, kind, size):
        count = int(size) if size else self.number("I")
        if kind not in ("uint8", "int8"):
            return [self.one(kind) for _ in range(count)]
        expect(self.at + count <= len(self.data), self.name + ": a sequence ends behind its message")
        self.at += count
        return self.data[self.at - count:self.at]


class Mcap:
    """`messages`: topic → [(time in ns, message)], in the order of the file."""

    def __init__(self, data, whole=True):
        expect(data[:8] == MAGIC, "no MCAP file")
        self.data, self.messages, self.schemas, self.channels = data, {}, {}, {}
        self.chunks, self.sequences = [], {}
        for opcode, content, at in records(data, 8, len(data) - (8 if whole else 0)):
            if opcode == HEADER:
                self.profile = Cursor(content).text()
            elif opcode == CHUNK:
                self.read_chunk(content, at)
            elif opcode == MESSAGE_INDEX:
                self.check_message_index(content, at)
            elif opcode == DATA_END:
                expect(zlib.crc32(data[:at]) == Cursor(content).number("I"), "wrong CRC of the data section")
                return self.check_summary(at + 13)
            else:
                raise ValueError(f"record {opcode} between the chunks")
        expect(not whole, "the file has no end")

    def read_chunk(self, content, at):
        chunk = Cursor(content)
        times = chunk.number("Q"), chunk.number("Q")
        size, crc, compression = chunk.number("Q"), chunk.number("I"), chunk.text()
        packed = chunk.bytes(chunk.number("Q"))
        chunk.end()
        inside = decompressed(compression, packed, size)
        expect(zlib.crc32(inside) == crc, "wrong CRC of a chunk")
        index = {}
        for opcode, record, offset in records(inside, 0, len(inside)):
            if opcode == MESSAGE:
                channel, time = self.read_message(record)
                index.setdefault(channel, []).append((time, offset))
            else:
                self.read_definition(opcode, record)
        stamps = [time for entries in index.values() for time, _ in entries]
        expect(times == (min(stamps, default=0), max(stamps, default=0)), "wrong times of a chunk")
        self.chunks.append({"at": at, "length": 9 + len(content), "times": times, "sizes": (len(packed), size),
                            "compression": compression, "index": index, "indices_at": {}})

    def read_definition(self, opcode, record):
        fields = Cursor(record)
        if opcode == SCHEMA:
            number, name, encoding, text = fields.number("H"), fields.text(), fields.text(), fields.text()
            expect(number > 0 and encoding == "ros2msg", "a schema that is not ros2msg")
            self.schemas[number] = Definitions(name, text)
        else:
            expect(opcode == CHANNEL, f"record {opcode} in a chunk")
            number, schema, topic, encoding = fields.number("H"), fields.number("H"), fields.text(), fields.text()
            expect(schema in self.schemas and encoding == "cdr", "a channel without its schema")
            expect(fields.pairs("I", "I") == [], "metadata")
            self.channels[number] = topic, self.schemas[schema]
        fields.end()

    def read_message(self, record):
        fields = Cursor(record)
        channel, sequence, time, published = (fields.number(code) for code in "HIQQ")
        expect(time == published, "two times")
        expect(sequence == self.sequences.get(channel, 0), "a gap in the sequence")
        self.sequences[channel] = sequence + 1
        topic, definitions = self.channels[channel]
        message = definitions.decode(record[fields.at:])
        self.messages.setdefault(topic, []).append((time, message))
        return channel, time

    def check_message_index(self, content, at):
        fields, chunk = Cursor(content), self.chunks[-1]
        channel = fields.number("H")
        expect(fields.pairs("Q", "Q") == chunk["index"][channel], "a message index that is wrong")
        fields.end()
        chunk["indices_at"][channel] = at

    def check_summary(self, start):
        groups, sections, indices = {}, [], []
        for opcode, content, at in records(self.data, start, len(self.data) - 8):
            fields = Cursor(content)
            if opcode == SUMMARY_OFFSET:
                sections.append((at, fields.number("B"), fields.number("Q"), fields.number("Q")))
            elif opcode == FOOTER:
                self.check_footer(fields, start, at, sections, groups)
            else:
                first, length = groups.get(opcode, (at, 0))
                expect(first + length == at, "a group of the summary that is torn")
                groups[opcode] = first, length + 9 + len(content)
                if opcode == STATISTICS:
                    self.check_statistics(fields)
                elif opcode == CHUNK_INDEX:
                    indices.append(fields)
        expect(len(indices) == len(self.chunks), "chunks without an index")
        for fields, chunk in zip(indices, self.chunks):
            self.check_chunk_index(fields, chunk)

    def check_footer(self, fields, start, at, sections, groups):
        expect(fields.number("Q") == start, "wrong start of the summary")
        expect(fields.number("Q") == sections[0][0], "wrong start of the summary's offsets")
        expect(zlib.crc32(self.data[start:at + 9 + 16]) == fields.number("I"), "wrong CRC of the summary")
        expect({opcode: (first, length) for _, opcode, first, length in sections} == groups, "wrong summary offsets")
        expect(self.data[at + 9 + 20:] == MAGIC, "no magic at the end")

    def check_statistics(self, fields):
        count, schemas, channels, attachments, metadata, chunks = (fields.number(code) for code in "QHIIII")
        times, counts = (fields.number("Q"), fields.number("Q")), dict(fields.pairs("H", "Q"))
        stamps = [time for messages in self.messages.values() for time, _ in messages]
        expect((count, schemas, channels, attachments, metadata, chunks) ==
               (len(stamps), len(self.schemas), len(self.channels), 0, 0, len(self.chunks)), "wrong statistics")
        expect(times == (min(stamps, default=0), max(stamps, default=0)), "wrong times in the statistics")
        expect(counts == {c: len(self.messages.get(topic, [])) for c, (topic, _) in self.channels.items()},
               "wrong counts of messages")

    def check_chunk_index(self, fields, chunk):
        expect((fields.number("Q"), fields.number("Q")) == chunk["times"], "wrong times in a chunk's index")
        expect((fields.number("Q"), fields.number("Q")) == (chunk["at"], chunk["length"]), "a chunk is elsewhere")
        expect(dict(fields.pairs("H", "Q")) == chunk["indices_at"], "a message index is elsewhere")
        length = sum(9 + 2 + 4 + 16 * len(entries) for entries in chunk["index"].values())
        expect(fields.number("Q") == length, "wrong length of the message indices")
        expect(fields.text() == chunk["compression"], "another compression")
        expect((fields.number("Q"), fields.number("Q")) == chunk["sizes"], "wrong sizes in a chunk's index")
        fields.end()
