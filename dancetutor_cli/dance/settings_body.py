"""The sections of `configs/motion.yaml` about the body, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class BodySettings:
    """How the body rides on the feet."""

    leg: float
    stream_crouch: float
    soft_reach: float
    reach: float
    turn_to_feet: float
    step_rise: float
    lean: float
    stream_lean: float
    smooth: float
    foot_weight: float
    middle_weight: float
    middle_weight_fast: float
    height_smooth: float
    least_force: float
    most_force: float
    lean_time: float
    pelvis_lean: float
    pelvis_bend: float
    deep_bend: float
    stream_time: float
    farthest: float
    heel_carries: float


@dataclass(frozen=True, slots=True)
class KneeSettings:
    """Where knees point."""

    to_toes: float
    out: float
    most: float
    straddle: float
    straddle_most: float
    straddle_out: float
    give: float
    room: float


@dataclass(frozen=True, slots=True)
class LookSettings:
    """Where she looks and how far each part may turn."""

    torso_limit: float
    head_limit: float
    head_rate: float
    eyes_limit: float
    eyes_give_up: float
    away_from: float
    away_to: float
    head_leads: float
    head_lead: float
    torso_weight: float
    head_weight: float
    eyes_weight: float
    distance: float
    height: float
    wrung: float
    neck_share: float
    neck_easy: float
    neck_room: float
    head_tilt: float
    bent_tilt: float
    bent_yaw: float
    bent_from: float
    bent_to: float
    chin: float


@dataclass(frozen=True, slots=True)
class GlanceSettings:
    """Glances away from the screen where there is time."""

    every: float
    lasts: float
    yaw: float
    pitch: float
    tilt: float
    turn: float
    eyes: float
    eyes_ahead: float
    quick: float
    slow: float
    around: float
    hand: float
    jump: float
    neck_room: float
    eyes_room: float


@dataclass(frozen=True, slots=True)
class InertiaSettings:
    """How chest and hands overshoot."""

    chest_frequency: float
    chest_damping: float
    hand_frequency: float
    hand_damping: float
    pelvis_turn: float
    chest_turn: float
    head_turn: float


@dataclass(frozen=True, slots=True)
class LayerSettings:
    """Small movements on top."""

    breath_time: float
    breath_shoulders: float
    breath_nod: float
    head_bob: float
    shoulder_drop: float
    sway: float
    sway_time: float
    bounce: float
    beat_nod: float
    wrists: float
    blink_time: float
    beat_shortest: float
    beat_width: float
    beat_fade: float
    wrist_time: float
    wrist_wave: float
    wrist_unlike: float
    wrist_behind: float
    sway_quick: float
    sway_quick_time: float
    blink: float
    laugh_after: float
    laugh_rise: float


@dataclass(frozen=True, slots=True)
class GrooveSettings:
    """How her trunk and head take part in jacks and slow steps."""

    around: float
    ease: float
    mostly: float
    jack: float
    steps: float
    shortest: float
    stays: float
    lean: float
    twist: float
    nod: float
    shrug: float
    hands: float
    deeper: float


@dataclass(frozen=True, slots=True)
class HairSettings:
    """The braid."""

    rate: float
    gravity: float
    damping: float
    stiffness: float
    head_radius: float
    back_radius: float
    shoulder_radius: float
    upper_arm_radius: float
    forearm_radius: float
    rubbing: float
    fastest: float
    struck: float
    highest: float
    droop: float


@dataclass(frozen=True, slots=True)
class WaitSettings:
    """What she does while she waits."""

    after: float
    begin: float
    ready: float
    ease: float
    shift: float
    onto: float
    shift_time: float
    stays: float
    lean: float
    turn: float
    turn_time: float
    held_from: float
    held_up: float
    held_ahead: float
    every: float
    lasts: float
    shakes: float
    flap: float
    lower: float
    aside: float
    trembling: float
    swing: float
    swing_time: float
    shrug: float
    neck: float
    heel: float
    stretch: float
    stretch_other: float
    stretch_out: float
    stretch_up: float
    pump_time: float
    pump_up: float
    pump_ahead: float
    pump: float


@dataclass(frozen=True, slots=True)
class LooseSettings:
    """How she shakes out her legs while she waits."""

    least: float
    pause: float
    ready: float
    share: float
    both: float
    every: float
    between: float
    up: float
    shortest: float
    longest: float
    height: float
    inward: float
    behind: float
    rate: float
    far: float
    hangs: float
    flap: float


@dataclass(frozen=True, slots=True)
class SamplingSettings:
    """Rates of the bake."""

    work_rate: float
