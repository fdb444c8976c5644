"""What a user's materials ask beyond closed opaque paint becomes geometry: cut-outs, second sides, vertex colours."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_edit import edited, joined, parts_of

from dancetutor_cli.character.characters import load_character
from dancetutor_cli.character.container import Container
from dancetutor_cli.character.gltf import read_character
from dancetutor_cli.character.materials import srgb_from_linear
from dancetutor_cli.character.mesh import Character, Material, Mesh, rest_vertices
from dancetutor_cli.character.surfaces import drawable, open_pieces
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import PACKAGE

SOURCE = PACKAGE / "character" / "data" / "mannequin.glb"
SQUARE = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)


def square(material: Material, side: float = 0.4, **more: Any) -> Mesh:
    """A square that faces +Z; its texture lies on it once, upright."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=np.float32)
    positions = np.column_stack([corners * side, np.zeros(4)]).astype(np.float32)
    uv = np.column_stack([corners[:, 0], 1 - corners[:, 1]]).astype(np.float32)
    joints = np.tile(np.array([0, 1, 0, 0], np.uint16), (4, 1))
    weights = np.column_stack([corners[:, 0], 1 - corners[:, 0], np.zeros((4, 2))]).astype(np.float32)
    normals = np.tile(np.array([0, 0, 1], np.float32), (4, 1))
    return Mesh("square", positions, normals, uv, SQUARE, joints, weights, material, **more)


def drawn(*meshes: Mesh) -> tuple[Mesh, ...]:
    skeleton = Skeleton(("HumanoidRoot", "vl5"), np.array([-1, 0], np.int32), np.zeros((2, 3)))
    character = Character("x", skeleton, meshes, np.tile(np.eye(4), (2, 1, 1)))
    return drawable(character, rest_vertices(character)).meshes


def area(mesh: Mesh) -> float:
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def disc() -> np.ndarray:
    """A red disc with a black transparent surround, as hair cards have."""
    y, x = np.mgrid[0:128, 0:128]
    texture = np.zeros((128, 128, 4), np.uint8)
    texture[(x - 63.5) ** 2 + (y - 63.5) ** 2 < 40**2] = (200, 20, 20, 255)
    return texture


def test_a_mask_is_cut_to_its_outline() -> None:
    (mesh,) = drawn(square(Material("card", (1, 1, 1, 1), disc(), cutoff=0.5)))
    radius = 40 / 128 * 0.4
    assert area(mesh) == pytest.approx(np.pi * radius**2, rel=0.02)
    corners = np.linalg.norm(mesh.positions[mesh.triangles][..., :2] - 0.2, axis=2)
    assert corners.max() < radius + 0.004
    np.testing.assert_allclose(mesh.weights.sum(axis=1), 1, atol=1e-6)
    share = (mesh.weights * (mesh.joints == 0)).sum(axis=1)
    np.testing.assert_allclose(share, mesh.positions[:, 0] / 0.4, atol=1e-5)  # weights follow the surface
    assert mesh.material.texture is not None and mesh.material.cutoff is None
    assert (mesh.material.texture[..., 0] > 190).all(), "no black shines in at the rim"


def test_what_is_solid_all_over_is_left_alone_and_what_is_not_there_goes() -> None:
    solid, glass = np.full((8, 8, 4), 255, np.uint8), np.full((8, 8, 4), 60, np.uint8)
    kept = square(Material("a", (1, 1, 1, 1), solid, cutoff=0.5))
    ignored = square(Material("b", (1, 1, 1, 1), glass))  # OPAQUE: alpha means nothing
    gone = square(Material("c", (1, 1, 1, 1), glass, cutoff=0.5))
    lens = square(Material("d", (1, 1, 1, 0.3), cutoff=0.5))
    meshes = drawn(kept, ignored, gone, lens)
    assert [len(m.triangles) for m in meshes] == [2, 2]
    assert [m.material.name for m in meshes] == ["a", "b"]


def test_a_texture_may_repeat() -> None:
    card = square(Material("card", (1, 1, 1, 1), disc(), cutoff=0.5))
    card.uv[:] = card.uv * 3 - 1.5
    (mesh,) = drawn(card)
    assert area(mesh) == pytest.approx(9 * np.pi * (40 / 128 * 0.4 / 3) ** 2, rel=0.05)


def test_meshes_that_share_a_texture_go_on_sharing() -> None:
    material = Material("card", (1, 1, 1, 1), disc(), cutoff=0.5)
    one, two = drawn(square(material), square(material))
    assert one.material.texture is two.material.texture


def test_cutting_noise_is_bounded() -> None:
    noise = np.full((512, 512, 4), 255, np.uint8)
    noise[..., 3] = np.random.default_rng(1).integers(0, 2, (512, 512)) * 255
    meshes = drawn(*[square(Material("n", (1, 1, 1, 1), noise, cutoff=0.5), side=2.0) for _ in range(5)])
    assert sum(len(m.triangles) for m in meshes) < 150_000


def test_an_open_surface_is_seen_from_both_sides() -> None:
    (mesh,) = drawn(square(Material("cape", (1, 1, 1, 1), double_sided=True)))
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    facing = np.cross(b - a, c - a)[:, 2] > 0
    assert facing.tolist() == [True, True, False, False]
    assert (mesh.normals[mesh.triangles[2:], 2] == -1).all()
    (single,) = drawn(square(Material("cape", (1, 1, 1, 1))))
    assert len(single.triangles) == 2


def test_closed_pieces_need_no_second_side() -> None:
    mannequin = read_character(SOURCE).meshes[1]
    card = square(Material("x", (1, 1, 1, 1)))
    places = np.concatenate([mannequin.positions, card.positions + 5])
    triangles = np.concatenate([mannequin.triangles, card.triangles + len(mannequin.positions)])
    piece = open_pieces(triangles, places)
    assert piece.sum() == 2 and piece[-2:].all()


def test_vertex_colours_become_paint() -> None:
    colors = np.array([[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 1]], dtype=np.float32)
    (mesh,) = drawn(square(Material("x", (1, 1, 1, 1)), colors=colors))
    texture = mesh.material.texture
    assert texture is not None
    for triangle, wanted in zip(mesh.triangles, colors[SQUARE].mean(axis=1), strict=True):
        for u, v in mesh.uv[triangle]:
            texel = texture[int(v * texture.shape[0]), int(u * texture.shape[1]), :3]
            np.testing.assert_allclose(texel / 255, srgb_from_linear(wanted.astype(float)), atol=0.003)
    grey = np.full((4, 3), 0.25, dtype=np.float32)
    (mesh,) = drawn(square(Material("x", (1, 0.5, 1, 1)), colors=grey))
    assert mesh.material.texture is None
    np.testing.assert_allclose(mesh.material.base_color[0], srgb_from_linear(np.array([0.25]))[0], atol=1e-6)


def container_of(accessor: dict[str, Any], binary: bytes, views: list[dict[str, Any]]) -> Container:
    document = {"accessors": [accessor], "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    return Container(Path("x.glb"), document, memoryview(binary))


def test_sparse_accessors_replace_the_rows_they_name() -> None:
    base = np.arange(12, dtype="<f4").reshape(4, 3)
    values = np.array([[9, 8, 7]], dtype="<f4")
    binary = base.tobytes() + struct.pack("<HH", 2, 0) + values.tobytes()
    views = [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in ((0, 48), (48, 2), (52, 12))]
    sparse = {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 2}}
    accessor = {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse}
    base[2] = values[0]
    np.testing.assert_array_equal(container_of({**accessor, "bufferView": 0}, binary, views).accessor(0), base)
    zeros = np.zeros((4, 3))
    zeros[2] = values[0]
    np.testing.assert_array_equal(container_of(accessor, binary, views).accessor(0), zeros)
    broken = container_of(accessor, binary[:48] + struct.pack("<HH", 4, 0) + binary[52:], views)
    with pytest.raises(FileError, match="past its rows"):
        broken.accessor(0)


def test_quantised_meshes(tmp_path: Path) -> None:
    """KHR_mesh_quantization: positions as 16-bit integers; the inverse bind matrices scale them back."""
    document, binary = parts_of(SOURCE.read_bytes())
    plain = read_character(SOURCE)
    step = 2.0 / 32767
    data = bytearray(binary)
    skin = document["accessors"][document["skins"][0]["inverseBindMatrices"]]
    start = document["bufferViews"][skin["bufferView"]]["byteOffset"]
    matrices = np.frombuffer(binary, "<f4", 16 * skin["count"], start).reshape(-1, 4, 4)
    scaled = (matrices * np.array([step, step, step, 1])[:, None]).astype("<f4")  # stored by columns
    data[start : start + scaled.nbytes] = scaled.tobytes()
    for mesh in document["meshes"]:
        accessor = document["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
        view = document["bufferViews"][accessor["bufferView"]]
        places = np.frombuffer(binary, "<f4", 3 * accessor["count"], view["byteOffset"]).reshape(-1, 3)
        whole = np.zeros((len(places), 4), "<i2")
        whole[:, :3] = np.rint(places / step)
        accessor.update(componentType=5122, bufferView=len(document["bufferViews"]))
        document["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(data), "byteLength": whole.nbytes, "byteStride": 8}
        )
        data += whole.tobytes()
    document["buffers"][0]["byteLength"] = len(data)
    document["extensionsRequired"] = ["KHR_mesh_quantization"]
    path = tmp_path / "q.glb"
    path.write_bytes(joined(document, bytes(data)))
    np.testing.assert_allclose(rest_vertices(read_character(path)), rest_vertices(plain), atol=step)
    assert load_character(str(path)).skeleton.names == load_character(str(edited_copy(tmp_path))).skeleton.names


def edited_copy(folder: Path) -> Path:
    return edited(SOURCE, folder / "plain.glb", lambda document: None)


def test_materials_of_the_file_are_kept(tmp_path: Path) -> None:
    """MASK, BLEND, two sides, a turned texture, the older specular workflow: as they stand in the file."""

    def change(document: dict[str, Any]) -> None:
        first = document["materials"][0]
        first["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
            "KHR_texture_transform": {"offset": [0.5, 0], "scale": [2, 1], "rotation": np.pi / 2}
        }
        first.update(alphaMode="MASK", alphaCutoff=0.25, doubleSided=True)
        second = document["materials"][1]
        del second["pbrMetallicRoughness"]
        older = {"diffuseFactor": [1, 0, 0, 0.5]}
        second.update(alphaMode="BLEND", extensions={"KHR_materials_pbrSpecularGlossiness": older})
        document["extensionsRequired"] = ["KHR_texture_transform", "KHR_materials_pbrSpecularGlossiness"]

    path = edited(SOURCE, tmp_path / "x.glb", change)
    plain, read = read_character(SOURCE).meshes, read_character(path).meshes
    assert (read[0].material.cutoff, read[0].material.double_sided) == (0.25, True)
    worn = [m.material for m in read if m.material.cutoff == 0.5]
    assert worn and worn[0].base_color == (1, 0, 0, 0.5) and not worn[0].double_sided
    u, v = plain[0].uv.T
    np.testing.assert_allclose(read[0].uv, np.column_stack([v + 0.5, -2 * u]), atol=1e-6)


@pytest.mark.parametrize("mode", [5, 6])
def test_strips_and_fans_are_triangles_that_face_one_way(tmp_path: Path, mode: int) -> None:
    indices = np.array([0, 1, 3, 2], "<u2") if mode == 5 else np.array([0, 1, 2, 3], "<u2")
    document, binary = parts_of(SOURCE.read_bytes())
    binary += bytes(-len(binary) % 4)
    corners = square(Material("x", (1, 1, 1, 1))).positions.astype("<f4")
    document["bufferViews"] += [
        {"buffer": 0, "byteOffset": len(binary), "byteLength": 48},
        {"buffer": 0, "byteOffset": len(binary) + 48, "byteLength": 8},
    ]
    views = len(document["bufferViews"])
    document["accessors"] += [
        {"bufferView": views - 2, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": views - 1, "componentType": 5123, "count": 4, "type": "SCALAR"},
    ]
    items = len(document["accessors"])
    document["meshes"].append(
        {"primitives": [{"attributes": {"POSITION": items - 2}, "indices": items - 1, "mode": mode}]}
    )
    document["nodes"].append({"mesh": len(document["meshes"]) - 1})
    document["nodes"][0]["children"].append(len(document["nodes"]) - 1)
    document["buffers"][0]["byteLength"] = len(binary) + 56
    path = tmp_path / "x.glb"
    path.write_bytes(joined(document, binary + corners.tobytes() + indices.tobytes()))
    mesh = read_character(path).meshes[-1]
    assert len(mesh.triangles) == 2 and area(mesh) == pytest.approx(0.16, rel=1e-5)
    np.testing.assert_allclose(mesh.normals, np.tile([0, 0, 1], (4, 1)), atol=1e-6)


def test_many_large_textures_are_reduced_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dancetutor_cli.character.materials.ALL_TEXELS", 128 * 128)
    texture = read_character(SOURCE).meshes[0].material.texture
    assert texture is not None and max(texture.shape) <= 128
