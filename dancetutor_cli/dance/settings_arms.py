"""The sections of `configs/motion.yaml` about arms and hands, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass

from dancetutor_cli.dance.units import Degrees, DegreesPerSecond, Metres, MetresPerSecond, PerSecond, Ratio, Seconds


@dataclass(frozen=True, slots=True)
class HandSettings:
    """How a hand comes down on a panel."""

    reach_down: Seconds
    press: Seconds
    pelvis: Metres
    bend: Degrees
    bend_aside: Degrees
    turn_from: Degrees
    turn_most: Degrees
    bend_time: Seconds
    lowest: Metres
    slap: MetresPerSecond
    follow_in: Seconds
    follow_out: Seconds
    slap_time: Seconds
    look_from: Metres
    held: Seconds


@dataclass(frozen=True, slots=True)
class ArmSettings:
    """Where free hands hang and how they swing."""

    swing: Ratio
    out: Metres
    upper_back: Degrees
    bent: Degrees
    bent_easy: Degrees
    down: Metres
    stream_bent: Degrees
    stream_back: Degrees
    forearm_most: Degrees
    forearm_easy: Degrees
    stream_out: Metres
    stream_wander: Metres
    stream_pump: Metres
    unlike: Ratio
    longest: Metres
    jump: Metres
    jump_up: Metres
    wander: Metres
    carried_bent: Degrees
    carried_upper: Degrees
    carried_out: Metres
    carried_easy: Ratio
    raised: Ratio
    raised_most: Metres
    cancel: Ratio
    cancel_lean: Ratio
    twist: Degrees
    lean: Degrees
    slowest: Seconds
    fastest: Seconds
    lowest: Metres
    lag: Metres
    bend_hang: Ratio
    effort: Seconds
    turn_time: Seconds
    turn_late: Degrees
    turn_easy: DegreesPerSecond
    turn_quick: DegreesPerSecond
    spin_easy: DegreesPerSecond
    spin_quick: DegreesPerSecond
    drawn_in: Metres
    drawn_back: Ratio
    quick: MetresPerSecond
    quicker: MetresPerSecond
    hold_back: Seconds
    held_back: Metres
    clear_aside: Metres
    clear_ahead: Metres
    aside_from: Degrees
    aside_full: Degrees
    aside_out: Metres
    hips_clear: Metres
    hips_half: Metres
    hips_high: Metres
    hips_ease: Metres
    legs_room: Metres
    wander_slow: Seconds
    wander_quick: Seconds
    wander_share: Ratio
    wander_behind: Ratio
    wander_quick_behind: Ratio
    askew: Metres
    swing_most: Metres
    swing_upper: Degrees
    swing_bent: Degrees
    beat_bent: Degrees
    back_most: Degrees
    bent_least: Degrees
    bent_most: Degrees
    elbow_out: Ratio
    bend_elbow_out: Ratio
    elbow_down: Ratio
    elbow_back: Ratio
    bend_from: Degrees
    bend_full: Degrees
    bend_out: Metres
    bend_ahead: Metres
    own_pad: Metres
    own_pad_ahead: Ratio


@dataclass(frozen=True, slots=True)
class FingerSettings:
    """How far fingers are bent."""

    rest: Degrees
    rest_middle: Degrees
    fist: Degrees
    fist_middle: Degrees
    bar: Degrees
    bar_middle: Degrees
    flat: Degrees
    flat_middle: Degrees
    wander: Degrees
    wander_time: Seconds
    behind: Ratio


@dataclass(frozen=True, slots=True)
class BarSettings:
    """The bar behind the dancer, and how she holds it."""

    height: Metres
    behind: Metres
    radius: Metres
    posts: Metres
    apart: Metres
    nearer: Metres
    phrase_least: Seconds
    phrase_most: Seconds
    one_slow: Ratio
    one_quick: Ratio
    quick: PerSecond
    turned: Degrees
    dip: Degrees
    forward: Metres
    soft: Metres
    lean_back: Degrees
    knees: Metres
    stream_crouch: Metres
    square: Ratio
    calmer: Ratio
    free_hand: Metres
    let_go: Metres
    reach_time: Seconds
    shortest: Seconds
    from_end: Metres
    elbows_in: Ratio
    lift: Metres
    leave: Seconds
    early: Seconds
    comfort: Degrees
    place_time: Seconds
    inward: Metres


@dataclass(frozen=True, slots=True)
class AcrossSettings:
    """Turns in which the far hand crosses over to the bar in front of the dancer."""

    turned: Degrees
    past: Degrees
    settle: Seconds
    shortest: Seconds
    often: Ratio
    both: Ratio
    ahead: Metres
    near: Metres
    facing: Degrees
    twist: Degrees
    lean: Degrees
    nearer: Metres
    ease: Seconds
    early: Seconds
    free_out: Metres
    free_back: Metres
