"""Damaged TensorFlow Lite files are converted or refused, and soon: 800 copies of a network with some
bytes or numbers of it replaced."""

import random
import signal
import struct
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / 'tools'))

from model_conversion.conversion import convert  # noqa: E402

NETWORK = ROOT / 'plugins/segmenter_opencv_dnn/test_data/quantised.tflite'
NUMBERS = (0, 1, 0xffff, 1 << 20, 0x7fffffff, 0xffffffff)
HEADER = 8  # bytes, which say that it is such a file


def damaged(data, choice):
    data = bytearray(data)
    for _ in range(choice.choice((1, 1, 2, 8))):
        at = choice.randrange(HEADER, len(data) - 4)
        if choice.random() < 0.5:
            data[at] = choice.randrange(256)
        else:
            data[at:at + 4] = struct.pack('<I', choice.choice(NUMBERS))
    return data


def main():
    choice, refused, cases = random.Random(1), 0, 800
    original = NETWORK.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / 'net.tflite', Path(folder) / 'net.onnx'
        for _ in range(cases):
            source.write_bytes(damaged(original, choice))
            signal.alarm(60)  # ends the process: of a case that takes 20 ms
            try:
                convert(source, target)
            except ValueError:
                refused += 1
    print(f'{refused} of {cases} were refused')
    sys.exit(not 0 < refused < cases)


main()
