#!/usr/bin/python3
"""Writes the weights of a checkpoint as an ONNX file, and checks that OpenCV computes the same."""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402
import torch  # noqa: E402

from checkpoint import averaged_network  # noqa: E402
from network import INPUT_HEIGHT, INPUT_WIDTH, normalised_input  # noqa: E402

OPSET = 11
LARGEST_DIFFERENCE = 1e-2  # of logits, between torch and OpenCV


def write(network, path):
    """`network`: without batch normalisation, on the processor."""
    torch.onnx.export(network, torch.zeros(1, 3, INPUT_HEIGHT, INPUT_WIDTH), str(path),
                      opset_version=OPSET, input_names=['image'], output_names=['logit'])


def difference(network, path):
    """Largest difference of a logit between torch and OpenCV, on noise."""
    noise = np.random.RandomState(0).randint(0, 256, (1, 3, INPUT_HEIGHT, INPUT_WIDTH))
    image = normalised_input(torch.from_numpy(noise).float())
    reader = cv2.dnn.readNet(str(path))
    reader.setInput(image.numpy())
    with torch.no_grad():
        return float(np.abs(network(image).numpy() - reader.forward()).max())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('checkpoint', type=Path, help='checkpoint.pt of a training')
    parser.add_argument('onnx', type=Path, help='file to write')
    args = parser.parse_args()
    network = averaged_network(args.checkpoint)
    write(network, args.onnx)
    apart = difference(network, args.onnx)
    print(f'{args.onnx}: {args.onnx.stat().st_size} bytes, OpenCV differs by at most {apart:.1e}')
    if not apart < LARGEST_DIFFERENCE:
        sys.exit('export: OpenCV computes something else than torch')


if __name__ == '__main__':
    main()
