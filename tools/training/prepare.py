#!/usr/bin/python3
"""Unpacks archives of photographs, SOURCE.tar, into a working folder: WORK/images/SOURCE.

What a working folder holds is said in sources.py. Photographs may also be put there by hand."""

import argparse
import os
import sys
import tarfile
from pathlib import Path

sys.dont_write_bytecode = True

from sources import ARCHIVES  # noqa: E402

SUFFIXES = ('.webp', '.png')


def unpack(archive, folder):
    """All images of an archive, without its folders; those that are there are left as they are."""
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    with tarfile.open(archive) as tar:
        for member in tar:
            name = Path(member.name).name
            if not member.isfile() or not name.endswith(SUFFIXES):
                continue
            count += 1
            path = folder / name
            if path.exists():
                continue
            unfinished = folder / (name + '.part')
            unfinished.write_bytes(tar.extractfile(member).read())
            os.replace(unfinished, path)
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('archives', type=Path, help='folder with SOURCE.tar')
    parser.add_argument('work', type=Path, help='working folder to make or complete')
    args = parser.parse_args()
    archives = [args.archives / f'{source}.tar' for source in ARCHIVES]
    if not any(archive.exists() for archive in archives):
        sys.exit(f'prepare: {args.archives} has none of {", ".join(a.name for a in archives)}')
    for source, archive in zip(ARCHIVES, archives):
        if archive.exists():
            count = unpack(archive, args.work / 'images' / source)
            print(f'{source}: {count} files')


main()
