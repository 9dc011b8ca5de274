#!/usr/bin/python3
"""Writes the weights of a checkpoint for the plugins: of the person network as ONNX, of the SegNet
as Caffe's two files. Checks that what was written computes the same."""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402
import torch  # noqa: E402

import caffe_files  # noqa: E402
from checkpoint import averaged_network  # noqa: E402
from kinds import KINDS  # noqa: E402
from network import INPUT_HEIGHT, INPUT_WIDTH, normalised_input, set_weights  # noqa: E402
from segnet import SegNet  # noqa: E402

OPSET = 11
LARGEST_DIFFERENCE = 1e-2  # of logits


def write(network, path, size=(INPUT_WIDTH, INPUT_HEIGHT)):
    """`network`: without batch normalisation, on the processor."""
    if isinstance(network, SegNet):
        caffe_files.write(network, path, *size)
        return
    torch.onnx.export(network, torch.zeros(1, 3, size[1], size[0]), str(path),
                      opset_version=OPSET, input_names=['image'], output_names=['logit'])


def read_back(path, image):
    """What the file computes. OpenCV's importer knows no SegNet; a test of the plugin does that."""
    if path.suffix == '.caffemodel':
        network = SegNet(normalise=False).eval()
        set_weights(network, caffe_files.read(path))
        with torch.no_grad():
            return network(image).numpy()
    reader = cv2.dnn.readNet(str(path))
    reader.setInput(image.numpy())
    return reader.forward()


def difference(network, path, size=(INPUT_WIDTH, INPUT_HEIGHT)):
    """Largest difference of a score between the network and its file, on noise."""
    noise = np.random.RandomState(0).randint(0, 256, (1, 3, size[1], size[0]))
    image = normalised_input(torch.from_numpy(noise).float())
    with torch.no_grad():
        return float(np.abs(network(image).numpy() - read_back(path, image)).max())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('checkpoint', type=Path, help='checkpoint.pt of a training')
    parser.add_argument('file', type=Path, help='to write: .onnx, or .caffemodel for a SegNet')
    parser.add_argument('--size', type=int, nargs=2, metavar=('WIDTH', 'HEIGHT'),
                        help='of the input, where that in use is not wanted; 32 divides both')
    args = parser.parse_args()
    network = averaged_network(args.checkpoint)
    size = args.size or KINDS['segnet' if isinstance(network, SegNet) else 'person'].size
    if min(size) < 32 or any(side % 32 for side in size):
        parser.error('--size: 32 must divide both sides')
    needed = '.caffemodel' if isinstance(network, SegNet) else '.onnx'
    if args.file.suffix != needed:
        parser.error(f'{args.checkpoint} is of a network whose file ends in {needed}')
    write(network, args.file, size)
    apart = difference(network, args.file, size)
    print(f'{args.file}: {args.file.stat().st_size} bytes, differs by at most {apart:.1e}')
    if not apart < LARGEST_DIFFERENCE:
        sys.exit(f'export: the file computes something else than the checkpoint, by {apart:.1e}')


if __name__ == '__main__':
    main()
