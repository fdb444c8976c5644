"""The sections of `configs/motion.yaml` about feet, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StepSettings:
    """How a foot steps; metres, seconds, degrees."""

    longest: float
    double_support: float
    double_support_fast: float
    double_support_near: float
    double_support_far: float
    hasty: float
    height_slow: float
    height_fast: float
    height_hasty: float
    height_even: float
    height_far: float
    far: float
    fast: float
    jack_height: float
    edge: float
    edge_margin: float
    middle_inside: float
    middle_inside_hasty: float
    on_the_way: float
    lift_pitch: float
    swing_pitch: float
    land_pitch: float
    stream_pitch: float
    heel_drop: float
    yaw_to_normal: float
    toe_out: float
    foot_turn: float
    let_go: float
    ankle_limit: float
    crossover_turn: float
    crossing: float
    crossing_from: float
    turn_rate: float
    turn_crossed: float
    apart: float
    leap: float
    leap_beside: float
    wide: float
    wide_most: float
    wide_inward: float
    wide_turn: float
    pivot_from: float
    pivot_to: float
    pivot_pitch: float
    home: float
    stand: float
    least_swing: float
    overlap: float
    following: float
    staying: float
    resting: float
    body_turn: float
    rising: float
    off_ground: float
    on_ground: float
    even_quick: float
    even_slow: float
    even_ends: float
    even_up: float
    turned: float
    pitch_top: float
    heel_rise: float
    heel_rise_share: float
    heel_drop_share: float
    heel_stays: float
    lift_flat: float
    swing_flat: float
    land_stream: float
    ankle_time: float
    ankle_most: float
    press_time: float
    cross: float
    stand_cross: float
    ball_margin: float
    neighbour_margin: float
    place_off: float
    turn_off: float
    touching: float
    leap_aside: float
    on_the_spot: float
    again: float
    pivot_least: float
    pivot_few: float
    turn_ahead: float
    turn_wide: float
    turn_late: float
    crossover_from: float
    crossover_to: float
    bracket_late: float
    bracket_between: float
    bracket_turn: float
    bracket_askew: float


@dataclass(frozen=True, slots=True)
class JumpSettings:
    """How she jumps."""

    apex_near: float
    apex_far: float
    apex_hands: float
    far: float
    flight_share: float
    flight_near: float
    tuck: float
    tuck_from: float
    tuck_full: float
    least: float
    lift_pitch: float
    land_pitch: float
    yaw_to_normal: float
    gallop: float
    gallop_wait: float
    crouch: float
    follow: float
    fold: float
    lean: float
    push: float
    catch: float
    reach: float
    drive: float
    quick_flat: float
    low: float
    crouch_before: float
    crouch_time: float
    follow_after: float
    follow_time: float
    no_time: float
    full_time: float
    arms_after: float
    arms_time: float
    arms_down: float
    lean_before: float
    lean_after: float
    push_time: float
    crouch_least: float
    crouch_most: float
    arms_full: float
    round: float
    tuck_far: float
    heel_time: float
    heel_most: float
    heel_up: float
    farther: float
    gallop_flight: float
    leap_flight: float
    inward_slow: float
    inward_quick: float
    lift_flat: float
    swing_flat: float


@dataclass(frozen=True, slots=True)
class MineSettings:
    """How a foot gets out of the way of a mine."""

    before: float
    rise: float
    hop: float
    height: float
    lift_pitch: float
    swing_pitch: float
    land_pitch: float
    ahead: float
    keep_off: float
    roam: float
    far_home: float
    steep: float
    haste: float
    push: float


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """When she walks, and from where to where."""

    least: float
    settle: float
    pause: float
    leave: float
    beside: float
    floor: float
    width: float
    turn: float
    sideways: float
    far: float
    wait: float
    ahead: float
    early: float
    rest: float
    arrived: float
    narrower: float
    edge_up: float
    edge_down: float
    over_edge: float
    heel_rise: float
    push_share: float
    short: float
    sidestep: float
    sinking: float
    hands_back: float
    fade: float
    gaze_ahead: float
    lead_in: float
    lead_out: float
    gone: float


@dataclass(frozen=True, slots=True)
class AsideSettings:
    """When she steps aside to the other pad, and how."""

    far: float
    gain: float
    travel: float
    pause: float
    quick: float
    slow: float
    comfortable: float
    facing: float
    narrow: float
    wide: float
    same: float
    most: float
    mine: float
    soon: float


@dataclass(frozen=True, slots=True)
class HomeSettings:
    """When she steps back to where she rests, and how."""

    after: float
    pause: float
    pause_least: float
    rest: float
    step: float
    step_least: float
    near: float
    facing: float
    turn: float
    most: float
