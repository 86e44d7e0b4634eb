"""Random fields and cameras, each from a number."""

import numpy as np

import progiso
from helpers.images import blobs, make_image, noise
from helpers.scenes import CACHED, Scene
from progiso.oracle.caster import Camera

SIZE = (96, 64)


def random_field(kind, shape, seed):
    """Return samples [z, y, x] that rate 32 keeps without loss: multiples of 2^-10."""
    values = (
        noise(shape, seed)
        if kind == "noise"
        else blobs(shape, seed, waves=2 if kind == "smooth" else 5)
    )
    return (np.round(values * 2**10) / 2**10).astype(np.float32)


def random_camera(shape, seed):
    """Return a camera about an image of this shape, in it, or parallel.

    The image is at the origin; every other camera looks along an axis.
    """
    rng = np.random.default_rng(seed)
    size = np.array(shape[::-1]) - 1.0
    target = rng.uniform(0.2, 0.8, 3) * size
    direction = (
        rng.normal(size=3)
        if rng.integers(2)
        else rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(3)]
    )
    direction /= np.linalg.norm(direction)
    up = np.roll(direction, 1) + 0.1 * rng.normal(size=3)
    kind = rng.integers(4)
    if kind == 0:
        return Camera(tuple(target), tuple(target + direction), tuple(up), rng.uniform(20, 110))
    position = tuple(target + rng.uniform(1, 2.5) * np.linalg.norm(size) * direction)
    scale = rng.uniform(0.2, 0.7) * np.linalg.norm(size) if kind == 1 else None
    return Camera(position, tuple(target), tuple(up), rng.uniform(20, 60), scale)


def pictures_of_every_kind():
    """Return depths and colours of some scenes, as bytes."""
    content = b""
    for seed, kind in enumerate(("noise", "smooth", "waves")):
        image = progiso.compress(make_image(random_field(kind, (20, 22, 18), seed)), rate=8)
        for settings in (
            {},
            CACHED,
            {"SpeculationLimit": 3, "MaximumPassesPerRender": 2, **CACHED},
        ):
            scene = Scene(image, 0.1, random_camera((20, 22, 18), seed), SIZE, lit=True, **settings)
            content += scene.depth().tobytes() + scene.picture().tobytes()
    return content
