"""The photographs that networks are trained on, and which of them they never see.

A working folder holds

    images/SOURCE/NAME.webp     a photograph
    images/SOURCE/NAME.png      its true mask, 255 = person, where there is one
    teachers/SOURCE/NAME.png    what the teachers say of people in it (label.py)
    classes/SOURCE/NAME.png     what DeepLab says of all classes (label.py --classes)
"""

from pathlib import Path

ARCHIVES = ('clothing', 'kitchen', 'pennfudan', 'rooms', 'sport')
SOURCES = tuple(sorted(ARCHIVES + ('desks', 'rendered')))
# Rendered desks (render_desks.py), and a recording that nobody is in.
EMPTY_SOURCES = ('desks', 'kitchen')
# Passers-by and people far away are missing in the true masks of these.
INCOMPLETE_MASKS = ('clothing', 'pennfudan')
TRUE_CLASSES = ('desks', 'rendered')  # of things, in WORK/classes: no teacher's opinion

HELD_OUT_SOURCES = ('clothing', 'pennfudan', 'rooms')
HELD_OUT_EVERY = 10


def is_held_out(source, index):
    """Whether an image is for measuring only.

    `index` is its place, from 0, in the list of all images of its source sorted by file name. Every
    tenth image of clothing, pennfudan and rooms is held out: recordings that people or rooms are
    pasted into take them from these, and no training does."""
    return source in HELD_OUT_SOURCES and index % HELD_OUT_EVERY == 0


class Photograph:
    """One image of a source; the files beside it may be missing."""

    def __init__(self, work, source, path, index):
        self.source, self.path = source, path
        self.held_out = is_held_out(source, index)
        self.teachers_path = Path(work) / 'teachers' / source / (path.stem + '.png')
        self.classes_path = Path(work) / 'classes' / source / (path.stem + '.png')
        mask = path.with_suffix('.png')
        self.mask_path = mask if mask.exists() else None


def photographs(work, sources=SOURCES):
    """All images of these sources in a working folder, in a fixed order."""
    found = []
    for source in sources:
        paths = sorted((Path(work) / 'images' / source).glob('*.webp'))
        found += [Photograph(work, source, path, index) for index, path in enumerate(paths)]
    return found
