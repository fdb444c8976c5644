"""The sections of `configs/motion.yaml` about the body, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass

from dancetutor_cli.dance.units import (
    Degrees,
    DegreesPerSecond,
    Duration,
    Metres,
    MetresPerSecondSquared,
    PerSecond,
    Ratio,
    Seconds,
)


@dataclass(frozen=True, slots=True)
class BodySettings:
    """How the body rides on the feet."""

    leg: Metres
    stream_crouch: Metres
    soft_reach: Metres
    reach: Metres
    turn_to_feet: Ratio
    step_rise: Ratio
    rise_late: Seconds
    lean: Degrees
    stream_lean: Degrees
    smooth: Seconds
    foot_weight: Ratio
    middle_weight: Ratio
    middle_weight_fast: Ratio
    height_smooth: Seconds
    height_calm: Seconds
    least_force: Ratio
    most_force: Ratio
    lean_time: Seconds
    pelvis_lean: Ratio
    list: Degrees
    list_stream: Degrees
    list_time: Seconds
    list_early: Seconds
    pelvis_bend: Ratio
    deep_bend: Degrees
    stream_time: Seconds
    commit_time: Seconds
    commit: Ratio
    land_give: Metres
    land_time: Seconds
    land_least: Seconds
    land_full: Seconds
    farthest: Metres
    farther: Metres
    farther_full: Seconds
    heel_carries: Degrees


@dataclass(frozen=True, slots=True)
class KneeSettings:
    """Where knees point."""

    to_toes: Ratio
    out: Degrees
    most: Degrees
    straddle: Degrees
    straddle_most: Degrees
    straddle_out: Degrees
    give: Degrees
    room: Metres


@dataclass(frozen=True, slots=True)
class LookSettings:
    """Where she looks and how far each part may turn."""

    torso_limit: Degrees
    head_limit: Degrees
    head_rate: DegreesPerSecond
    eyes_limit: Degrees
    eyes_give_up: Degrees
    away_from: Degrees
    away_to: Degrees
    head_leads: Seconds
    head_lead: Degrees
    torso_weight: Ratio
    head_weight: Ratio
    eyes_weight: Ratio
    distance: Metres
    height: Metres
    wrung: Degrees
    neck_share: Ratio
    neck_easy: Degrees
    neck_room: Degrees
    head_tilt: Ratio
    bent_tilt: Ratio
    bent_yaw: Ratio
    bent_from: Degrees
    bent_to: Degrees
    chin: Degrees


@dataclass(frozen=True, slots=True)
class GlanceSettings:
    """Glances away from the screen where there is time, and how the head is carried."""

    every: Seconds
    lasts: Seconds
    yaw: Degrees
    pitch: Degrees
    tilt: Degrees
    turn: Seconds
    eyes: Degrees
    eyes_ahead: Seconds
    quick: Seconds
    slow: Seconds
    around: Seconds
    hand: Seconds
    jump: Seconds
    neck_room: Degrees
    eyes_room: Degrees
    carried_yaw: Degrees
    carried_pitch: Degrees
    carried_tilt: Degrees


@dataclass(frozen=True, slots=True)
class InertiaSettings:
    """How chest and hands overshoot."""

    chest_frequency: PerSecond
    chest_damping: Ratio
    hand_frequency: PerSecond
    hand_damping: Ratio
    pelvis_turn: Seconds
    chest_turn: Seconds
    head_turn: Seconds


@dataclass(frozen=True, slots=True)
class LayerSettings:
    """Small movements on top."""

    breath_time: Seconds
    breath_shoulders: Degrees
    breath_nod: Degrees
    breath_deep: Ratio
    head_bob: Degrees
    sway: Metres
    sway_time: Seconds
    bounce: Metres
    beat_late: Seconds
    beat_nod: Degrees
    wrists: Degrees
    blink_time: Seconds
    beat_shortest: Seconds
    beat_longest: Seconds
    beat_width: Seconds
    beat_fade: Ratio
    wrist_time: Seconds
    wrist_wave: Ratio
    wrist_unlike: Ratio
    wrist_behind: Ratio
    sway_quick: Ratio
    sway_quick_time: Ratio
    blink: Seconds
    laugh_after: Seconds
    laugh_rise: Seconds


@dataclass(frozen=True, slots=True)
class FaceSettings:
    """What her face shows, and when her eyes go to where the next foot steps."""

    around: Seconds
    fades: Duration
    turned: Ratio
    turned_from: Degrees
    wander: Ratio
    wander_time: Duration
    hard_from: Ratio
    hard_full: Ratio
    relief_from: Ratio
    relief_full: Ratio
    narrow: Ratio
    pressed: Degrees
    mouth_time: Duration
    relief: Ratio
    panting: Degrees
    squint: Ratio
    easy: Ratio
    smile_time: Duration
    air_least: Seconds
    air_around: Duration
    widen: Ratio
    gasp: Degrees
    least: Seconds
    long: Seconds
    often: Ratio
    after: Seconds
    early: Seconds
    ease: Duration
    aside: Degrees
    down: Degrees
    lids_follow: Ratio
    nod: Degrees
    bow: Degrees


@dataclass(frozen=True, slots=True)
class GrooveSettings:
    """How her trunk and head take part in jacks and slow steps."""

    around: Seconds
    ease: Seconds
    mostly: Ratio
    jack: Ratio
    steps: Ratio
    shortest: Seconds
    stays: Ratio
    lean: Degrees
    twist: Degrees
    nod: Degrees
    shrug: Degrees
    hands: Metres
    hands_easy: Metres
    hands_from: Seconds
    hands_full: Seconds
    deeper: Ratio
    bob: Metres
    stream_late: Seconds
    heels: Degrees
    leisure: Ratio
    leisure_from: Seconds
    leisure_full: Seconds
    stance: Metres
    stance_time: Seconds
    stance_early: Seconds
    phrase: Seconds
    phrase_ease: Duration
    phrase_stays: Ratio
    bow: Degrees


@dataclass(frozen=True, slots=True)
class HairSettings:
    """The braid."""

    rate: PerSecond
    gravity: MetresPerSecondSquared
    damping: PerSecond
    stiffness: Ratio
    head_radius: Metres
    back_radius: Metres
    shoulder_radius: Metres
    upper_arm_radius: Metres
    forearm_radius: Metres
    rubbing: PerSecond
    fastest: DegreesPerSecond
    struck: Ratio
    highest: Degrees
    droop: Ratio


@dataclass(frozen=True, slots=True)
class WaitSettings:
    """What she does while she waits."""

    after: Seconds
    begin: Seconds
    ready: Seconds
    ease: Seconds
    shift: Metres
    onto: Ratio
    shift_time: Seconds
    stays: Ratio
    lean: Degrees
    arms: Metres
    hips: Degrees
    chest: Degrees
    foot_from: Degrees
    foot_to: Degrees
    foot_after: Seconds
    foot_time: Seconds
    foot_stands: Seconds
    turn: Degrees
    turn_time: Seconds
    held_from: Ratio
    held_up: Metres
    held_ahead: Metres
    every: Seconds
    lasts: Seconds
    shakes: PerSecond
    flap: Degrees
    lower: Metres
    aside: Metres
    trembling: Metres
    swing: Metres
    swing_time: Seconds
    shrug: Degrees
    neck: Degrees
    heel: Degrees
    stretch: Degrees
    stretch_long: Ratio
    stretch_other: Ratio
    stretch_out: Metres
    stretch_up: Metres
    pump_time: Seconds
    pump_up: Metres
    pump_ahead: Metres
    pump: Metres


@dataclass(frozen=True, slots=True)
class LooseSettings:
    """How she shakes out her legs while she waits."""

    least: Seconds
    pause: Seconds
    ready: Seconds
    share: Ratio
    both: Ratio
    every: Seconds
    between: Seconds
    up: Seconds
    shortest: Seconds
    longest: Seconds
    height: Metres
    inward: Metres
    behind: Metres
    rate: PerSecond
    far: Metres
    hangs: Degrees
    flap: Degrees


@dataclass(frozen=True, slots=True)
class SamplingSettings:
    """Rates of the bake."""

    work_rate: PerSecond
