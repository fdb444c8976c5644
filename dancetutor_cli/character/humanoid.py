"""The search for the bones of a human among a file's nodes, by VRM's `humanoid` map or by name.

Names are compared by their words, without separators, capitals, name spaces and side: this covers the styles of
Mixamo, Unreal, Rigify, Blender, 3ds Max, VRoid, KayKit, CMU, H-Anim, MikuMikuDance and others. The result is checked
against the tree: a bone lies below the one it hangs on. Bone names are VRM's; source of the required 15: VRM 1.0
specification, humanoid.md.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.container import Container, Nodes
from dancetutor_cli.run.errors import FileError

# VRM bone: the joint of our rig, words its name may be made of
_MIDDLE = {
    "hips": ("HumanoidRoot", "hips hip pelvis"),
    "neck": ("vc4", "neck neck01 neck1 necklower lowerneck vc7 vc4"),
    "head": ("skullbase", "head skullbase"),
}
_SIDED = {
    "UpperLeg": ("hip", "upleg upperleg thigh legupper femur"),
    "LowerLeg": ("knee", "leg lowerleg calf shin leglower knee tibia"),
    "Foot": ("talocrural", "foot ankle talocrural"),
    "Toes": ("metatarsal", "toes toe toebase ball metatarsal midtarsal"),
    "Shoulder": ("sternoclavicular", "shoulder clavicle collar collarbone scapula sternoclavicular"),
    "UpperArm": ("shoulder", "arm upperarm uparm uarm armupper shldr humerus"),
    "LowerArm": ("elbow", "forearm lowerarm farm armlower elbow radius"),
    "Hand": ("radiocarpal", "hand wrist radiocarpal"),
    "Eye": ("eyeball_joint", "eye"),
}
_SPINE = re.compile(r"(spine|chest|upperchest|torso|abdomen|waist|upperbody)\w*")
_HELPERS = frozenset(
    {"ik", "fk", "ctrl", "control", "pole", "target", "roll", "twist", "end", "leaf", "nub", "slot", "handslot"}
    | {"mch", "org", "tip", "helper"}
)
_FILLERS = frozenset({"x", "m", "c", "stretch", "bend"})  # middle, and what bends of a bone with a twist
_PREFIX = re.compile(r"(mixamorig\d*|character\d+|(valvebiped)?bip\d+|ccbase|def|jbip|bone)(?=.)")
# of CMU's ASF files, where the side is one letter in front: lfemur
_ASF = frozenset({"femur", "tibia", "foot", "toes", "clavicle", "humerus", "radius", "wrist", "hand"})
# and of MakeHuman's and Daz's CMU conversions: rshoulder
_ASF |= {"collar", "shldr", "shoulder", "elbow", "forearm", "thigh", "hip", "knee", "shin", "ankle", "toe"}
_ASF |= {"uarm", "farm"}  # of OptiTrack's Motive: LUArm, LFArm
# of MikuMikuDance, whose standard bones have Japanese names; 左 and 右 come first
_MMD = {
    "センター": "center",
    "下半身": "lowerbody",
    "上半身": "upperbody",
    "上半身2": "upperbody2",
    "首": "neck",
    "頭": "head",
}
_MMD_SIDED = {"肩": "clavicle", "腕": "upperarm", "ひじ": "forearm", "手首": "hand", "足": "thigh", "ひざ": "shin"}
_MMD_SIDED |= {"足首": "foot", "つま先": "toe"}
_LIMBS = {"Leg": ("UpperLeg", "LowerLeg", "Foot", "Toes"), "Arm": ("Shoulder", "UpperArm", "LowerArm", "Hand")}
_OLD = {"talocrural": "ankle", "radiocarpal": "wrist", "metatarsal": "midtarsal"}  # H-Anim's names before version 2
_PAIRED = ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
SHARED = 0.8  # part of all names from which a word that they share says nothing
REQUIRED = ("hips", "spine", "head", *(side + bone for side in ("left", "right") for bone in _PAIRED))


@dataclass(frozen=True, slots=True)
class Humanoid:
    """bones : VRM bone name -> node index; trunk : nodes between hips and neck or head, from below."""

    bones: dict[str, int]
    trunk: tuple[int, ...]

    def joints(self) -> dict[int, str]:
        """Return node index -> joint of our rig. The trunk's last node moves as the rib cage (vt4) does."""
        out = {}
        for bone, node in self.bones.items():
            joint = joint_of_bone(bone)
            if joint:
                out[node] = joint
        spine = ("vl5", "vt10", "vt4")
        count = len(self.trunk)
        for i, node in enumerate(self.trunk):
            if node not in out:
                place = 2 if count == 1 else round(i * 2 / (count - 1))
                out.setdefault(node, spine[place])
        return _first_of_each(out, self.trunk)


def joint_of_bone(bone: str) -> str | None:
    """Return the rig's joint for a VRM bone; None for bones that the rig does not have, and for the spine."""
    if bone in _MIDDLE:
        return _MIDDLE[bone][0]
    for side, letter in (("left", "l"), ("right", "r")):
        if bone.startswith(side) and bone[len(side) :] in _SIDED:
            return f"{letter}_{_SIDED[bone[len(side) :]][0]}"
    return None


def _first_of_each(joints: dict[int, str], trunk: tuple[int, ...]) -> dict[int, str]:
    """Keep only the upper of two spine nodes with the same joint; the other node moves with its parent."""
    last = {joint: node for node, joint in joints.items() if node in trunk}
    return {node: joint for node, joint in joints.items() if node not in trunk or last[joint] == node}


def find_humanoid(container: Container, nodes: Nodes) -> Humanoid:
    """Find the bones of a character file.

    Raises FileError, one line, that lists every required bone which is missing or hangs in the wrong place.
    """
    items = container.items("nodes")
    order = [i for i in nodes.order if "mesh" not in items[i]]  # a mesh may be called "Arm.L" too
    bones = _from_vrm(container) or _from_hanim(nodes) or _from_names(nodes, order)
    return _checked(container.path, nodes, bones, "rename or re-parent these bones, or export it as VRM")


def humanoid_of(path: Path, names: Sequence[str], parents: NDArray[np.int32]) -> Humanoid:
    """Find the bones of a skeleton without a mesh, as in motion capture, with parents before children.

    Raises FileError, one line, that lists every required bone which is missing or hangs in the wrong place.
    """
    nodes = Nodes(tuple(names), parents, tuple(range(len(names))), np.zeros((0, 4, 4)))
    bones = _from_hanim(nodes) or _from_names(nodes, list(nodes.order))
    return _checked(path, nodes, bones, "rename or re-parent these joints")


def _checked(path: Path, nodes: Nodes, bones: dict[str, int], advice: str) -> Humanoid:
    """Return the humanoid of these bones. Raises FileError, with advice, for missing or misplaced bones."""
    trunk = _trunk(nodes, bones)
    if trunk:
        bones.setdefault("spine", trunk[0])
    missing = [bone for bone in REQUIRED if bone not in bones]
    wrong = _misplaced(nodes, bones)
    if missing or wrong:
        found = len(REQUIRED) - len(missing)
        parts = [f"no {', '.join(missing)}"] if missing else []
        raise FileError(
            path,
            f"is not a usable humanoid ({found} of {len(REQUIRED)} bones): {'; '.join([*parts, *wrong])}; {advice}",
        )
    return Humanoid(bones, trunk)


def _from_vrm(container: Container) -> dict[str, int]:
    """Return the bones of the map of VRM 1.0 or 0.x, if the file has one."""
    extensions = container.document.get("extensions", {})
    extensions = extensions if isinstance(extensions, dict) else {}
    out: dict[str, int] = {}
    for name in ("VRMC_vrm", "VRM"):
        humanoid = extensions.get(name, {})
        humanoid = humanoid.get("humanoid", {}) if isinstance(humanoid, dict) else {}
        bones = humanoid.get("humanBones", {}) if isinstance(humanoid, dict) else {}
        pairs: list[tuple[Any, Any]] = []
        if isinstance(bones, dict):
            pairs = list(bones.items())
        elif isinstance(bones, list):
            pairs = [(bone.get("bone"), bone) for bone in bones if isinstance(bone, dict)]
        for bone, value in pairs:
            if isinstance(bone, str) and isinstance(value, dict):
                out[bone] = container.integer(
                    value.get("node"), 0, len(container.items("nodes")) - 1, f"node of {bone}"
                )
        if out:
            break
    return out


def _from_hanim(nodes: Nodes) -> dict[str, int]:
    """Return the bones by H-Anim's names, which are ours: `l_shoulder` is the upper arm, elsewhere the collar bone."""
    place = {name: i for i, name in enumerate(nodes.names)}
    if not {"HumanoidRoot", "l_hip", "skullbase"} <= set(place):
        return {}
    names = {joint_of_bone(f"{side}{bone}"): f"{side}{bone}" for side in ("left", "right") for bone in _SIDED}
    names |= {joint: bone for bone, (joint, _) in _MIDDLE.items()}
    for joint, old in _OLD.items():
        for side in "lr":
            if f"{side}_{joint}" not in place and f"{side}_{old}" in place:
                place[f"{side}_{joint}"] = place[f"{side}_{old}"]
    return {bone: place[joint] for joint, bone in names.items() if joint in place}


def words_of(name: str) -> tuple[str, str]:
    """Return the side ("left", "right", "") and plain words of a bone: ("left", "upleg") for "mixamorig:LeftUpLeg"."""
    plain = unicodedata.normalize("NFKC", name)
    if plain in _MMD:
        return "", _MMD[plain]
    if plain[:1] in ("左", "右"):
        return "left" if plain[0] == "左" else "right", _MMD_SIDED.get(plain[1:], "")
    if plain[:-2] in _MMD_SIDED and plain[-2:] in (".L", ".R", "_L", "_R"):  # as Blender's mmd_tools have them
        return "left" if plain[-1] == "L" else "right", _MMD_SIDED[plain[:-2]]
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    tokens = [t for t in re.split(r"[^A-Za-z0-9]+", name) if t]
    tokens = [t.lower() for t in tokens]
    side = ""
    for token in list(tokens):
        found = {"l": "left", "left": "left", "r": "right", "right": "right"}.get(token)
        if found and not side:
            side = found
            tokens.remove(token)
    if _HELPERS & {re.sub(r"\d+$", "", t) for t in tokens}:
        return side, ""
    plain = _PREFIX.sub("", "".join(t for t in tokens if t not in _FILLERS), count=1)
    for word, found in (("left", "left"), ("right", "right")):
        if not side and plain.startswith(word) and len(plain) > len(word):
            side, plain = found, plain[len(word) :]
    if not side and plain[1:] in _ASF and plain[0] in "lr":
        side, plain = "left" if plain[0] == "l" else "right", plain[1:]
    return side, plain


def _from_names(nodes: Nodes, order: list[int]) -> dict[str, int]:
    """Return the bones among the nodes `order`, by the words of their names."""
    words = {i: words_of(name) for i, name in _without_shared(_unnumbered({i: nodes.names[i] for i in order})).items()}
    rigify = _rigify_spine(words)
    bones: dict[str, int] = dict(rigify)
    for i in order:
        side, plain = words[i]
        bare = re.sub(r"0*\d{1,3}$", "", plain) if re.search(r"\d$", plain) else plain
        table = _SIDED if side else _MIDDLE
        for bone, (_, names) in table.items():
            if plain in names.split() or (bare in names.split() and not _is_second(plain)):
                bones.setdefault(f"{side}{bone}" if side else bone, i)
                break
    _complete(nodes, words, bones)
    return bones


def _unnumbered(names: dict[int, str]) -> dict[int, str]:
    """Return the names without the number that some sites append to every one of them, as in `LeftArm_09`.

    It is such a number if most names end in one and hardly two in the same. A few names may have none: those of nodes
    that were added later.
    """
    numbers = [found.group(1) for name in names.values() if (found := re.search(r"_(\d+)$", name))]
    if len(numbers) < 0.8 * len(names) or len(set(numbers)) < 0.9 * len(numbers):
        return names
    return {i: re.sub(r"_\d+$", "", name) for i, name in names.items()}


def _without_shared(names: dict[int, str]) -> dict[int, str]:
    """Return the names without name spaces (`Sarah:`) and first and last words that most share (`B_`, `_JNT`)."""
    plain = {i: re.split(r"[:|]", name)[-1] or name for i, name in names.items()}
    for shared in (r"^[^\W_]+[\W_]+(?=.)", r"(?<=.)[\W_]+[^\W_]+$"):
        while True:
            ends = {i: found[0] for i, name in plain.items() if (found := re.search(shared, name))}
            most, count = Counter(ends.values()).most_common(1)[0] if ends else ("", 0)
            if count < max(5, SHARED * len(plain)):
                break
            plain = {i: re.sub(shared, "", name) if ends.get(i) == most else name for i, name in plain.items()}
    return plain


def _complete(nodes: Nodes, words: dict[int, tuple[str, str]], bones: dict[str, int]) -> None:
    """Correct bones by their place where a name has several meanings: a thigh called leg, an arm called shoulder."""
    knees = {side: i for i, (side, word) in reversed(words.items()) if word in ("knee", "shin", "calf")}
    for side in ("left", "right"):
        if f"{side}UpperLeg" not in bones and side in knees:
            bones[f"{side}LowerLeg"] = knees[side]
        for upper, lower in (("UpperLeg", "LowerLeg"), ("UpperArm", "LowerArm")):
            if f"{side}{upper}" in bones or f"{side}{lower}" not in bones:
                continue
            above = int(nodes.parents[bones[f"{side}{lower}"]])
            if above >= 0 and words.get(above, ("", ""))[0] == side:
                bones[f"{side}{upper}"] = above
        if bones.get(f"{side}Shoulder") == bones.get(f"{side}UpperArm", -1):
            del bones[f"{side}Shoulder"]
    _complete_tips(nodes, words, bones)
    tops = [bones[b] for b in ("leftUpperLeg", "rightUpperLeg", "head") if b in bones]
    if "hips" not in bones and len(tops) == 3:
        shared = [n for n in _above(nodes, tops[0]) if all(n in _above(nodes, top) for top in tops)]
        bones.update({"hips": shared[0]} if shared else {})


def _complete_tips(nodes: Nodes, words: dict[int, tuple[str, str]], bones: dict[str, int]) -> None:
    """Add hands, feet and a head that are tips of forearms, shanks and neck; the head may be a face or the neck."""
    faces = [i for i, word in words.items() if word == ("", "face")]
    if "head" not in bones and faces:
        bones["head"] = faces[0]
    tips = [(f"{side}{below}", f"{side}{bone}") for side in ("left", "right")
            for below, bone in (("LowerArm", "Hand"), ("LowerLeg", "Foot"))]  # fmt: skip
    for above, bone in (*tips, ("neck", "head")):
        if bone in bones or above not in bones:
            continue
        named = {f"{nodes.names[bones[above]]}{end}" for end in (" end", "_end")}
        found = [i for i in words if int(nodes.parents[i]) == bones[above] and nodes.names[i] in named]
        bones.update({bone: found[0]} if found else {})
    if "head" not in bones and "neck" in bones:
        bones["head"] = bones.pop("neck")


def _is_second(plain: str) -> bool:
    """Whether a bone has a number above 1, so that it is not the first of a chain."""
    number = re.search(r"(\d+)$", plain)
    return number is not None and int(number.group(1)) > 1


def _rigify_spine(words: dict[int, tuple[str, str]]) -> dict[str, int]:
    """Return the bones of a rig by Rigify, which calls everything from hips (spine) to head (spine.006) spine."""
    plain = {word: i for i, (_, word) in words.items()}
    if "spine" in plain and "spine006" in plain and not {"hips", "hip", "pelvis", "head"} & set(plain):
        return {"hips": plain["spine"], "neck": plain.get("spine004", plain["spine006"]), "head": plain["spine006"]}
    return {}


def _above(nodes: Nodes, node: int) -> list[int]:
    """Return the ancestors of a node, nearest first."""
    out = []
    node = int(nodes.parents[node])
    while node >= 0:
        out.append(node)
        node = int(nodes.parents[node])
    return out


def _trunk(nodes: Nodes, bones: dict[str, int]) -> tuple[int, ...]:
    if "hips" not in bones or "head" not in bones:
        return ()
    above = _above(nodes, bones["head"])
    if bones["hips"] not in above:
        return ()
    chain = above[: above.index(bones["hips"])]
    if bones.get("neck") in chain:
        chain = chain[chain.index(bones["neck"]) + 1 :]
    return tuple(
        reversed([n for n in chain if _SPINE.match(words_of(nodes.names[n])[1]) or n in bones.values()] or chain)
    )


def _misplaced(nodes: Nodes, bones: dict[str, int]) -> list[str]:
    """Return a line for each bone that is not below its required ancestor."""
    pairs = [("spine", "hips"), ("head", "spine")]
    for side in ("left", "right"):
        pairs += [(f"{side}UpperLeg", "hips"), (f"{side}UpperArm", "hips")]
        for limb in _LIMBS.values():
            pairs += [(f"{side}{b}", f"{side}{a}") for a, b in pairwise(limb)]
    out = []
    for bone, above in pairs:
        if bone in bones and above in bones and bones[above] not in _above(nodes, bones[bone]):
            below = f"{bone} {nodes.names[bones[bone]]!r}"
            out.append(f"{below} is not below {above} {nodes.names[bones[above]]!r}")
    return out
