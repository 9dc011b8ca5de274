"""The state of a training in one file, and what can be read out of it."""

import os

import torch

from kinds import KINDS
from network import folded


class Average:
    """Exponential moving average of a network's weights: what is exported."""

    def __init__(self, network, state=None):
        source = state or network.state_dict()
        self.state = {name: value.detach().clone() for name, value in source.items()}

    @torch.no_grad()
    def add(self, network, iteration, longest):
        """Early on the average is over fewer iterations than `longest`."""
        step = max(1 / longest, 1 - (iteration + 1) / (iteration + 20))
        for name, value in network.state_dict().items():
            if value.dtype.is_floating_point:
                self.state[name].lerp_(value, step)
            else:
                self.state[name].copy_(value)


def save(path, **state):
    """Replaces the file at once: an interruption leaves the one before."""
    unfinished = path.with_suffix('.part')
    torch.save(state, unfinished)
    os.replace(unfinished, path)


def kind_of(state):
    """A name of kinds.py; checkpoints from before there was more than one kind do not say it."""
    return state.get('kind', 'person')


def averaged_network(path):
    """The averaged weights of a checkpoint, without batch normalisation, on the processor."""
    state = torch.load(path, map_location='cpu')
    network = KINDS[kind_of(state)].make(normalise=state['normalise'])
    network.load_state_dict(state['average'])
    network.eval()
    return folded(network) if state['normalise'] else network
