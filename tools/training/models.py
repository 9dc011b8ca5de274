"""Three-dimensional models of things, as coloured points on their surfaces.

The models are those of Debian's package sweethome3d-furniture (CC-BY 3.0, CC0): about 800 things of
houses and offices, of which people, clothes and what is larger than a room are left out."""

import os
import re
from pathlib import Path
from zipfile import ZipFile

import cv2
import numpy as np

POINTS = 120000  # per model
LEFT_OUT_CATEGORIES = ('Characters', 'Doors and windows', 'Exterior', 'Staircases', 'Vehicles')
# What people wear, or what looks like a person.
LEFT_OUT_NAMES = re.compile(
    'mannequin|clothes|dress$|jacket|trousers|skirt|suit$|short|doll$|snowman|glove|towel', re.I)
LARGEST = 2.5  # m
# VOC's classes by name, the first that fits; the numbers are VOC's.
VOC_NAMES = ((5, 'bottle'), (16, 'plant$|flowers$|bonsai|ficus|tulips|orchids|yucca|spathi|bamboo'),
             (9, 'chair|bar stool'), (18, 'sofa|couch'), (20, '^tv( 16:9)?$|imac|wall flat tv|screen$'),
             (11, 'table$|desk$|dining'))


def unpack(archives, work):
    """Unpacks `archives` (a folder with .sh3f files) into WORK/models; done once."""
    for archive in sorted(Path(archives).glob('*.sh3f')):
        folder = Path(work) / 'models' / archive.stem
        if not folder.exists():
            with ZipFile(archive) as files:
                files.extractall(folder)


class Model:
    """`file`: the .obj; `size`: width, depth, height in metres; `voc_id`: its class, 0 if none."""

    def __init__(self, file, size, name):
        self.file, self.size = file, size
        self.voc_id = next((number for number, names in VOC_NAMES
                            if re.search(names, name, re.I)), 0)


def catalogue(work):
    """All models that may stand on a desk or around it, in a fixed order."""
    found = []
    for properties in sorted(Path(work).glob('models/*/PluginFurnitureCatalog.properties')):
        entries = {}
        for line in properties.read_text(encoding='latin-1').splitlines():
            if match := re.match(r'(\w+)#(\d+)=(.*)', line):
                entries.setdefault(int(match[2]), {})[match[1]] = match[3].strip()
        for entry in entries.values():
            if (entry.get('category') in LEFT_OUT_CATEGORIES or
                    LEFT_OUT_NAMES.search(entry.get('name', '')) or
                    not entry.get('model', '').endswith('.obj')):
                continue
            size = np.array([float(entry[side]) / 100 for side in ('width', 'depth', 'height')])
            if size.max() <= LARGEST:
                found.append(Model(properties.parent / entry['model'].lstrip('/'), size, entry['name']))
    return found


def read_materials(file):
    """Of every material its colour (BGR, 0 to 1) and its image, or None."""
    materials, name = {}, None
    if not file.exists():
        return materials
    for line in file.read_text(encoding='latin-1').splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == 'newmtl':
            name = line.split(None, 1)[1].strip()
            materials[name] = [np.full(3, 0.7), None]
        elif words[0] == 'Kd' and name:
            materials[name][0] = np.array([float(word) for word in words[3:0:-1]])
        elif words[0] == 'map_Kd' and name:
            image = file.parent / line.split(None, 1)[1].strip()
            materials[name][1] = cv2.imread(str(image)) if image.exists() else None
    return materials


def index_of(word, count):
    """An index of an .obj file, which counts from 1, or backwards from the end."""
    number = int(word)
    return number - 1 if number > 0 else count + number


def read_obj(file):
    """Corners of triangles (n x 3 x 3), their texture coordinates (n x 3 x 2), the material's
    number of each, and the list of materials."""
    vertices, coordinates, corners, textured, numbers = [], [], [], [], []
    materials, names, current = {}, [None], 0
    for line in file.read_text(encoding='latin-1').splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == 'v':
            vertices.append([float(word) for word in words[1:4]])
        elif words[0] == 'vt':
            coordinates.append([float(word) for word in words[1:3]])
        elif words[0] == 'mtllib':
            materials.update(read_materials(file.parent / line.split(None, 1)[1].strip()))
        elif words[0] == 'usemtl':
            names.append(line.split(None, 1)[1].strip())
            current = len(names) - 1
        elif words[0] == 'f':
            parts = [word.split('/') for word in words[1:]]
            points = [index_of(part[0], len(vertices)) for part in parts]
            places = [index_of(part[1], len(coordinates)) if len(part) > 1 and part[1] else -1
                      for part in parts]
            for i in range(1, len(points) - 1):
                corners.append((points[0], points[i], points[i + 1]))
                textured.append((places[0], places[i], places[i + 1]))
                numbers.append(current)
    vertices = np.array(vertices, np.float64)
    coordinates = np.array(coordinates + [[0.0, 0.0]], np.float64)
    known = [materials.get(name, [np.full(3, 0.7), None]) for name in names]
    return vertices[np.array(corners)], coordinates[np.array(textured)], np.array(numbers), known


def sample_surface(rng, triangles, coordinates, numbers, materials, count):
    """Points spread evenly over the triangles: positions, normals, colours (0 to 1)."""
    edges = triangles[:, 1:] - triangles[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(areas, 1e-12)[:, None]
    chosen = rng.choice(len(areas), count, p=areas / areas.sum())
    shares = rng.dirichlet((1, 1, 1), count)
    points = np.einsum('ij,ijk->ik', shares, triangles[chosen])
    places = np.einsum('ij,ijk->ik', shares, coordinates[chosen])
    colours = np.empty((count, 3))
    for number, (plain, image) in enumerate(materials):
        mine = numbers[chosen] == number
        colours[mine] = plain
        if image is not None and mine.any():
            height, width = image.shape[:2]
            x = (places[mine, 0] % 1 * width).astype(int).clip(0, width - 1)
            y = ((1 - places[mine, 1] % 1) * height).astype(int).clip(0, height - 1)
            colours[mine] *= image[y, x] / 255
    return points, normals[chosen], colours


class Surface:
    """Points of a model standing on the origin, z up, in metres: `points`, `normals` (n x 3),
    `colours` (n x 3, BGR, 0 to 1); `spacing`, the usual distance of neighbours in metres; `voc_id`
    as of the model."""

    def __init__(self, points, normals, colours, spacing, voc_id):
        self.points, self.normals, self.colours = points, normals, colours
        self.spacing, self.voc_id = spacing, voc_id


def load_surface(model):
    """None when the file has no surface. The points are kept in a file beside the model."""
    kept = model.file.with_suffix('.npz')
    if not kept.exists():
        triangles, coordinates, numbers, materials = read_obj(model.file)
        triangles = triangles[:, :, (0, 2, 1)] * (1, -1, 1)  # .obj: y up
        low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
        scale = model.size / np.maximum(high - low, 1e-9)
        triangles = (triangles - [*(low + high)[:2] / 2, low[2]]) * scale
        area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0],
                                       triangles[:, 2] - triangles[:, 0]), axis=1).sum() / 2
        points, normals, colours = sample_surface(np.random.default_rng(0), triangles, coordinates,
                                                  numbers, materials, POINTS)
        unfinished = kept.with_suffix(f'.{os.getpid()}.npz')  # others may be reading
        np.savez(unfinished, points=points.astype(np.float32), normals=normals.astype(np.float16),
                 colours=(colours.clip(0, 1) * 255).astype(np.uint8),
                 spacing=np.sqrt(area / POINTS))
        os.replace(unfinished, kept)
    with np.load(kept) as stored:
        return Surface(stored['points'], stored['normals'].astype(np.float32),
                       stored['colours'].astype(np.float32) / 255, float(stored['spacing']),
                       model.voc_id)
