"""What may be asked of a picture, the same for options, layouts and renderers; light, for quick help texts."""

from typing import Literal

LEAST_SIDE = 64  # pixels
MOST_SIDE = 7680

Quality = Literal["draft", "good", "best"]
QUALITIES: tuple[Quality, ...] = ("draft", "good", "best")
RendererKind = Literal["auto", "cpu", "gl"]
RENDERERS: tuple[RendererKind, ...] = ("auto", "cpu", "gl")
