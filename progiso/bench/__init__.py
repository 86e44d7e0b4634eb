"""Benchmark time, memory and error of images, beside what users would pick instead.

``python -m progiso bench SET`` measures and writes ``results.json``, ``results.md`` and plots;
``python -m progiso bench report`` makes the last two of the first. What is measured is said in the
module that measures it: `protocol` (the paper's evaluation), `peers` (side by side), `latency`
(first images and small moves), `errors` (depth error against run time), `scaling`, `budget`,
`interactive` (frames of a fly-through) and `first_image` (from opening a file, in a new process).
Every time is wall clock from the call of ``Render()`` to the end of the GPU's work.
"""
