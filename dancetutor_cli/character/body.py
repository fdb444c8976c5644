"""The body that a ragdoll gets of a character: the rig's joints in the character's own proportions."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.rig.skeleton import Skeleton, dancer_skeleton

_TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase")


def body_of(skeleton: Skeleton) -> Skeleton:
    """The dancer's joints, resting where those of a fitted character rest; what it lacks lies in proportion.

    skeleton : of a character of `character.load_character`; the project's own dancers come back as they are
    """
    ours = dancer_skeleton()
    if skeleton.names == ours.names and np.allclose(skeleton.offsets, ours.offsets, atol=1e-9):
        return ours
    own, rest = dict(zip(skeleton.names, skeleton.rest, strict=True)), ours.rest.copy()
    place = {name: rest[k] for k, name in enumerate(ours.names)}
    tall = own["skullbase"][1] / place["skullbase"][1]
    out: dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    known = [name for name in _TRUNK if name in own]
    for k, name in enumerate(ours.names):
        above = ours.names[ours.parents[k]] if ours.parents[k] >= 0 else None
        if name in own:
            out[name] = own[name]
        elif name in _TRUNK:
            index = _TRUNK.index(name)
            low = max((n for n in known if _TRUNK.index(n) < index), key=_TRUNK.index)
            high = min((n for n in known if _TRUNK.index(n) > index), key=_TRUNK.index)
            share = (place[name][1] - place[low][1]) / (place[high][1] - place[low][1])
            out[name] = own[low] + share * (own[high] - own[low])
        elif name.endswith("_sternoclavicular"):
            shoulder, chest = own[f"{name[0]}_shoulder"], out["vt4"]
            out[name] = np.array([0.14 * shoulder[0], shoulder[1] + 0.05 * (shoulder[1] - chest[1]), shoulder[2]])
        else:  # toes, face, braid
            assert above is not None
            out[name] = out[above] + tall * (place[name] - place[above])
            if name.endswith("_metatarsal"):
                out[name][1] = min(0.33 * out[above][1], out[name][1])
    new = np.array([out[name] for name in ours.names])
    offsets = new.copy()
    offsets[1:] -= new[ours.parents[1:]]
    return Skeleton(ours.names, ours.parents, offsets)
