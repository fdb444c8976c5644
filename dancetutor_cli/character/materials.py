"""A glTF file's materials, as far as both renderers can draw them: base colour, its texture, cut-outs, two sides."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.container import Container, as_dict
from dancetutor_cli.character.mesh import Material

MAX_SIDE = 2048  # texels; at 1080p a dancer is half as high
ALL_TEXELS = 16 * 1024 * 1024  # of a character's textures; larger ones are halved until they fit
PLAIN = Material("plain", (0.8, 0.8, 0.8, 1.0))
Attribute = Callable[[str, int], NDArray[Any] | None]  # name, width -> values (v, width), None where there are none


class Materials:
    """The materials of one file; each image is decoded once, and only if a mesh wears it."""

    def __init__(self, container: Container) -> None:
        self.container = container
        self.images: dict[int, NDArray[np.uint8]] = {}
        self._side = 0

    def read(self, primitive: dict[str, Any], attribute: Attribute, count: int) -> tuple[Material, NDArray[np.float32]]:
        """Return the material of a primitive of `count` vertices and their places (v, 2) in its texture."""
        uv = np.zeros((count, 2), dtype=np.float32)
        if "material" not in primitive:
            return PLAIN, uv
        item = self.container.item("materials", primitive["material"])
        factor, texture_info = self._base(item)
        cutoff = self._cutoff(item)
        factor[:3] = srgb_from_linear(np.clip(factor[:3], 0, 1))
        r, g, b, a = (round(float(x), 6) for x in np.clip(factor, 0, 1))
        texture, image = None, self._image_of(texture_info)
        if image is not None:
            transform = as_dict(as_dict(texture_info.get("extensions")).get("KHR_texture_transform"))
            number = transform.get("texCoord", texture_info.get("texCoord", 0))
            places = attribute(f"TEXCOORD_{number}", 2)
            texture = self._pixels(image)
            if places is not None:
                uv = self._transformed(places, transform)
        name = str(item.get("name", "material"))[:200]
        color = (r, g, b, 1.0 if cutoff is None else a)
        is_double_sided = item.get("doubleSided") is True
        return Material(name, color, texture=texture, cutoff=cutoff, double_sided=is_double_sided), uv

    def _base(self, item: dict[str, Any]) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Return the linear base colour (4,) and the texture info, of the metallic or the older specular workflow."""
        pbr = as_dict(item.get("pbrMetallicRoughness"))
        names = ("baseColorFactor", "baseColorTexture")
        older = as_dict(item.get("extensions")).get("KHR_materials_pbrSpecularGlossiness")
        if isinstance(older, dict) and not set(names) & set(pbr):
            pbr, names = older, ("diffuseFactor", "diffuseTexture")
        factor = self.container.numbers(pbr.get(names[0], [1, 1, 1, 1]), 4, "a material's colour")
        return factor, as_dict(pbr.get(names[1]))

    def _cutoff(self, item: dict[str, Any]) -> float | None:
        """Return the alpha below which nothing is drawn, one half for what blends; None if alpha is ignored."""
        mode = item.get("alphaMode", "OPAQUE")
        if mode == "MASK":
            return float(self.container.numbers([item.get("alphaCutoff", 0.5)], 1, "an alphaCutoff")[0])
        return 0.5 if mode == "BLEND" else None

    def _image_of(self, info: dict[str, Any]) -> int | None:
        """Return the index of the image of a texture info; None without one."""
        if "index" not in info:
            return None
        item = self.container.item("textures", info["index"])
        extensions = as_dict(item.get("extensions"))
        source = item.get("source", as_dict(extensions.get("EXT_texture_webp")).get("source"))
        if source is None:
            if "KHR_texture_basisu" in extensions:
                raise self.container.fail("has KTX2 textures, not supported here; export it with PNG or JPEG")
            return None
        return self.container.integer(source, 0, len(self.container.items("images")) - 1, "image of a texture")

    def _pixels(self, image: int) -> NDArray[np.uint8]:
        if image not in self.images:
            self._side = self._side or self._longest_side()
            self.images[image] = self.container.image(image, self._side)
        return self.images[image]

    def _longest_side(self) -> int:
        """Return the most pixels of a side to which textures are reduced: together they have at most `ALL_TEXELS`."""
        worn = {self._image_of(self._base(item)[1]) for item in self.container.items("materials")}
        sizes = [self.container.image_size(index) for index in sorted(worn - {None}, key=str)]
        side = MAX_SIDE
        while side > 64 and sum(min(w, side) * min(h, side) for w, h in sizes) > ALL_TEXELS:
            side //= 2
        return side

    def _transformed(self, uv: NDArray[Any], transform: dict[str, Any]) -> NDArray[np.float32]:
        """Apply KHR_texture_transform: scale, rotation, offset."""
        scale = self.container.numbers(transform.get("scale", [1, 1]), 2, "a texture's scale")
        offset = self.container.numbers(transform.get("offset", [0, 0]), 2, "a texture's offset")
        a = float(self.container.numbers([transform.get("rotation", 0)], 1, "a texture's rotation")[0])
        turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
        return np.asarray((uv * scale) @ turn.T + offset, dtype=np.float32)


def srgb_from_linear(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB 0..1 for linear light 0..1 (IEC 61966-2-1)."""
    return np.asarray(np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055))


def linear_from_srgb(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear light 0..1 for sRGB 0..1 (IEC 61966-2-1)."""
    return np.asarray(np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4))
