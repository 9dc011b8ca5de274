"""Processes that all end with the test, whatever happens."""
import ctypes
import os
import signal
import subprocess


class Processes:
    """Each in a group of its own, with its output in FOLDER/NAME.log."""

    def __init__(self, folder, environment):
        self.folder = folder
        self.environment = {**os.environ, **environment}
        self.running = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for name in reversed(list(self.running)):
            self.stop(name)

    def start(self, name, *command):
        with open(self.folder / f"{name}.log", "ab") as log:
            self.running[name] = subprocess.Popen(
                [str(word) for word in command], env=self.environment, stdin=subprocess.DEVNULL,
                stdout=log, stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=end_with_parent)

    def wait(self, name, seconds):
        """The exit code of a process that ends by itself."""
        code = self.running[name].wait(seconds)
        del self.running[name]
        return code

    def stop(self, name, seconds=10):
        """The exit code after Ctrl-C; None: the process had to be killed."""
        process = self.running.pop(name)
        signal_group(process, signal.SIGINT)
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None
        finally:
            signal_group(process, signal.SIGKILL)
            process.wait()

    def kill(self, name):
        process = self.running.pop(name)
        signal_group(process, signal.SIGKILL)
        process.wait()

    def log(self, name):
        return (self.folder / f"{name}.log").read_text(errors="replace")


def end_with_parent():
    """For a test that is killed and cannot stop what it has started."""
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of prctl(2)
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGTERM)


def signal_group(process, number):
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        pass  # it has ended
