"""A SegNet from Caffe's files, with the two calls of OpenCV's networks that evaluate.py needs."""

import torch

import caffe_files
from network import set_weights
from segnet import SegNet


class SegNetReader:
    def __init__(self, path):
        self.network, self.blob = SegNet(normalise=False).eval(), None
        set_weights(self.network, caffe_files.read(path))

    def setInput(self, blob):
        self.blob = torch.from_numpy(blob)

    def forward(self):
        with torch.no_grad():
            return self.network(self.blob).numpy()
