"""Audit of shadings and bakes against path tracing: scenes, runs, measures and the page."""
