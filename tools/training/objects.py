"""Drawn things of desks and shelves: what must not be taken for people.

Every function returns an 8-bit BGR image and its 8-bit opacity. `texture(rng, width, height)` gives
a piece of a photograph without people."""

import cv2
import numpy as np


def colour(rng, lowest=0, highest=256):
    """Often grey, white or black, as most things on desks are."""
    kind = rng.random()
    if kind < 0.2:
        values = rng.integers(5, 60) + rng.integers(0, 8, 3)
    elif kind < 0.4:
        values = rng.integers(150, 247) + rng.integers(0, 8, 3)
    else:
        values = rng.integers(lowest, highest, 3)
    return tuple(values.tolist())


def filled(width, height, bgr):
    return np.full((height, width, 3), bgr, np.uint8)


def opaque(image):
    return image, np.full(image.shape[:2], 255, np.uint8)


def lit(rng, image, strength=0.5):
    """Light that changes along one direction."""
    height, width = image.shape[:2]
    across = np.linspace(-1, 1, width, dtype=np.float32) * rng.uniform(-strength, strength)
    down = np.linspace(-1, 1, height, dtype=np.float32)[:, None] * rng.uniform(-strength, strength)
    return np.clip(image * (1 + across + down)[:, :, None], 0, 255).astype(np.uint8)


def write_lines(rng, image):
    """Lines of text."""
    height, width = image.shape[:2]
    ink, step = colour(rng, 0, 120), int(rng.integers(4, 11))
    left, right = width // 10 + 1, max(width // 10 + 2, width * 9 // 10)
    for y in range(height // 10 + 2, height * 9 // 10, step):
        x = left
        while x < right and rng.random() > 0.06:
            end = min(right, x + int(rng.integers(2, 14)))
            cv2.line(image, (x, y), (end, y), ink, 1)
            x = end + 2


def sheet(rng, texture):
    """A paper, a book from above, a poster."""
    width, height = (int(side) for side in rng.integers(40, 110, 2))
    image = filled(width, height, colour(rng))
    if rng.random() < 0.5:
        image = texture(rng, width, height)
    if rng.random() < 0.5:
        x, y = int(rng.integers(0, width // 2)), int(rng.integers(0, height // 2))
        part = image[y:y + height // 2, x:x + width // 2]
        part[:] = texture(rng, part.shape[1], part.shape[0])
    if rng.random() < 0.6:
        write_lines(rng, image)
    return opaque(image)


def keyboard(rng, _):
    columns, rows, key = int(rng.integers(10, 20)), int(rng.integers(4, 7)), int(rng.integers(5, 9))
    image = filled(columns * key + 8, rows * key + 8, colour(rng))
    cap = colour(rng)
    for row in range(rows):
        for column in range(columns):
            x, y = 4 + column * key, 4 + row * key
            cv2.rectangle(image, (x, y), (x + key - 2, y + key - 2), cap, -1)
    return opaque(image)


def monitor(rng, texture):
    width, height = int(rng.integers(80, 160)), int(rng.integers(60, 110))
    foot, frame = int(rng.integers(10, 35)), int(rng.integers(2, 8))
    image, opacity = filled(width, height + foot, colour(rng, 0, 80)), np.zeros(
        (height + foot, width), np.uint8)
    screen = image[frame:height - frame, frame:width - frame]
    kind = rng.random()
    if kind < 0.55:
        screen[:] = colour(rng, 0, 50) if kind < 0.3 else rng.integers(0, 30)
    else:
        screen[:] = texture(rng, screen.shape[1], screen.shape[0])
        write_lines(rng, screen)
    opacity[:height] = 255
    middle = width // 2
    cv2.rectangle(opacity, (middle - width // 12, height), (middle + width // 12, height + foot),
                  255, -1)
    cv2.ellipse(opacity, (middle, height + foot - 4), (width // 4, foot // 3), 0, 0, 360, 255, -1)
    return lit(rng, image, 0.3), opacity


def carton(rng, texture):
    """A box of which the front, the top and one side show."""
    width, height, depth = (int(side) for side in rng.integers(25, 90, 3))
    depth = depth // 2 + 4
    image = filled(width + depth, height + depth, 0)
    opacity = np.zeros(image.shape[:2], np.uint8)
    base = np.array(colour(rng), np.float32)
    front = np.array([(0, depth), (width, depth), (width, depth + height), (0, depth + height)])
    top = np.array([(0, depth), (depth, 0), (width + depth, 0), (width, depth)])
    side = np.array([(width, depth), (width + depth, 0), (width + depth, height),
                     (width, depth + height)])
    for face in (front, top, side):
        cv2.fillConvexPoly(opacity, face, 255)
        cv2.fillConvexPoly(image, face, np.clip(base * rng.uniform(0.4, 1.2), 0, 255).tolist())
    part = image[depth:, :width]
    if rng.random() < 0.5:
        part[:] = texture(rng, part.shape[1], part.shape[0])
    if rng.random() < 0.5:
        write_lines(rng, part)
    return image, opacity


def cylinder(rng, texture):
    """A mug, a can, a bottle, a lamp shade."""
    width, height = int(rng.integers(20, 60)), int(rng.integers(25, 110))
    top = max(2, int(width * rng.uniform(0.05, 0.25)))
    image = filled(width, height, colour(rng))
    if rng.random() < 0.4:
        image = texture(rng, width, height)
    round_light = np.cos(np.linspace(-1.4, 1.4, width) + rng.uniform(-0.5, 0.5))
    image = np.clip(image * (0.35 + 0.75 * round_light)[None, :, None], 0, 255).astype(np.uint8)
    opacity = np.zeros((height, width), np.uint8)
    cv2.rectangle(opacity, (0, top), (width, height - top - 1), 255, -1)
    for y in (top, height - top - 1):
        cv2.ellipse(opacity, (width // 2, y), (width // 2, top), 0, 0, 360, 255, -1)
    cv2.ellipse(image, (width // 2, top), (width // 2, top), 0, 0, 360, colour(rng), -1)
    if rng.random() < 0.3:  # the neck of a bottle
        cut, shoulder = int(width * rng.uniform(0.2, 0.4)), int(height * rng.uniform(0.2, 0.5))
        opacity[:shoulder, :cut] = opacity[:shoulder, width - cut:] = 0
    return image, opacity


def outline(rng, size, roughness):
    """A closed smooth curve around the middle of a square."""
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    radius = np.full(60, 1.0)
    for wave in range(2, 7):
        radius += roughness / wave * rng.normal() * np.cos(wave * angles + rng.uniform(0, 6.3))
    radius = np.clip(radius, 0.25, 1.6) / 1.6 * (size / 2 - 1)
    flat = rng.uniform(0.4, 1)
    points = np.stack([np.cos(angles) * radius, np.sin(angles) * radius * flat], axis=1)
    return (points + size / 2).astype(np.int32)


def lump(rng, texture):
    """A gamepad, a bag, a toy, a piece of a photograph: anything with a smooth outline."""
    size = int(rng.integers(30, 110))
    opacity = np.zeros((size, size), np.uint8)
    cv2.fillPoly(opacity, [outline(rng, size, rng.uniform(0.2, 1.2))], 255, cv2.LINE_AA)
    image = texture(rng, size, size) if rng.random() < 0.5 else filled(size, size, colour(rng))
    heights = cv2.GaussianBlur(opacity.astype(np.float32) / 255, (0, 0), size / 8)
    slope = np.gradient(heights)[int(rng.integers(2))] * size / 4 * rng.choice([-1, 1])
    image = np.clip(image * (0.8 + slope)[:, :, None], 0, 255).astype(np.uint8)
    for _ in range(int(rng.integers(0, 6))):
        centre = tuple(int(value) for value in rng.integers(size // 4, size * 3 // 4, 2))
        cv2.circle(image, centre, int(rng.integers(1, max(2, size // 8))), colour(rng), -1)
    return image, opacity


def plant(rng, _):
    """Many leaves of one hue; also flowers, wrapping paper, a heap of small parts."""
    size, base = int(rng.integers(40, 110)), np.array(colour(rng), np.float32)
    image, opacity = filled(size, size, 0), np.zeros((size, size), np.uint8)
    for _ in range(int(rng.integers(8, 40))):
        centre = tuple(int(value) for value in rng.normal(size / 2, size / 5, 2))
        axes = int(rng.integers(2, max(3, size // 6))), int(rng.integers(2, max(3, size // 12)))
        turn = float(rng.uniform(0, 180))
        shade = np.clip(base * rng.uniform(0.3, 1.5) + rng.normal(0, 20, 3), 0, 255).tolist()
        cv2.ellipse(image, centre, axes, turn, 0, 360, shade, -1)
        cv2.ellipse(opacity, centre, axes, turn, 0, 360, 255, -1)
    return image, opacity


def row_of_books(rng, texture):
    height = int(rng.integers(40, 100))
    image = filled(int(rng.integers(60, 180)), height, colour(rng, 0, 60))
    x = 0
    while x < image.shape[1]:
        width, top = int(rng.integers(3, 18)), int(rng.integers(0, height // 4))
        spine = image[top:, x:x + width]
        spine[:] = colour(rng)
        if rng.random() < 0.2 and spine.shape[1] > 3:
            spine[:] = texture(rng, spine.shape[1], spine.shape[0])
        if width > 5:
            y = int(rng.integers(top, height))
            cv2.rectangle(image, (x + 1, y), (x + width - 2, y + height // 6), colour(rng), -1)
        x += width
    return opaque(image)


def chair(rng, _):
    """A rounded back and a seat on a leg: the thing on which people are expected."""
    width, height = int(rng.integers(50, 110)), int(rng.integers(90, 160))
    image, opacity = filled(width, height, colour(rng, 0, 120)), np.zeros((height, width), np.uint8)
    middle, back = width // 2, int(height * rng.uniform(0.35, 0.55))
    cv2.ellipse(opacity, (middle, back // 2), (int(width * 0.4), back // 2), 0, 0, 360, 255, -1)
    cv2.rectangle(opacity, (middle - 3, back - 4), (middle + 3, height - 10), 255, -1)
    seat = middle, back + height // 8
    cv2.ellipse(opacity, seat, (width // 2, height // 12), 0, 0, 360, 255, -1)
    for foot in (0.1, 0.5, 0.9):
        cv2.line(opacity, (middle, height - 14), (int(width * foot), height - 2), 255, 4)
    return lit(rng, image), opacity


def bundle(rng, texture):
    """Pens in a mug, flowers in a vase, brushes, cutlery."""
    pot, opacity = cylinder(rng, texture)
    height, width = opacity.shape
    above = int(height * rng.uniform(0.4, 1.2))
    image = np.vstack([filled(width * 2, above, 0), np.zeros((height, width * 2, 3), np.uint8)])
    cover = np.zeros(image.shape[:2], np.uint8)
    left = width // 2
    for _ in range(int(rng.integers(3, 16))):
        foot = left + int(rng.integers(width // 4, width * 3 // 4 + 1)), above + height // 2
        tip = left + int(rng.uniform(-0.4, 1.4) * width), int(rng.uniform(0, 0.7) * above)
        thick = int(rng.integers(1, 6))
        cv2.line(image, foot, tip, colour(rng), thick)
        cv2.line(cover, foot, tip, 255, thick)
        if rng.random() < 0.3:
            cv2.circle(image, tip, thick * 2, colour(rng), -1)
            cv2.circle(cover, tip, thick * 2, 255, -1)
    front = opacity > 0
    image[above:, left:left + width][front] = pot[front]
    cover[above:, left:left + width][front] = 255
    return image, cover


KINDS = (sheet, sheet, keyboard, monitor, carton, carton, cylinder, lump, lump, lump, plant,
         bundle, bundle, row_of_books, chair)


def any_object(rng, texture):
    image, opacity = KINDS[int(rng.integers(len(KINDS)))](rng, texture)
    return lit(rng, image, 0.35), opacity
