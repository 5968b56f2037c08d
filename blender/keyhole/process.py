"""The program as a child process."""

import re
import signal
import subprocess
import threading
import time

PERCENT = re.compile(r"^([^:]+):\s+(\d+) %")
ERROR, WARNING = "keyhole: ", "keyhole: warning: "
SECONDS_TO_STOP = 0.8  # keyhole writes what there is when it is interrupted; what takes longer is lost


class Run:
    """A command that tells its progress on stderr, line by line."""

    def __init__(self, command):
        self.lines = []
        self.interrupted = None  # when
        self.child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True)
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.child.stderr:
            self.lines.append(line.strip())

    def running(self):
        return self.child.poll() is None

    def progress(self):
        """The share of the stage under way, from 0 to 1, if the last line has one, and that line."""
        last = self.lines[-1] if self.lines else ""
        found = PERCENT.match(last)
        return (int(found.group(2)) / 100 if found else None), last

    def cancel(self):
        """Asks the program to stop; to be called again until it has. It is killed if it takes too long."""
        if self.interrupted is None:
            self.interrupted = time.monotonic()
            self.child.send_signal(signal.SIGINT)
        elif time.monotonic() - self.interrupted > SECONDS_TO_STOP:
            self.child.kill()

    def finish(self):
        """Waits for the end. Returns the exit code; `lines` are complete then."""
        code = self.child.wait()
        self.reader.join()
        return code

    def warnings(self):
        return [line[len(WARNING):] for line in self.lines if line.startswith(WARNING)]

    def errors(self):
        return [line[len(ERROR):] for line in self.lines if line.startswith(ERROR) and not line.startswith(WARNING)]
