"""`aspic run` in the background of Blender."""
import json
import os
import shutil
import signal
import subprocess
import threading

DONE, NOT_CONVERGED, INTERRUPTED = 0, 3, 130


class Run:
    """A running simulation. A thread reads its steps; the main thread polls."""

    def __init__(self, program, folder, arguments):
        self.folder = folder
        self.step = 0
        self.next_preview = 0.0
        environment = dict(os.environ)
        found = shutil.which(program)
        if not found:
            raise FileNotFoundError(f"the program '{program}' is not found; set its path in the preferences of the "
                                    "add-on")
        environment["PATH"] = os.path.dirname(os.path.abspath(found)) + os.pathsep + environment.get("PATH", "")
        self.log = os.path.join(folder, "log.txt")
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen([found, "run", *arguments, "--json"], stdout=subprocess.PIPE, stderr=log,
                                            env=environment, start_new_session=True, text=True)
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        for line in self.process.stdout:
            try:
                self.step = json.loads(line)["step"]
            except (ValueError, KeyError):
                continue

    def is_running(self):
        return self.process.poll() is None

    def cancel(self):
        if self.is_running():
            self.process.send_signal(signal.SIGINT)

    def wait(self):
        self.process.wait()
        self.thread.join()
        return self.process.returncode

    def lines(self):
        """Messages of the program."""
        with open(self.log, encoding="utf-8", errors="replace") as file:
            return [line.strip() for line in file if line.strip()]

    def message(self):
        """The last errors, or lines."""
        lines = self.lines()
        errors = [line for line in lines if line.startswith(("error", "aspic:"))]
        return "\n".join((errors or lines)[-3:])
