#!/usr/bin/env python3
"""foreign_reader_test.py PROGRAM FOLDER: what Foxglove's readers find in the files of specification_test.py is what is
in them, and a recording that Foxglove's writer has written is run as the one it was made of. Skipped (exit code 77)
without npm or its registry."""
import json
import pathlib
import shutil
import subprocess
import sys

from read_mcap import Mcap

PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
HERE = pathlib.Path(__file__).parent / "foreign_reader"


def skip(reason):
    print("skipped:", reason)
    sys.exit(77)


def install():
    """Into the build folder, once for each list of packages."""
    reader = FOLDER / "foreign_reader"
    lock = HERE / "package-lock.json"
    done = reader / "node_modules/.package-lock.json"
    if not shutil.which("npm"):
        skip("npm is not installed")
    if not done.exists() or done.stat().st_mtime < lock.stat().st_mtime:
        shutil.copytree(HERE, reader, dirs_exist_ok=True)
        command = ["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", "--fetch-retries=0",
                   "--fetch-timeout=20000"]
        if subprocess.run(command, cwd=reader, capture_output=True).returncode != 0:
            skip("npm could not fetch the packages of " + str(lock))
    for script in HERE.glob("*.mjs"):
        shutil.copy(script, reader)
    return reader


def output_of(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} {command[1]} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def without_bytes(message):
    if isinstance(message, dict):
        return {("nsec" if key == "nanosec" else key): without_bytes(value) for key, value in message.items()}
    if isinstance(message, list):
        return [without_bytes(value) for value in message]
    return len(message) if isinstance(message, bytes) else message


def trajectory(dataset):
    out = FOLDER / "foreign_run"
    shutil.rmtree(out, ignore_errors=True)
    output_of(PROGRAM, "run", "orb_baseline", "--dataset", dataset, "-o", out, "--set", "runtime.mode=inline")
    return (out / "trajectory.txt").read_text()


scripts = install()
files = [FOLDER / name for name in ("run/zstd.mcap", "run/lz4.mcap", "run/none.mcap", "recording.mcap")]
for name, topics in json.loads(output_of("node", scripts / "read.mjs", *files)).items():
    file = Mcap(pathlib.Path(name).read_bytes())
    for topic, schema in file.channels.values():
        expected = file.messages[topic]
        got = topics.pop(topic)
        assert got["schema"] == schema.name, topic
        assert got["messages"] == len(expected), topic
        last = json.loads(json.dumps(got["last"]).replace('"nanosec"', '"nsec"'))
        assert last == without_bytes(expected[-1][1]), f"{topic}: {got['last']} != {expected[-1][1]}"
    assert not topics, topics
print("Foxglove's readers find the same")

chunks, plain = FOLDER / "foreign_chunks.mcap", FOLDER / "foreign_plain.mcap"
output_of("node", scripts / "rewrite.mjs", FOLDER / "recording.mcap", chunks, plain)
expected = trajectory(FOLDER / "recording.mcap")
assert len(expected.splitlines()) > 20, expected
for file in chunks, plain:
    assert trajectory(file) == expected, file
print("What Foxglove's writer has written gives the same trajectory")
