"""The sections of `configs/motion.yaml` about arms and hands, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class HandSettings:
    """How a hand comes down on a panel."""

    reach_down: float
    press: float
    pelvis: float
    bend: float
    bend_aside: float
    turn_from: float
    turn_most: float
    bend_time: float
    lowest: float
    slap: float
    follow_in: float
    follow_out: float
    slap_time: float
    look_from: float
    held: float


@dataclass(frozen=True, slots=True)
class ArmSettings:
    """Where free hands hang and how they swing."""

    swing: float
    out: float
    forward: float
    down: float
    stream_up: float
    stream_back: float
    stream_out: float
    stream_wander: float
    unlike: float
    loose: float
    loose_time: float
    step: float
    step_effort: float
    jump: float
    jump_up: float
    wander: float
    cancel: float
    twist: float
    lowest: float
    lag: float
    bend_hang: float
    effort: float
    turn_time: float
    turn_late: float
    turn_easy: float
    turn_quick: float
    drawn_in: float
    drawn_back: float
    quick: float
    quicker: float
    hold_back: float
    held_back: float
    clear_aside: float
    clear_ahead: float
    aside_from: float
    aside_full: float
    aside_out: float
    hips_clear: float
    hips_half: float
    hips_high: float
    hips_ease: float
    legs_room: float
    twist_slowest: float
    twist_fastest: float
    wander_slow: float
    wander_quick: float
    wander_share: float
    wander_behind: float
    wander_quick_behind: float
    askew: float
    swing_most: float
    swing_time: float
    swing_up: float
    elbow_out: float
    bend_elbow_out: float
    elbow_down: float
    elbow_back: float
    bend_from: float
    bend_full: float
    bend_out: float
    bend_ahead: float
    own_pad: float
    own_pad_ahead: float


@dataclass(frozen=True, slots=True)
class FingerSettings:
    """How far fingers are bent."""

    rest: float
    rest_middle: float
    fist: float
    fist_middle: float
    bar: float
    bar_middle: float
    flat: float
    flat_middle: float
    wander: float
    wander_time: float
    behind: float


@dataclass(frozen=True, slots=True)
class BarSettings:
    """The bar behind the dancer, and how she holds it."""

    height: float
    behind: float
    radius: float
    posts: float
    apart: float
    nearer: float
    phrase_least: float
    phrase_most: float
    one_slow: float
    one_quick: float
    quick: float
    turned: float
    dip: float
    forward: float
    soft: float
    lean_back: float
    knees: float
    stream_crouch: float
    square: float
    let_go: float
    reach_time: float
    shortest: float
    from_end: float
    elbows_in: float
    lift: float
    leave: float
    early: float
    comfort: float
    place_time: float
    inward: float


@dataclass(frozen=True, slots=True)
class AcrossSettings:
    """Turns in which the far hand crosses over before her to the bar."""

    turned: float
    past: float
    settle: float
    shortest: float
    often: float
    both: float
    ahead: float
    near: float
    facing: float
    twist: float
    lean: float
    nearer: float
    ease: float
    early: float
    free_out: float
    free_back: float
