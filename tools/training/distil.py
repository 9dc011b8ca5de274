"""What the SegNet's training minimises with images of a cache: the teachers' features, and labels."""

import math

import numpy as np
import torch
from torch import nn

import hints
import losses
from cache import Cache

LOOK_AGAIN = 20  # iterations after which the cache may have more images


class Distillation(nn.Module):
    """In the first `hints_only` iterations the decoder rests: more images in the same time."""

    def __init__(self, args):
        super().__init__()
        self.args, self.adapters = args, hints.Adapters()
        self.cache = Cache(args.work / 'cache')

    def batches(self, first):
        args = self.args
        for iteration in range(first, args.iterations):
            if iteration % LOOK_AGAIN == 0:
                self.cache.look_again()
            rng = np.random.default_rng([args.seed, iteration])
            yield self.cache.batch(rng, args.batch, args.size, bool(args.hints))

    def loss(self, network, iteration, images, target, weight, *found):
        encoded = network.encode(images)
        loss = 0
        if self.args.hints:
            loss = self.hint_weight(iteration) * self.adapters.loss(
                [before for before, _ in encoded[1]], found)
        if iteration < self.args.hints_only:
            return loss
        return loss + losses.of_probabilities(network.decode(encoded), target, weight)

    def hint_weight(self, iteration):
        """Hints are for the beginning: labels have the last word."""
        share = iteration / self.args.iterations
        return self.args.hints * (0.5 + 0.5 * math.cos(math.pi * share))
