#!/usr/bin/python3
"""Trains the person network or the SegNet, from scratch or further from weights.

Interrupted, it goes on from its last checkpoint when it is called again in the same way."""

import argparse
import math
import random
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

import cv2  # noqa: E402
import numpy as np  # noqa: E402
import torch  # noqa: E402
from torch import nn  # noqa: E402
from torch.utils.data import DataLoader  # noqa: E402

import caffe_files  # noqa: E402
import checkpoint  # noqa: E402
import onnx_weights  # noqa: E402
from distil import Distillation  # noqa: E402
from held_out import HeldOut  # noqa: E402
from kinds import KINDS  # noqa: E402
from network import normalised_input, set_weights  # noqa: E402
from samples import Collection  # noqa: E402
from sources import photographs  # noqa: E402

LARGEST_GRADIENT = 2.0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('output', type=Path, help='folder for checkpoint.pt')
    parser.add_argument('--network', choices=list(KINDS), default='person')
    parser.add_argument('--size', type=int, nargs=2, metavar=('WIDTH', 'HEIGHT'),
                        help='of the input, less than in use for a quick beginning')
    parser.add_argument('--start', type=Path, metavar='FILE',
                        help='exported weights (.onnx, .caffemodel), or the checkpoint (.pt) of '
                             'another training, to train further; default: from scratch')
    parser.add_argument('--iterations', type=int, default=3000)
    parser.add_argument('--batch', type=int, default=16)
    parser.add_argument('--rate', type=float, default=1e-3,
                        help='largest learning rate, see README')
    parser.add_argument('--warm-up', type=int, default=100, help='iterations')
    parser.add_argument('--average', type=int, default=300, help='iterations of the average')
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument('--device', default='cuda' if torch.cuda.is_available() else 'cpu')
    parser.add_argument('--threads', type=int, default=2, help='of torch, on a processor')
    parser.add_argument('--workers', type=int, default=1, help='processes that make images')
    parser.add_argument('--precision', choices=['float', 'bfloat16', 'auto'], default='auto',
                        help='of convolutions; auto: bfloat16 on what is fast with it')
    parser.add_argument('--cache', action='store_true',
                        help='use the images of fill_cache.py: SegNet only')
    parser.add_argument('--hints', type=float, default=0, metavar='WEIGHT', help=
                        "with --cache: of the teachers' features in the loss; falls as the rate")
    parser.add_argument('--hints-only', type=int, default=0, metavar='ITERATIONS',
                        help='train only the encoder, on hints, at first')
    parser.add_argument('--save-every', type=int, default=100, help='iterations')
    args = parser.parse_args()
    args.size = tuple(args.size or KINDS[args.network].size)
    if min(args.size) < 32 or any(side % 32 for side in args.size):
        parser.error('--size: 32 must divide both sides')
    return args


def rate_at(iteration, args):
    """Rises over the warm-up, then falls as half a cosine."""
    share = min(1.0, iteration / args.iterations)
    rise = min(1.0, (iteration + 1) / args.warm_up)
    return args.rate * rise * (0.005 + 0.995 * (0.5 + 0.5 * math.cos(math.pi * share)))


def scale_of(value, normalise):
    """What a parameter's learning rate is multiplied with. Where the normalisation is part of the
    convolutions, their weights differ hundredfold in size, and steps have to follow that."""
    return 1.0 if normalise else max(0.01, float(value.detach().square().mean().sqrt()))


def make_optimiser(network, normalise, more):
    groups = [{'params': [value], 'weight_decay': 0.02 if value.ndim > 1 and normalise else 0,
               'scale': scale_of(value, normalise)} for value in network.parameters()]
    groups += [{'params': [value], 'weight_decay': 0, 'scale': 1.0} for value in more]
    return torch.optim.AdamW(groups, lr=0)


def use_bfloat16(precision, device):
    if precision == 'auto':
        processor = Path('/proc/cpuinfo')
        return 'cuda' in device or (processor.exists() and 'avx512_bf16' in processor.read_text())
    return precision == 'bfloat16'


def start_state(args):
    """What a training that has no checkpoint of its own begins with."""
    if args.start is None:
        return {'normalise': True}
    if args.start.suffix == '.pt':
        state = torch.load(args.start, map_location='cpu')
        if checkpoint.kind_of(state) != args.network:
            sys.exit(f'train: {args.start} is of the network {checkpoint.kind_of(state)}')
        return {'normalise': state['normalise'], 'average': state['average']}
    reader = caffe_files if args.start.suffix == '.caffemodel' else onnx_weights
    return {'normalise': False, 'weights': reader.read(args.start)}


class Labels(nn.Module):
    """Training with images made anew, and their labels."""

    def __init__(self, photos, args):
        super().__init__()
        self.args, self.kind = args, KINDS[args.network]
        self.collection = Collection(photo for photo in photos if not photo.held_out)
        print(f'to train on: {self.collection}', flush=True)
        if not all((self.collection.people, self.collection.empty, self.collection.cut_outs)):
            sys.exit('train: needs photographs with people, some with outlines to cut out, and '
                     'empty ones: run prepare.py and label.py')

    def batches(self, first):
        args = self.args
        images = self.kind.images(self.collection, args.seed, first * args.batch,
                                  (args.iterations - first) * args.batch, args.size)
        return DataLoader(images, args.batch, num_workers=args.workers,
                          worker_init_fn=one_thread, pin_memory='cuda' in args.device)

    def loss(self, network, _, images, target, weight):
        return self.kind.loss(network(images), target, weight)


class Training:
    """Network, optimiser and average; made anew or from a checkpoint. `task`: what gives batches
    and the loss; it may have parameters of its own, which are not exported."""

    def __init__(self, task, args):
        self.task = task.to(args.device)
        self.args, self.file = args, args.output / 'checkpoint.pt'
        self.bfloat16 = use_bfloat16(args.precision, args.device)
        state = torch.load(self.file, map_location='cpu') if self.file.exists() else None
        if state and checkpoint.kind_of(state) != args.network:
            sys.exit(f'train: {self.file} is of the network {checkpoint.kind_of(state)}: use '
                     'another output folder, or --network')
        begun = state or start_state(args)
        self.normalise = begun['normalise']
        self.network = KINDS[args.network].make(self.normalise)
        self.iteration = 0
        if state:
            self.network.load_state_dict(state['network'])
            self.iteration = state['iteration']
        elif 'average' in begun:
            self.network.load_state_dict(begun['average'])
        elif 'weights' in begun:
            set_weights(self.network, begun['weights'])
        self.network.to(args.device, memory_format=torch.channels_last).train()
        self.optimiser = make_optimiser(self.network, self.normalise, task.parameters())
        self.average = checkpoint.Average(self.network)
        if state:
            self.optimiser.load_state_dict(state['optimiser'])
            for name, value in state['average'].items():
                self.average.state[name].copy_(value)
            self.task.load_state_dict(state.get('task', {}))
            restore_random_state(state['random'])

    def step(self, images, *labels):
        for group in self.optimiser.param_groups:
            group['lr'] = rate_at(self.iteration, self.args) * group['scale']
        device = self.args.device
        images = normalised_input(images.to(device, non_blocking=True).float())
        images = images.contiguous(memory_format=torch.channels_last)
        labels = [label.to(device) for label in labels]
        with torch.autocast(device.split(':')[0], torch.bfloat16, enabled=self.bfloat16):
            loss = self.task.loss(self.network, self.iteration, images, *labels)
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), LARGEST_GRADIENT)
        self.optimiser.step()
        self.average.add(self.network, self.iteration, self.args.average)
        self.iteration += 1
        return loss.item()

    def save(self):
        checkpoint.save(self.file, kind=self.args.network, iteration=self.iteration,
                        normalise=self.normalise,
                        network=self.network.state_dict(), average=self.average.state,
                        optimiser=self.optimiser.state_dict(), task=self.task.state_dict(),
                        random=random_state())


def random_state():
    """Images have generators of their own; this is for what else draws numbers."""
    state = {'python': random.getstate(), 'numpy': np.random.get_state(),
             'torch': torch.get_rng_state()}
    if torch.cuda.is_available():
        state['cuda'] = torch.cuda.get_rng_state_all()
    return state


def restore_random_state(state):
    random.setstate(state['python'])
    np.random.set_state(state['numpy'])
    torch.set_rng_state(state['torch'])
    if 'cuda' in state and torch.cuda.is_available():
        torch.cuda.set_rng_state_all(state['cuda'])


def one_thread(_):
    cv2.setNumThreads(1)
    torch.set_num_threads(1)


def run(training, held_out, args):
    start, losses = time.monotonic(), []
    for batch in training.task.batches(training.iteration):
        losses.append(training.step(*batch))
        if training.iteration % args.save_every and training.iteration != args.iterations:
            continue
        training.save()
        speed = len(losses) * args.batch / (time.monotonic() - start)
        print(f'{training.iteration} of {args.iterations}: loss {np.mean(losses):.4f}, '
              f'{speed:.1f} images/s; {held_out.measure(training.file)}', flush=True)
        start, losses = time.monotonic(), []


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(args.threads)
    random.seed(args.seed)
    np.random.seed(args.seed)
    torch.manual_seed(args.seed)
    photos = photographs(args.work)
    held_out = HeldOut([photo for photo in photos if photo.held_out], KINDS[args.network],
                       args.size)
    training = Training(Distillation(args) if args.cache else Labels(photos, args), args)
    if training.iteration >= args.iterations:
        sys.exit(f'train: {training.file} has {training.iteration} iterations: nothing to do')
    run(training, held_out, args)


if __name__ == '__main__':
    main()
