"""Runs a command and writes its cost to a file: launch.py FILE COMMAND...

This is a separate process that imports no large module, because the kernel initialises a child's peak memory with the
size of its parent.
"""

import json
import os
import signal
import sys
import time

report, *command = sys.argv[1:]
signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is left to the command
begin = time.monotonic()
process = os.posix_spawn(command[0], command, os.environ, setsigdef=[signal.SIGINT])
_, status, usage = os.wait4(process, 0)
cost = {
    "exit_code": os.waitstatus_to_exitcode(status),
    "seconds": time.monotonic() - begin,
    "processor_seconds": usage.ru_utime + usage.ru_stime,
    "peak_mib": usage.ru_maxrss / 1024,  # Linux counts in KiB
}
with open(report, "w") as file:
    json.dump(cost, file)
