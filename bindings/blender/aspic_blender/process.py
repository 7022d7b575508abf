"""`aspic mesh` and `aspic run` in the background of Blender."""
import json
import os
import shutil
import signal
import subprocess
import threading

DONE, NOT_CONVERGED, INTERRUPTED = 0, 3, 130


class Run:
    """A running simulation. A thread reads its steps; the main thread polls.

    The commands of `preparation` are run first, until one fails.
    """

    def __init__(self, program, folder, arguments, preparation=()):
        self.folder = folder
        self.commands = [*preparation, ["run", *arguments, "--json"]]
        self.is_cancelled, self.lock = False, threading.Lock()
        self.step = 0
        self.next_preview = 0.0
        self.environment = dict(os.environ)
        self.program = found = shutil.which(program)
        if not found:
            raise FileNotFoundError(f"the program '{program}' is not found; set its path in the preferences of the "
                                    "add-on")
        path = os.path.dirname(os.path.abspath(found)) + os.pathsep + self.environment.get("PATH", "")
        self.environment["PATH"] = path
        self.log = os.path.join(folder, "log.txt")
        open(self.log, "w", encoding="utf-8").close()
        self.start_next()
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def start_next(self):
        with open(self.log, "a", encoding="utf-8") as log:
            self.process = subprocess.Popen([self.program, *self.commands.pop(0)], stdout=subprocess.PIPE, stderr=log,
                                            env=self.environment, start_new_session=True, text=True)

    def read(self):
        while True:
            for line in self.process.stdout:
                try:
                    self.step = json.loads(line)["step"]
                except (ValueError, KeyError, TypeError):
                    continue
            code = self.process.wait()
            with self.lock:
                if code != DONE or self.is_cancelled or not self.commands:
                    return
                self.start_next()

    def is_preparing(self):
        """Whether the simulation has not begun."""
        return bool(self.commands)

    def is_running(self):
        return self.thread.is_alive()

    def cancel(self):
        with self.lock:
            self.is_cancelled = True
            if self.process.poll() is None:
                self.process.send_signal(signal.SIGINT)

    def wait(self):
        self.thread.join()
        return INTERRUPTED if self.is_cancelled and self.commands else self.process.returncode

    def lines(self):
        """Messages of the program."""
        with open(self.log, encoding="utf-8", errors="replace") as file:
            return [line.strip() for line in file if line.strip()]

    def message(self):
        """The last errors, or lines."""
        lines = self.lines()
        errors = [line for line in lines if line.startswith(("error", "aspic:"))]
        return "\n".join((errors or lines)[-3:])
