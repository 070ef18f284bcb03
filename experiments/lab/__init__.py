"""Shared by the experiments: running the command, caching its results, statistics, drawing."""
