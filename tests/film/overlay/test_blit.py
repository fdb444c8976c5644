"""Sprites on a frame against the formula that `_blit` is a quick way of: all in whole numbers, so to the bit."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.film.overlay.blit import Ink, draw_sprite


def _slow(frame, sprite, x, y, fraction, opacity, gain):
    """One pixel after the other; places and numbers as the kernel has them."""
    out = frame.astype(np.int64)
    rows, columns = sprite.shape[:2]
    padded = np.zeros((rows + 2, columns, 4), np.int64)
    padded[1:-1] = sprite
    for r in range(rows + 1):
        mixed = padded[r + 1] * (256 - fraction) + padded[r] * fraction
        for c in range(columns):
            if not (0 <= y + r < out.shape[0] and 0 <= x + c < out.shape[1]) or mixed[c, 3] == 0:
                continue
            keep = 255 * 65536 - mixed[c, 3] * opacity
            colour = mixed[c, :3] * opacity * gain // 256
            value = (out[y + r, x + c] * keep + colour * 255 + 255 * 32768) // (255 * 65536)
            out[y + r, x + c] = np.minimum(255, value)
    return out.astype(np.uint8)


@pytest.mark.parametrize("at", [(5, 7), (-3, -4), (25, 13)])
@pytest.mark.parametrize("fraction", [0, 77])
@pytest.mark.parametrize(("opacity", "gain"), [(1.0, 1.0), (0.75, 1.0), (1.0, 1.25)])
def test_sprites_are_blended_as_the_formula_says(at, fraction, opacity, gain):
    rng = np.random.default_rng(3)
    frame = rng.integers(0, 256, (20, 30, 3), dtype=np.uint8)
    alpha = np.clip(rng.integers(-120, 400, (9, 11, 1)), 0, 255)  # much of it clear or opaque
    sprite = np.concatenate([rng.integers(0, 256, (9, 11, 3)) * alpha // 255, alpha], axis=2).astype(np.uint8)
    sprite[2:6, 2:6, 3], sprite[6:8, :, 3] = 255, 0
    sprite[6:8] = 0
    expected = _slow(frame, sprite, *at, fraction, round(256 * opacity), round(256 * gain))
    draw_sprite(frame, sprite, at[0], at[1] + fraction / 256, Ink(opacity, gain))
    np.testing.assert_array_equal(frame, expected)
