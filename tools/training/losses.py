"""What training makes small: cross entropy, and a share of one minus the overlap of people."""

import torch
import torch.nn.functional as F

from segnet import PERSON

LEAST_WEIGHT = 0.05  # of a pixel whose label is not to be believed
DICE_SHARE = 0.25
DICE_PIXELS = 60  # keeps the overlap of images without people defined
# Of the SegNet's classes; the rarer, the more.
CLASS_WEIGHTS = (0.6, 3.0, 2.0, 1.5, 1.2, 2.5, 1.5, 2.5)


def lack_of_overlap(found, target, weight):
    both = (found * target * weight).sum((1, 2, 3))
    either = ((found + target) * weight).sum((1, 2, 3))
    return (1 - (2 * both + DICE_PIXELS) / (either + DICE_PIXELS)).mean()


def of_person(logits, target, weight):
    """At half the input's size."""
    target, weight = (F.avg_pool2d(plane, 2) for plane in (target, weight))
    weight = weight + LEAST_WEIGHT
    logits = F.interpolate(logits.float(), size=target.shape[2:], mode='bilinear',
                           align_corners=False)
    entropy = F.binary_cross_entropy_with_logits(logits, target, reduction='none')
    return ((entropy * weight).sum() / weight.sum() +
            DICE_SHARE * lack_of_overlap(torch.sigmoid(logits), target, weight))


def of_probabilities(scores, target, weight):
    """`target`: the probability of every class."""
    scores = scores.float()
    entropy = -(target * scores.log_softmax(dim=1)).sum(dim=1, keepdim=True)
    share = (target * scores.new_tensor(CLASS_WEIGHTS)[:, None, None]).sum(dim=1, keepdim=True)
    share = share * (weight + LEAST_WEIGHT)
    person = scores.softmax(dim=1)[:, PERSON:PERSON + 1]
    return ((entropy * share).sum() / share.sum().clamp(min=1) +
            DICE_SHARE * lack_of_overlap(person, target[:, PERSON:PERSON + 1], weight))


def of_classes(scores, target, weight):
    """`target`: the class of every pixel. Pixels whose label is not believed do not count."""
    scores, target = scores.float(), target[:, 0].long()
    entropy = F.cross_entropy(scores, target, reduction='none')
    share = scores.new_tensor(CLASS_WEIGHTS)[target] * weight[:, 0]
    person = scores.softmax(dim=1)[:, PERSON:PERSON + 1]
    truth = (target == PERSON).float()[:, None]
    return ((entropy * share).sum() / share.sum().clamp(min=1) +
            DICE_SHARE * lack_of_overlap(person, truth, weight))
