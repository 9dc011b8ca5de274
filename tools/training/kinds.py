"""The networks that this tool trains: their size, images, loss, and who is a person."""

import losses
import segnet
from batches import ClassImages, Images
from network import INPUT_HEIGHT, INPUT_WIDTH, PersonNetwork


class Kind:
    """`make(normalise)`; `size`: width and height of the input; `person`: from the network's
    output to the margin by which a pixel is a person."""

    def __init__(self, make, size, images, loss, person):
        self.make, self.size, self.images = make, size, images
        self.loss, self.person = loss, person


KINDS = {
    'person': Kind(PersonNetwork, (INPUT_WIDTH, INPUT_HEIGHT), Images, losses.of_person,
                   lambda logits: logits),
    'segnet': Kind(segnet.SegNet, (segnet.INPUT_WIDTH, segnet.INPUT_HEIGHT), ClassImages,
                   losses.of_classes, segnet.person_margin)}
