"""Runs a command and writes what it cost to a file: launch.py FILE COMMAND...

In a process of its own, since the kernel begins a child's largest memory at the size of its parent, which must be small
then: this one has imported nothing large.
"""

import json
import os
import signal
import sys
import time

report, *command = sys.argv[1:]
signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the command's, which ends in its own way
begin = time.monotonic()
process = os.posix_spawn(command[0], command, os.environ, setsigdef=[signal.SIGINT])
_, status, usage = os.wait4(process, 0)
cost = {
    "exit_code": os.waitstatus_to_exitcode(status),
    "seconds": time.monotonic() - begin,
    "peak_mib": usage.ru_maxrss / 1024,  # Linux counts in KiB
}
with open(report, "w") as file:
    json.dump(cost, file)
