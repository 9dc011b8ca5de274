#!/usr/bin/env python3
"""slurm_test.py STILLPOINT CLASS: `stillpoint ablate --executor slurm` with a real Slurm, which is set up for
the tests of CLASS. Exits with 77 where Slurm or munge is not installed."""
import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from cluster import LARGEST_ARRAY, Cluster, command, missing_programs

PROGRAM = sys.argv[1]
TIME_LIMIT = 150  # seconds, of everything

TWO_VARIANTS = """\
version: 1
sequences: [{name: short, dataset: recording}]
variants:
  - {name: few, pipeline: orb_baseline, set: [tracker.features=600]}
  - {name: many, pipeline: orb_baseline}
repeats: 3
mode: inline
baseline: few
slurm: {partition: main, time: "10", cpus: 1}
"""
# Between its frames lie minutes, for which the pace of the sensor waits.
ENDLESS = """\
version: 1
sequences: [{name: endless, dataset: endless}]
variants: [{name: plain, pipeline: orb_baseline, set: [runtime.pace=sensor]}]
slurm: {options: [--no-requeue]}
"""


def make_endless(recording, folder):
    shutil.copytree(recording, folder)
    (folder / "associations.txt").unlink()
    for name in ("rgb.txt", "depth.txt", "groundtruth.txt"):
        text = (folder / name).read_text()
        (folder / name).write_text(re.sub(r"(?m)^[\d.]+", lambda time: f"{1000 * float(time[0]):.3f}", text))


def processes_with(argument):
    """Numbers of those that were called with it."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if argument.encode() in (process / "cmdline").read_bytes().split(b"\0"):
                found.append(int(process.name))
        except OSError:  # it has ended
            pass
    return found


class Call:
    """One of `stillpoint ablate`."""

    def __init__(self, *arguments, **environment):
        self.process = subprocess.Popen(
            [PROGRAM, "ablate", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env=os.environ | environment)
        self.err = ""

    def read_until(self, text):
        """What stands behind it in its line."""
        for line in self.process.stderr:
            self.err += line
            if text in line:
                return line.split(text)[1].strip()
        raise AssertionError(f"no '{text}' in:\n{self.err}")

    def finish(self):
        out, err = self.process.communicate()
        self.err += err
        return self.process.returncode, out, self.err


class StudyInQueue(unittest.TestCase):
    """A cluster of its own, a short recording and an endless one."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.cluster = cls.enterClassContext(Cluster(cls.folder / "cluster"))
        recording = cls.folder / "recording"
        subprocess.run([PROGRAM, "simulate", "fr3_walking_xyz_empty", "--frames", "8", "-o", recording],
                       check=True, capture_output=True)
        make_endless(recording, cls.folder / "endless")

    def setUp(self):
        self.out = self.folder / self.id().split(".")[-1]

    def call(self, study, *more, out=None, **environment):
        file = self.folder / "study.yaml"
        file.write_text(study)
        return Call(file, "-o", out or self.out, *more, **environment)

    def follow(self, study, **environment):
        return self.call(study, "--executor", "slurm", **environment)

    def rows(self, out):
        with open(out / "results.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def queued(self):
        return command("squeue", "--noheader").stdout

    def wait_for_endless_run(self):
        """Its process."""
        run = str(self.out / "runs/endless/plain/0")
        return self.cluster.wait_for(lambda: processes_with(run))[0]

    def wrapped(self, name, script):
        """A search path on which this command of Slurm is a script of the shell; REAL is the command."""
        wrapper = self.folder / self.id() / name
        wrapper.parent.mkdir(exist_ok=True)
        wrapper.write_text("#!/bin/sh\n" + script.replace("REAL", f"'{shutil.which(name)}' \"$@\"") + "\n")
        wrapper.chmod(0o755)
        return f"{wrapper.parent}:{os.environ['PATH']}"


class SlurmLimits(StudyInQueue):
    """Of time and of memory."""

    def setUp(self):
        super().setUp()
        self.run_folder = self.out / "runs/endless/plain/0"

    def limited(self, limit, **environment):
        return self.follow(ENDLESS.replace("options:", limit + ", options:"), **environment)

    def expect_failure(self, call, exit_code, message):
        code, out, err = call.finish()
        self.assertEqual(code, 1, err)
        self.assertRegex(out, rf"\* endless/plain/0: exit code {exit_code}: {message}")
        row = self.rows(self.out)[0]
        self.assertEqual((row["state"], row["exit_code"]), ("failed", str(exit_code)))

    def test_a_run_that_takes_too_long_has_failed(self):
        """Slurm's shortest limit is a minute, so the end comes earlier; it looks every half minute."""
        call = self.limited('time: "1"')
        job = call.read_until("submitted as job ").split(":")[0]
        self.wait_for_endless_run()
        self.assertIn("TimeLimit=00:01:00", command("scontrol", "show", "job", job).stdout)
        self.assertEqual(command("scontrol", "update", f"JobId={job}", "EndTime=now+1").returncode, 0)
        self.expect_failure(call, 124, "left no result; Slurm says TIMEOUT")

    def test_a_run_that_needs_too_much_memory_has_failed_and_is_made_again(self):
        """Without cgroups, Slurm kills the whole job and calls it failed; its log says why."""
        self.expect_failure(self.limited("memory: 20M"), 1,
                            r"left no result; Slurm says \w+: .*exceeded memory limit")
        self.assertIn("exceeded memory limit", (self.run_folder / "slurm.txt").read_text())

        again = self.limited("memory: 1G")
        job = again.read_until("submitted as job ").split(":")[0]
        self.wait_for_endless_run()
        self.assertFalse((self.run_folder / "slurm.txt").exists())
        again.process.send_signal(signal.SIGINT)
        again.finish()
        command("scancel", job)
        self.cluster.wait_for(lambda: not self.queued())

    def test_a_run_that_the_kernel_kills_for_its_memory_says_so(self):
        """With cgroups, the largest process of the job is killed, and squeue says why."""
        path = self.wrapped("squeue", "REAL | sed 's/|COMPLETED|.*/|OUT_OF_MEMORY|OutOfMemory/'")
        call = self.limited("memory: 1G", PATH=path)
        call.read_until("submitted as job ")
        os.kill(self.wait_for_endless_run(), signal.SIGKILL)
        self.expect_failure(call, 137, "ended by a signal: Killed; Slurm says OUT_OF_MEMORY")


class Slurm(StudyInQueue):
    """The run may be ended just before its job, which still writes a result then."""

    def test_gives_what_runs_on_this_machine_give(self):
        code, out, err = self.follow(TWO_VARIANTS).finish()
        self.assertEqual(code, 0, err)
        self.assertIn("## Absolute trajectory error", out)
        self.assertRegex(err, rf"submitted as job \d+: {LARGEST_ARRAY} of 6 runs")
        self.assertRegex(err, rf"submitted as job \d+: {6 - LARGEST_ARRAY} of 6 runs")
        self.assertIn("[6/6] short/", err)
        self.assertFalse((self.out / "slurm").exists())

        local = self.folder / "local"
        self.assertEqual(self.call(TWO_VARIANTS, "-j", "2", out=local).finish()[0], 0)
        for file in local.glob("runs/*/*/*/*"):
            self.assertTrue((self.out / file.relative_to(local)).exists(), file)
            if file.name in ("trajectory.txt", "keyframes.txt", "pipeline.yaml"):
                self.assertEqual(file.read_bytes(), (self.out / file.relative_to(local)).read_bytes(), file)
        for ours, theirs in zip(self.rows(self.out), self.rows(local), strict=True):
            self.assertEqual(ours["state"], "done")
            for column in ("variant", "seed", "ate_m", "sim3_scale", "coverage_percent", "commit"):
                self.assertEqual(ours[column], theirs[column])

        code, _, err = self.follow(TWO_VARIANTS).finish()
        self.assertEqual((code, err), (0, "6 of 6 runs are there already\n"))

    def test_goes_on_without_the_one_who_follows(self):
        first = self.follow(ENDLESS)
        job = first.read_until("submitted as job ").split(":")[0]
        first.process.send_signal(signal.SIGINT)
        code, out, err = first.finish()
        self.assertEqual(code, -signal.SIGINT)
        self.assertIn(f"in Slurm's queue: job {job}; the same command follows it again, 'scancel {job}'", err)
        self.assertIn("**Not finished:** 1 of 1 runs", out)
        self.assertIn(job, self.queued())

        code, _, err = self.call(ENDLESS).finish()
        self.assertEqual(code, 2)
        self.assertIn(f"runs of this study are in Slurm's queue: job {job}", err)
        code, _, err = self.follow(ENDLESS.replace("sensor", "sensor, tracker.features=700")).finish()
        self.assertEqual(code, 2)
        self.assertIn(f"as it was before it changed: job {job}", err)

        second = self.follow(ENDLESS)
        self.assertEqual(second.read_until("in the queue already: "), f"1 of 1 runs, job {job}")
        command("scancel", job)
        code, _, err = second.finish()
        self.assertEqual(code, 1)
        self.assertRegex(err, r"endless/plain/0: .*; Slurm says CANCELLED")

    def test_goes_on_after_scancel(self):
        first = self.follow(ENDLESS)
        job = first.read_until("submitted as job ").split(":")[0]
        first.process.send_signal(signal.SIGINT)
        first.finish()
        command("scancel", job)
        self.cluster.wait_for(lambda: not self.queued())

        second = self.follow(ENDLESS)
        self.assertNotEqual(second.read_until("submitted as job ").split(":")[0], job)
        self.wait_for_endless_run()
        command("scontrol", "update", "NodeName=localhost", "State=DOWN", "Reason=test")
        code, out, err = second.finish()
        command("scontrol", "update", "NodeName=localhost", "State=RESUME")
        self.assertEqual(code, 1, err)
        self.assertRegex(out, r"\* endless/plain/0: exit code \d+: .*; Slurm says NODE_FAIL")
        self.assertEqual(self.rows(self.out)[0]["state"], "failed")
        self.cluster.wait_for(lambda: "idle" in command("sinfo", "--noheader").stdout)

    def test_a_run_that_fails_is_listed_with_what_it_said(self):
        study = TWO_VARIANTS.replace("recording", "damaged").replace("repeats: 3", "repeats: 1")
        shutil.copytree(self.folder / "recording", self.folder / "damaged")
        for name in ("depth.txt", "associations.txt"):
            (self.folder / "damaged" / name).unlink()
        code, _, err = self.follow(study).finish()
        self.assertEqual(code, 1)
        self.assertIn("short/few/0: FAILED (exit code 3): ", err)
        self.assertIn("error: 2 of 2 runs failed", err)

    def test_holds_no_more_in_the_queue_than_it_may(self):
        study = TWO_VARIANTS.replace("cpus: 1", "tasks: 2")
        code, _, err = self.follow(study).finish()
        self.assertEqual(code, 0, err)
        self.assertNotRegex(err, r"submitted as job \d+: [3-9]")
        self.assertEqual(len(self.rows(self.out)), 6)

    def test_waits_for_a_queue_that_is_full(self):
        """sbatch refuses while there are jobs, as a limit of the number of jobs of a user does."""
        path = self.wrapped("sbatch", "[ -z \"$(squeue --noheader)\" ] || { echo 'sbatch: error: full' >&2; exit 1; }\n"
                                      "exec REAL")
        code, _, err = self.follow(TWO_VARIANTS, PATH=path).finish()
        self.assertEqual(code, 0, err)
        self.assertIn("Slurm takes no more for now, 2 runs are submitted later: sbatch: full", err)
        self.assertIn("[6/6] short/", err)

    def test_says_why_slurm_takes_nothing(self):
        code, _, err = self.follow(TWO_VARIANTS.replace("main", "mian")).finish()
        self.assertEqual(code, 1)
        self.assertIn("error: sbatch: invalid partition specified: mian;", err)
        self.assertFalse(list(self.out.glob("slurm/*/")))

        code, _, err = self.follow(TWO_VARIANTS, PATH="/nowhere").finish()
        self.assertEqual(code, 2)
        self.assertIn("error: there is no command 'scontrol' of Slurm on this machine; run it where", err)


if __name__ == "__main__":
    if missing := missing_programs():
        print(f"skipped: needs the packages slurm-wlm and munge (no {', '.join(missing)}); tools/setup installs them")
        sys.exit(77)
    signal.signal(signal.SIGALRM, lambda *_: sys.exit("took too long"))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended by SIGTERM"))
    signal.alarm(TIME_LIMIT)
    unittest.main(argv=[sys.argv[0], sys.argv[2]], verbosity=2)
