"""Compute references for tests by NumPy alone, without any of the project's other code."""
