"""The sections of `configs/motion.yaml` about feet, one class each; every name is explained in that file."""

from __future__ import annotations

from dataclasses import dataclass

from dancetutor_cli.dance.units import (
    Count,
    Degrees,
    DegreesPerMetre,
    DegreesPerSecond,
    Metres,
    MetresPerSecond,
    Ratio,
    Seconds,
)


@dataclass(frozen=True, slots=True)
class StepSettings:
    """How a foot steps; metres, seconds, degrees."""

    longest: Seconds
    double_support: Ratio
    double_support_fast: Ratio
    double_support_near: Ratio
    double_support_far: Metres
    hasty: Seconds
    height_slow: Metres
    height_goes: Metres
    height_varies: Ratio
    height_lands: MetresPerSecond
    height_fast: Metres
    height_hasty: Metres
    height_even: Metres
    height_accent: Ratio
    height_far: Ratio
    far: Metres
    fast: Seconds
    jack_height: Ratio
    edge: Ratio
    edge_margin: Metres
    middle_inside: Metres
    middle_inside_hasty: Metres
    on_the_way: Ratio
    lift_pitch: Degrees
    swing_pitch: Degrees
    land_pitch: Degrees
    land_slow: Ratio
    land_hasty: Degrees
    stream_pitch: Degrees
    stream_pitch_hasty: Degrees
    heel_drop: Seconds
    yaw_to_normal: Ratio
    toe_out: Degrees
    foot_turn: Degrees
    let_go: Seconds
    ankle_limit: Degrees
    ankle_pointed: Degrees
    crossover_turn: Ratio
    crossing: Count
    crossing_from: Degrees
    turn_rate: DegreesPerSecond
    turn_crossed: Degrees
    apart: Metres
    leap: Metres
    leap_beside: Metres
    wide: Metres
    wide_most: Metres
    wide_inward: Ratio
    wide_turn: Degrees
    pivot_from: Degrees
    pivot_to: Degrees
    pivot_pitch: Degrees
    pivot_flat: Seconds
    pivot_flat_ease: Seconds
    home: Metres
    stand: Seconds
    stand_slow: Ratio
    stand_quick: Seconds
    least_swing: Seconds
    overlap: Seconds
    following: Seconds
    staying: Ratio
    resting: Ratio
    body_turn: Degrees
    rising: Ratio
    falling: Ratio
    off_ground: Ratio
    on_ground: Ratio
    even_quick: Seconds
    even_slow: Seconds
    even_ends: Ratio
    even_up: Ratio
    turned: Ratio
    pitch_top: Ratio
    heel_rise: Seconds
    heel_rise_share: Ratio
    heel_drop_share: Ratio
    heel_stays: Seconds
    lift_flat: Ratio
    swing_flat: Ratio
    swing_flat_hasty: Ratio
    land_stream: Ratio
    ankle_time: Seconds
    ankle_most: Degrees
    press_time: Seconds
    cross: Degrees
    stand_cross: Degrees
    ball_margin: Metres
    neighbour_margin: Metres
    place_off: Metres
    turn_off: Degrees
    touching: Metres
    leap_aside: Metres
    on_the_spot: Metres
    again: Seconds
    pivot_least: Seconds
    pivot_few: Degrees
    turn_ahead: Degrees
    turn_wide: Degrees
    turn_late: Seconds
    crossover_from: Degrees
    crossover_to: Degrees
    bracket_late: Seconds
    bracket_between: Seconds
    bracket_turn: Degrees
    bracket_askew: Degrees


@dataclass(frozen=True, slots=True)
class JumpSettings:
    """How she jumps."""

    apex_near: Metres
    apex_far: Metres
    apex_hands: Metres
    far: Metres
    flight_share: Ratio
    flight_near: Ratio
    tuck: Metres
    tuck_from: Seconds
    tuck_full: Seconds
    least: Metres
    lift_pitch: Degrees
    land_pitch: Degrees
    rest_pitch: Degrees
    yaw_to_normal: Ratio
    gallop: Seconds
    gallop_wait: Seconds
    crouch: Metres
    follow: Metres
    fold: DegreesPerMetre
    lean: DegreesPerMetre
    push: Metres
    catch: Metres
    reach: Metres
    drive: Ratio
    together: Ratio
    quick_flat: Ratio
    low: Metres
    crouch_before: Seconds
    crouch_time: Seconds
    follow_after: Seconds
    follow_time: Seconds
    no_time: Seconds
    full_time: Seconds
    arms_after: Seconds
    arms_time: Seconds
    arms_down: Ratio
    lean_before: Seconds
    lean_after: Seconds
    push_time: Seconds
    crouch_least: Ratio
    crouch_most: Ratio
    arms_full: Seconds
    round: Ratio
    even: Ratio
    tuck_far: Ratio
    heel_time: Seconds
    heel_most: Degrees
    heel_up: Seconds
    farther: Metres
    gallop_flight: Seconds
    leap_flight: Seconds
    inward_slow: Seconds
    inward_quick: Seconds
    lift_flat: Ratio
    swing_flat: Ratio


@dataclass(frozen=True, slots=True)
class MineSettings:
    """How a foot gets out of the way of a mine."""

    before: Seconds
    rise: Seconds
    hop: Seconds
    height: Metres
    lift_pitch: Degrees
    swing_pitch: Degrees
    land_pitch: Degrees
    ahead: Seconds
    keep_off: Metres
    roam: Metres
    far_home: Metres
    steep: Seconds
    haste: Seconds
    push: Seconds


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """When she walks, and from where to where."""

    least: Seconds
    settle: Seconds
    pause: Seconds
    leave: Seconds
    beside: Metres
    floor: Metres
    width: Metres
    turn: Degrees
    sideways: Degrees
    far: Metres
    wait: Seconds
    ahead: Ratio
    early: Seconds
    rest: Seconds
    arrived: Seconds
    narrower: Metres
    edge_up: Ratio
    edge_down: Ratio
    over_edge: Metres
    heel_rise: Seconds
    push_share: Ratio
    short: Ratio
    sidestep: Ratio
    sinking: Ratio
    hands_back: Metres
    fade: Seconds
    gaze_ahead: Seconds
    lead_in: Seconds
    lead_out: Seconds
    gone: Seconds


@dataclass(frozen=True, slots=True)
class AsideSettings:
    """When she steps aside to the other pad, and how."""

    far: Metres
    gain: Metres
    travel: Ratio
    pause: Seconds
    quick: Seconds
    slow: Seconds
    comfortable: Metres
    facing: Degrees
    narrow: Metres
    wide: Metres
    same: Metres
    most: Count
    mine: Seconds
    soon: Seconds


@dataclass(frozen=True, slots=True)
class HomeSettings:
    """When she steps back to where she rests, and how."""

    after: Seconds
    pause: Seconds
    pause_least: Seconds
    rest: Seconds
    settle: Seconds
    step: Seconds
    step_least: Seconds
    near: Metres
    facing: Degrees
    turn: Degrees
    most: Count
    height: Ratio
    heel: Ratio
