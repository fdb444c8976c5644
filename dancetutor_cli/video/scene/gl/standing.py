"""The standing part of the picture as textures. Drawn by cpu/standing.py, once a camera, so that it cannot differ.

Import only after `compat.load_pyrender`.
"""

from __future__ import annotations

import numpy as np
from OpenGL import GL

from dancetutor_cli.video.scene.camera import Camera
from dancetutor_cli.video.scene.cpu.standing import draw_background
from dancetutor_cli.video.scene.gl.framebuffers import Target, refill, texture
from dancetutor_cli.video.scene.gl.patches import has_ground
from dancetutor_cli.video.scene.scene import Scene


class Standing:
    """What `cpu.standing.Background` holds, for the shader ground.frag; `target` has the picture to copy.

    tiles : what squares of it hold, for `patches`; has_ground : bool (t, u), which of them hold any
    """

    def __init__(self, scene: Scene, camera: Camera, size: tuple[int, int], samples: int) -> None:
        drawn = draw_background(scene.stage, scene.look, camera, size, samples)
        height, width = drawn.takes.shape
        self.left = drawn.left
        self.has_ground = has_ground(drawn.tiles)
        self.tiles = drawn.tiles._replace(
            low=np.where(self.has_ground[..., None], drawn.tiles.low, 0.0),
            high=np.where(self.has_ground[..., None], drawn.tiles.high, 0.0),
        )
        self.target = Target((width, height))
        opaque = np.full((height, width, 1), 255, np.uint8)
        refill(self.target.texture, np.dstack([drawn.picture, opaque]))
        self.colour = texture(np.dstack([drawn.colour / np.float32(255.0), drawn.takes]))
        self.ground = texture(np.dstack([drawn.ground, drawn.footprint]))
        info = (drawn.panel.astype(np.float32), drawn.glow, drawn.white, np.zeros_like(drawn.glow))
        self.panels = texture(np.dstack(info))

    def delete(self) -> None:
        """Give its memory back."""
        self.target.delete()
        GL.glDeleteTextures([self.colour, self.ground, self.panels])
