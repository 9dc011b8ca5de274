#!/usr/bin/python3
"""Trains the person network, from scratch or further from exported weights.

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
import torch.nn.functional as F  # noqa: E402
from torch.utils.data import DataLoader  # noqa: E402

import checkpoint  # noqa: E402
import onnx_weights  # noqa: E402
from batches import Images  # noqa: E402
from held_out import HeldOut  # noqa: E402
from network import PersonNetwork, normalised_input, set_weights  # noqa: E402
from samples import Collection  # noqa: E402
from sources import photographs  # noqa: E402

LEAST_WEIGHT = 0.05  # of a pixel whose label is not to be believed
DICE_SHARE = 0.25
DICE_PIXELS = 60  # keeps the overlap of images without people defined
LARGEST_GRADIENT = 2.0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('work', type=Path, help='working folder, see prepare.py')
    parser.add_argument('output', type=Path, help='folder for checkpoint.pt')
    parser.add_argument('--start', type=Path, metavar='ONNX',
                        help='exported weights to train further; default: from scratch')
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
    parser.add_argument('--save-every', type=int, default=100, help='iterations')
    return parser.parse_args()


def rate_at(iteration, args):
    """Rises over the warm-up, then falls as half a cosine."""
    share = min(1.0, iteration / args.iterations)
    rise = min(1.0, (iteration + 1) / args.warm_up)
    return args.rate * rise * (0.005 + 0.995 * (0.5 + 0.5 * math.cos(math.pi * share)))


def scale_of(value, normalise):
    """What a parameter's learning rate is multiplied with. Where the normalisation is part of the
    convolutions, their weights differ hundredfold in size, and steps have to follow that."""
    return 1.0 if normalise else max(0.01, float(value.detach().square().mean().sqrt()))


def make_optimiser(network, normalise):
    groups = [{'params': [value], 'weight_decay': 0.02 if value.ndim > 1 and normalise else 0,
               'scale': scale_of(value, normalise)} for value in network.parameters()]
    return torch.optim.AdamW(groups, lr=0)


def use_bfloat16(precision, device):
    if precision == 'auto':
        processor = Path('/proc/cpuinfo')
        return 'cuda' in device or (processor.exists() and 'avx512_bf16' in processor.read_text())
    return precision == 'bfloat16'


def loss_of(logits, target, weight):
    """Cross entropy, and a share of one minus the overlap; at half the input's size."""
    target, weight = (F.avg_pool2d(plane, 2) for plane in (target, weight))
    weight = weight + LEAST_WEIGHT
    logits = F.interpolate(logits.float(), size=target.shape[2:], mode='bilinear',
                           align_corners=False)
    entropy = F.binary_cross_entropy_with_logits(logits, target, reduction='none')
    found = torch.sigmoid(logits)
    both = (found * target * weight).sum((1, 2, 3))
    either = ((found + target) * weight).sum((1, 2, 3))
    dice = 1 - (2 * both + DICE_PIXELS) / (either + DICE_PIXELS)
    return (entropy * weight).sum() / weight.sum() + DICE_SHARE * dice.mean()


class Training:
    """Network, optimiser and average; made anew or from a checkpoint."""

    def __init__(self, args):
        self.args, self.file = args, args.output / 'checkpoint.pt'
        self.bfloat16 = use_bfloat16(args.precision, args.device)
        state = torch.load(self.file, map_location='cpu') if self.file.exists() else None
        self.normalise = state['normalise'] if state else args.start is None
        self.network = PersonNetwork(self.normalise)
        self.iteration = 0
        if state:
            self.network.load_state_dict(state['network'])
            self.iteration = state['iteration']
        elif args.start:
            set_weights(self.network, onnx_weights.read(args.start))
        self.network.to(args.device, memory_format=torch.channels_last).train()
        self.optimiser = make_optimiser(self.network, self.normalise)
        self.average = checkpoint.Average(self.network)
        if state:
            self.optimiser.load_state_dict(state['optimiser'])
            for name, value in state['average'].items():
                self.average.state[name].copy_(value)
            restore_random_state(state['random'])

    def step(self, images, target, weight):
        for group in self.optimiser.param_groups:
            group['lr'] = rate_at(self.iteration, self.args) * group['scale']
        device = self.args.device
        images = normalised_input(images.to(device, non_blocking=True).float())
        images = images.contiguous(memory_format=torch.channels_last)
        with torch.autocast(device.split(':')[0], torch.bfloat16, enabled=self.bfloat16):
            logits = self.network(images)
        loss = loss_of(logits, target.to(device), weight.to(device))
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), LARGEST_GRADIENT)
        self.optimiser.step()
        self.average.add(self.network, self.iteration, self.args.average)
        self.iteration += 1
        return loss.item()

    def save(self):
        checkpoint.save(self.file, iteration=self.iteration, normalise=self.normalise,
                        network=self.network.state_dict(), average=self.average.state,
                        optimiser=self.optimiser.state_dict(), random=random_state())


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


def run(training, collection, held_out, args):
    remaining = args.iterations - training.iteration
    images = Images(collection, args.seed, training.iteration * args.batch, remaining * args.batch)
    loader = DataLoader(images, args.batch, num_workers=args.workers, worker_init_fn=one_thread,
                        pin_memory='cuda' in args.device)
    start, losses = time.monotonic(), []
    for batch in loader:
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
    collection = Collection(photo for photo in photos if not photo.held_out)
    print(f'to train on: {collection}', flush=True)
    held_out = HeldOut([photo for photo in photos if photo.held_out])
    training = Training(args)
    if training.iteration >= args.iterations:
        sys.exit(f'train: {training.file} has {training.iteration} iterations: nothing to do')
    if not collection.people or not collection.empty or not collection.cut_outs:
        sys.exit('train: needs photographs with people, some with outlines to cut out, and empty '
                 'ones: run prepare.py and label.py')
    run(training, collection, held_out, args)


if __name__ == '__main__':
    main()
