"""What the experiments have in common: running the command and remembering what it found, statistics, drawing."""
