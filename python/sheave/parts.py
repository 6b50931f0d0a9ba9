"""The parts of a model: bodies, shapes, joints, cables, links.

Made by sheave._generate from the tables that scenes are read with: do not edit.
"""

from __future__ import annotations

from typing import Any, Literal, Mapping, Optional, Sequence, Union

from ._part import BodyLike, Part, keys


class Joint(Part):
    """A joint between two bodies."""

    _kind = "joint"


class DistanceJoint(Joint):
    """Keeps two points at a distance: a rod, a string or a bumper, rigid or elastic; or an
    actuator.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor_a: point of body_a, world frame at time 0 ([x, y, z], numbers [m]; required)
    anchor_b: point of body_b, world frame at time 0 ([x, y, z], numbers [m]; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    length: default: the distance at time 0 (a number > 0 [m])
    limit: which distances are permitted: a rod, a string, a bumper, or any ("exactly", "at-most",
        "at-least", "none"; default: "exactly")
    compliance: 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    damping: of an elastic joint, or, with the limit none, a dashpot (a number >= 0 [N s/m];
        default: 0.0)
    lower: stops the growth of the distance since time 0 from below (default: no stop) (a number
        [m])
    upper: stops the growth of the distance since time 0 from above (default: no stop) (a number
        [m])
    limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    friction: dry friction, of bearings or guides (a number >= 0 [N]; default: 0.0)
    drive: quantity that the drive's values prescribe ("none", "position", "speed", "force";
        default: "none")
    drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    drive_values: values of the drive, one per time (a list of numbers [m, m/s or N]; default: [])
    drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    drive_amplitude: amplitude of a sine added to the values (a number [m, m/s or N]; default: 0.0)
    drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake (a
        number >= 0 [N])
    drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a number
        >= 0 [m/N]; default: 0.0)
    """

    _kind = "joint"
    _type = "distance"
    _keys = keys(
        "name body_b anchor_a anchor_b body_a breaking_force breaking_torque relative_to "
        "length limit compliance damping lower upper limit_compliance friction drive "
        "drive_times drive_values drive_interpolation drive_amplitude drive_frequency "
        "drive_phase drive_limit drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor_a: Sequence[float]
    anchor_b: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    length: Optional[float]
    limit: Optional[Literal["exactly", "at-most", "at-least", "none"]]
    compliance: Optional[float]
    damping: Optional[float]
    lower: Optional[float]
    upper: Optional[float]
    limit_compliance: Optional[float]
    friction: Optional[float]
    drive: Optional[Literal["none", "position", "speed", "force"]]
    drive_times: Optional[Sequence[float]]
    drive_values: Optional[Sequence[float]]
    drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    drive_amplitude: Optional[float]
    drive_frequency: Optional[float]
    drive_phase: Optional[float]
    drive_limit: Optional[float]
    drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor_a: Sequence[float],
        anchor_b: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        length: Optional[float] = None,
        limit: Optional[Literal["exactly", "at-most", "at-least", "none"]] = None,
        compliance: Optional[float] = None,
        damping: Optional[float] = None,
        lower: Optional[float] = None,
        upper: Optional[float] = None,
        limit_compliance: Optional[float] = None,
        friction: Optional[float] = None,
        drive: Optional[Literal["none", "position", "speed", "force"]] = None,
        drive_times: Optional[Sequence[float]] = None,
        drive_values: Optional[Sequence[float]] = None,
        drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        drive_amplitude: Optional[float] = None,
        drive_frequency: Optional[float] = None,
        drive_phase: Optional[float] = None,
        drive_limit: Optional[float] = None,
        drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class BallJoint(Joint):
    """Keeps two points of two bodies together; they turn about it, freely or within limits.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: common point, world frame at time 0 ([x, y, z], numbers [m]; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    axis: reference direction of swing and twist, world frame at time 0 ([x, y, z], numbers)
    compliance: of each direction; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    swing_limit: largest angle between the axes of the bodies (default: no limit) (a number > 0 and
        < 3.141592653589793 [rad])
    swing_limit_compliance: of the stop at swing_limit; 0 (default) is rigid (a number >= 0 [rad/(N
        m)]; default: 0.0)
    damping: viscous friction against any relative rotation (a number >= 0 [N m s/rad]; default:
        0.0)
    friction: dry friction against any relative rotation (a number >= 0 [N m]; default: 0.0)
    twist_lower: stops the twist of body_b about the axis from below (default: no stop) (a number
        [rad])
    twist_upper: stops the twist of body_b about the axis from above (default: no stop) (a number
        [rad])
    twist_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    twist_stiffness: of a spring along the twist of body_b about the axis (a number >= 0 [N m/rad];
        default: 0.0)
    twist_rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    twist_damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    twist_friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    twist_drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque";
        default: "none")
    twist_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    twist_drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m];
        default: [])
    twist_drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    twist_drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m];
        default: 0.0)
    twist_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    twist_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    twist_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake
        (a number >= 0 [N m])
    twist_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [rad/(N m)]; default: 0.0)
    """

    _kind = "joint"
    _type = "ball"
    _keys = keys(
        "name body_b anchor body_a breaking_force breaking_torque relative_to axis "
        "compliance swing_limit swing_limit_compliance damping friction twist_lower "
        "twist_upper twist_limit_compliance twist_stiffness twist_rest twist_damping "
        "twist_friction twist_drive twist_drive_times twist_drive_values "
        "twist_drive_interpolation twist_drive_amplitude twist_drive_frequency "
        "twist_drive_phase twist_drive_limit twist_drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    axis: Optional[Sequence[float]]
    compliance: Optional[float]
    swing_limit: Optional[float]
    swing_limit_compliance: Optional[float]
    damping: Optional[float]
    friction: Optional[float]
    twist_lower: Optional[float]
    twist_upper: Optional[float]
    twist_limit_compliance: Optional[float]
    twist_stiffness: Optional[float]
    twist_rest: Optional[float]
    twist_damping: Optional[float]
    twist_friction: Optional[float]
    twist_drive: Optional[Literal["none", "angle", "speed", "torque"]]
    twist_drive_times: Optional[Sequence[float]]
    twist_drive_values: Optional[Sequence[float]]
    twist_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    twist_drive_amplitude: Optional[float]
    twist_drive_frequency: Optional[float]
    twist_drive_phase: Optional[float]
    twist_drive_limit: Optional[float]
    twist_drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        axis: Optional[Sequence[float]] = None,
        compliance: Optional[float] = None,
        swing_limit: Optional[float] = None,
        swing_limit_compliance: Optional[float] = None,
        damping: Optional[float] = None,
        friction: Optional[float] = None,
        twist_lower: Optional[float] = None,
        twist_upper: Optional[float] = None,
        twist_limit_compliance: Optional[float] = None,
        twist_stiffness: Optional[float] = None,
        twist_rest: Optional[float] = None,
        twist_damping: Optional[float] = None,
        twist_friction: Optional[float] = None,
        twist_drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        twist_drive_times: Optional[Sequence[float]] = None,
        twist_drive_values: Optional[Sequence[float]] = None,
        twist_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        twist_drive_amplitude: Optional[float] = None,
        twist_drive_frequency: Optional[float] = None,
        twist_drive_phase: Optional[float] = None,
        twist_drive_limit: Optional[float] = None,
        twist_drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class HingeJoint(Joint):
    """Leaves two bodies one rotation about a common axis.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: a point of the axis, world frame at time 0 ([x, y, z], numbers [m]; required)
    axis: direction of the axis, world frame at time 0 ([x, y, z], numbers; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: of each direction of translation; 0 (default) is rigid (a number >= 0 [m/N];
        default: 0.0)
    angular_compliance: of tilting the axis; 0 (default) is rigid (a number >= 0 [rad/(N m)];
        default: 0.0)
    lower: stops the angle of body_b against body_a from below (default: no stop) (a number [rad])
    upper: stops the angle of body_b against body_a from above (default: no stop) (a number [rad])
    limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default: 0.0)
    stiffness: of a spring along the angle of body_b against body_a (a number >= 0 [N m/rad];
        default: 0.0)
    rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque"; default:
        "none")
    drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m]; default:
        [])
    drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m]; default:
        0.0)
    drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake (a
        number >= 0 [N m])
    drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a number
        >= 0 [rad/(N m)]; default: 0.0)
    """

    _kind = "joint"
    _type = "hinge"
    _keys = keys(
        "name body_b anchor axis body_a breaking_force breaking_torque relative_to "
        "compliance angular_compliance lower upper limit_compliance stiffness rest "
        "damping friction drive drive_times drive_values drive_interpolation "
        "drive_amplitude drive_frequency drive_phase drive_limit drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    axis: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]
    lower: Optional[float]
    upper: Optional[float]
    limit_compliance: Optional[float]
    stiffness: Optional[float]
    rest: Optional[float]
    damping: Optional[float]
    friction: Optional[float]
    drive: Optional[Literal["none", "angle", "speed", "torque"]]
    drive_times: Optional[Sequence[float]]
    drive_values: Optional[Sequence[float]]
    drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    drive_amplitude: Optional[float]
    drive_frequency: Optional[float]
    drive_phase: Optional[float]
    drive_limit: Optional[float]
    drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        axis: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
        lower: Optional[float] = None,
        upper: Optional[float] = None,
        limit_compliance: Optional[float] = None,
        stiffness: Optional[float] = None,
        rest: Optional[float] = None,
        damping: Optional[float] = None,
        friction: Optional[float] = None,
        drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        drive_times: Optional[Sequence[float]] = None,
        drive_values: Optional[Sequence[float]] = None,
        drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        drive_amplitude: Optional[float] = None,
        drive_frequency: Optional[float] = None,
        drive_phase: Optional[float] = None,
        drive_limit: Optional[float] = None,
        drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class SliderJoint(Joint):
    """Leaves two bodies one translation along an axis: a guide, a telescope.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: point at which the bodies are joined, world frame at time 0 ([x, y, z], numbers [m];
        required)
    axis: direction of the axis, fixed to body_a; world frame at time 0 ([x, y, z], numbers;
        required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: across the axis; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    angular_compliance: of each rotation; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    lower: stops the travel of body_b against body_a from below (default: no stop) (a number [m])
    upper: stops the travel of body_b against body_a from above (default: no stop) (a number [m])
    limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    stiffness: of a spring along the travel of body_b against body_a (a number >= 0 [N/m]; default:
        0.0)
    rest: coordinate at which the spring is relaxed (a number [m]; default: 0.0)
    damping: viscous friction (a number >= 0 [N s/m]; default: 0.0)
    friction: dry friction, of bearings or guides (a number >= 0 [N]; default: 0.0)
    drive: quantity that the drive's values prescribe ("none", "position", "speed", "force";
        default: "none")
    drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    drive_values: values of the drive, one per time (a list of numbers [m, m/s or N]; default: [])
    drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    drive_amplitude: amplitude of a sine added to the values (a number [m, m/s or N]; default: 0.0)
    drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake (a
        number >= 0 [N])
    drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a number
        >= 0 [m/N]; default: 0.0)
    """

    _kind = "joint"
    _type = "slider"
    _keys = keys(
        "name body_b anchor axis body_a breaking_force breaking_torque relative_to "
        "compliance angular_compliance lower upper limit_compliance stiffness rest "
        "damping friction drive drive_times drive_values drive_interpolation "
        "drive_amplitude drive_frequency drive_phase drive_limit drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    axis: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]
    lower: Optional[float]
    upper: Optional[float]
    limit_compliance: Optional[float]
    stiffness: Optional[float]
    rest: Optional[float]
    damping: Optional[float]
    friction: Optional[float]
    drive: Optional[Literal["none", "position", "speed", "force"]]
    drive_times: Optional[Sequence[float]]
    drive_values: Optional[Sequence[float]]
    drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    drive_amplitude: Optional[float]
    drive_frequency: Optional[float]
    drive_phase: Optional[float]
    drive_limit: Optional[float]
    drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        axis: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
        lower: Optional[float] = None,
        upper: Optional[float] = None,
        limit_compliance: Optional[float] = None,
        stiffness: Optional[float] = None,
        rest: Optional[float] = None,
        damping: Optional[float] = None,
        friction: Optional[float] = None,
        drive: Optional[Literal["none", "position", "speed", "force"]] = None,
        drive_times: Optional[Sequence[float]] = None,
        drive_values: Optional[Sequence[float]] = None,
        drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        drive_amplitude: Optional[float] = None,
        drive_frequency: Optional[float] = None,
        drive_phase: Optional[float] = None,
        drive_limit: Optional[float] = None,
        drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class CylindricalJoint(Joint):
    """Leaves two bodies a translation along an axis and a rotation about it.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: a point of the axis, world frame at time 0 ([x, y, z], numbers [m]; required)
    axis: direction of the axis, fixed to body_a; world frame at time 0 ([x, y, z], numbers;
        required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: across the axis; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    angular_compliance: of tilting the axis; 0 (default) is rigid (a number >= 0 [rad/(N m)];
        default: 0.0)
    travel_lower: stops the travel of body_b against body_a from below (default: no stop) (a number
        [m])
    travel_upper: stops the travel of body_b against body_a from above (default: no stop) (a number
        [m])
    travel_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    travel_stiffness: of a spring along the travel of body_b against body_a (a number >= 0 [N/m];
        default: 0.0)
    travel_rest: coordinate at which the spring is relaxed (a number [m]; default: 0.0)
    travel_damping: viscous friction (a number >= 0 [N s/m]; default: 0.0)
    travel_friction: dry friction, of bearings or guides (a number >= 0 [N]; default: 0.0)
    travel_drive: quantity that the drive's values prescribe ("none", "position", "speed", "force";
        default: "none")
    travel_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    travel_drive_values: values of the drive, one per time (a list of numbers [m, m/s or N];
        default: [])
    travel_drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    travel_drive_amplitude: amplitude of a sine added to the values (a number [m, m/s or N];
        default: 0.0)
    travel_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    travel_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    travel_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake
        (a number >= 0 [N])
    travel_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [m/N]; default: 0.0)
    angle_lower: stops the angle of body_b against body_a from below (default: no stop) (a number
        [rad])
    angle_upper: stops the angle of body_b against body_a from above (default: no stop) (a number
        [rad])
    angle_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    angle_stiffness: of a spring along the angle of body_b against body_a (a number >= 0 [N m/rad];
        default: 0.0)
    angle_rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    angle_damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    angle_friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    angle_drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque";
        default: "none")
    angle_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    angle_drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m];
        default: [])
    angle_drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    angle_drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m];
        default: 0.0)
    angle_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    angle_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    angle_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake
        (a number >= 0 [N m])
    angle_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [rad/(N m)]; default: 0.0)
    """

    _kind = "joint"
    _type = "cylindrical"
    _keys = keys(
        "name body_b anchor axis body_a breaking_force breaking_torque relative_to "
        "compliance angular_compliance travel_lower travel_upper travel_limit_compliance "
        "travel_stiffness travel_rest travel_damping travel_friction travel_drive "
        "travel_drive_times travel_drive_values travel_drive_interpolation "
        "travel_drive_amplitude travel_drive_frequency travel_drive_phase "
        "travel_drive_limit travel_drive_compliance angle_lower angle_upper "
        "angle_limit_compliance angle_stiffness angle_rest angle_damping angle_friction "
        "angle_drive angle_drive_times angle_drive_values angle_drive_interpolation "
        "angle_drive_amplitude angle_drive_frequency angle_drive_phase angle_drive_limit "
        "angle_drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    axis: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]
    travel_lower: Optional[float]
    travel_upper: Optional[float]
    travel_limit_compliance: Optional[float]
    travel_stiffness: Optional[float]
    travel_rest: Optional[float]
    travel_damping: Optional[float]
    travel_friction: Optional[float]
    travel_drive: Optional[Literal["none", "position", "speed", "force"]]
    travel_drive_times: Optional[Sequence[float]]
    travel_drive_values: Optional[Sequence[float]]
    travel_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    travel_drive_amplitude: Optional[float]
    travel_drive_frequency: Optional[float]
    travel_drive_phase: Optional[float]
    travel_drive_limit: Optional[float]
    travel_drive_compliance: Optional[float]
    angle_lower: Optional[float]
    angle_upper: Optional[float]
    angle_limit_compliance: Optional[float]
    angle_stiffness: Optional[float]
    angle_rest: Optional[float]
    angle_damping: Optional[float]
    angle_friction: Optional[float]
    angle_drive: Optional[Literal["none", "angle", "speed", "torque"]]
    angle_drive_times: Optional[Sequence[float]]
    angle_drive_values: Optional[Sequence[float]]
    angle_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    angle_drive_amplitude: Optional[float]
    angle_drive_frequency: Optional[float]
    angle_drive_phase: Optional[float]
    angle_drive_limit: Optional[float]
    angle_drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        axis: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
        travel_lower: Optional[float] = None,
        travel_upper: Optional[float] = None,
        travel_limit_compliance: Optional[float] = None,
        travel_stiffness: Optional[float] = None,
        travel_rest: Optional[float] = None,
        travel_damping: Optional[float] = None,
        travel_friction: Optional[float] = None,
        travel_drive: Optional[Literal["none", "position", "speed", "force"]] = None,
        travel_drive_times: Optional[Sequence[float]] = None,
        travel_drive_values: Optional[Sequence[float]] = None,
        travel_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        travel_drive_amplitude: Optional[float] = None,
        travel_drive_frequency: Optional[float] = None,
        travel_drive_phase: Optional[float] = None,
        travel_drive_limit: Optional[float] = None,
        travel_drive_compliance: Optional[float] = None,
        angle_lower: Optional[float] = None,
        angle_upper: Optional[float] = None,
        angle_limit_compliance: Optional[float] = None,
        angle_stiffness: Optional[float] = None,
        angle_rest: Optional[float] = None,
        angle_damping: Optional[float] = None,
        angle_friction: Optional[float] = None,
        angle_drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        angle_drive_times: Optional[Sequence[float]] = None,
        angle_drive_values: Optional[Sequence[float]] = None,
        angle_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        angle_drive_amplitude: Optional[float] = None,
        angle_drive_frequency: Optional[float] = None,
        angle_drive_phase: Optional[float] = None,
        angle_drive_limit: Optional[float] = None,
        angle_drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class UniversalJoint(Joint):
    """Keeps two points together and two axes at a right angle: a Cardan joint.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: common point, world frame at time 0 ([x, y, z], numbers [m]; required)
    axis_a: axis fixed to body_a, world frame at time 0 ([x, y, z], numbers; required)
    axis_b: axis fixed to body_b, perpendicular to axis_a ([x, y, z], numbers; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: of each direction of translation; 0 (default) is rigid (a number >= 0 [m/N];
        default: 0.0)
    angular_compliance: of the angle between the axes; 0 (default) is rigid (a number >= 0 [rad/(N
        m)]; default: 0.0)
    angle_a_lower: stops the turn about axis_a from below (default: no stop) (a number [rad])
    angle_a_upper: stops the turn about axis_a from above (default: no stop) (a number [rad])
    angle_a_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)];
        default: 0.0)
    angle_a_stiffness: of a spring along the turn about axis_a (a number >= 0 [N m/rad]; default:
        0.0)
    angle_a_rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    angle_a_damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    angle_a_friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    angle_a_drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque";
        default: "none")
    angle_a_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    angle_a_drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m];
        default: [])
    angle_a_drive_interpolation: of the values between their times; cubic: a smooth spline, which
        may overshoot the values and may start backwards; clamped: a spline with rate 0 at both
        ends; monotone: smooth, and within the range of the two values around a time ("linear",
        "cubic", "clamped", "monotone"; default: "linear")
    angle_a_drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m];
        default: 0.0)
    angle_a_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    angle_a_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    angle_a_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open
        brake (a number >= 0 [N m])
    angle_a_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [rad/(N m)]; default: 0.0)
    angle_b_lower: stops the turn about axis_b from below (default: no stop) (a number [rad])
    angle_b_upper: stops the turn about axis_b from above (default: no stop) (a number [rad])
    angle_b_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)];
        default: 0.0)
    angle_b_stiffness: of a spring along the turn about axis_b (a number >= 0 [N m/rad]; default:
        0.0)
    angle_b_rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    angle_b_damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    angle_b_friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    angle_b_drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque";
        default: "none")
    angle_b_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    angle_b_drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m];
        default: [])
    angle_b_drive_interpolation: of the values between their times; cubic: a smooth spline, which
        may overshoot the values and may start backwards; clamped: a spline with rate 0 at both
        ends; monotone: smooth, and within the range of the two values around a time ("linear",
        "cubic", "clamped", "monotone"; default: "linear")
    angle_b_drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m];
        default: 0.0)
    angle_b_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    angle_b_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    angle_b_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open
        brake (a number >= 0 [N m])
    angle_b_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [rad/(N m)]; default: 0.0)
    """

    _kind = "joint"
    _type = "universal"
    _keys = keys(
        "name body_b anchor axis_a axis_b body_a breaking_force breaking_torque "
        "relative_to compliance angular_compliance angle_a_lower angle_a_upper "
        "angle_a_limit_compliance angle_a_stiffness angle_a_rest angle_a_damping "
        "angle_a_friction angle_a_drive angle_a_drive_times angle_a_drive_values "
        "angle_a_drive_interpolation angle_a_drive_amplitude angle_a_drive_frequency "
        "angle_a_drive_phase angle_a_drive_limit angle_a_drive_compliance angle_b_lower "
        "angle_b_upper angle_b_limit_compliance angle_b_stiffness angle_b_rest "
        "angle_b_damping angle_b_friction angle_b_drive angle_b_drive_times "
        "angle_b_drive_values angle_b_drive_interpolation angle_b_drive_amplitude "
        "angle_b_drive_frequency angle_b_drive_phase angle_b_drive_limit "
        "angle_b_drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    axis_a: Sequence[float]
    axis_b: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]
    angle_a_lower: Optional[float]
    angle_a_upper: Optional[float]
    angle_a_limit_compliance: Optional[float]
    angle_a_stiffness: Optional[float]
    angle_a_rest: Optional[float]
    angle_a_damping: Optional[float]
    angle_a_friction: Optional[float]
    angle_a_drive: Optional[Literal["none", "angle", "speed", "torque"]]
    angle_a_drive_times: Optional[Sequence[float]]
    angle_a_drive_values: Optional[Sequence[float]]
    angle_a_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    angle_a_drive_amplitude: Optional[float]
    angle_a_drive_frequency: Optional[float]
    angle_a_drive_phase: Optional[float]
    angle_a_drive_limit: Optional[float]
    angle_a_drive_compliance: Optional[float]
    angle_b_lower: Optional[float]
    angle_b_upper: Optional[float]
    angle_b_limit_compliance: Optional[float]
    angle_b_stiffness: Optional[float]
    angle_b_rest: Optional[float]
    angle_b_damping: Optional[float]
    angle_b_friction: Optional[float]
    angle_b_drive: Optional[Literal["none", "angle", "speed", "torque"]]
    angle_b_drive_times: Optional[Sequence[float]]
    angle_b_drive_values: Optional[Sequence[float]]
    angle_b_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    angle_b_drive_amplitude: Optional[float]
    angle_b_drive_frequency: Optional[float]
    angle_b_drive_phase: Optional[float]
    angle_b_drive_limit: Optional[float]
    angle_b_drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        axis_a: Sequence[float],
        axis_b: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
        angle_a_lower: Optional[float] = None,
        angle_a_upper: Optional[float] = None,
        angle_a_limit_compliance: Optional[float] = None,
        angle_a_stiffness: Optional[float] = None,
        angle_a_rest: Optional[float] = None,
        angle_a_damping: Optional[float] = None,
        angle_a_friction: Optional[float] = None,
        angle_a_drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        angle_a_drive_times: Optional[Sequence[float]] = None,
        angle_a_drive_values: Optional[Sequence[float]] = None,
        angle_a_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        angle_a_drive_amplitude: Optional[float] = None,
        angle_a_drive_frequency: Optional[float] = None,
        angle_a_drive_phase: Optional[float] = None,
        angle_a_drive_limit: Optional[float] = None,
        angle_a_drive_compliance: Optional[float] = None,
        angle_b_lower: Optional[float] = None,
        angle_b_upper: Optional[float] = None,
        angle_b_limit_compliance: Optional[float] = None,
        angle_b_stiffness: Optional[float] = None,
        angle_b_rest: Optional[float] = None,
        angle_b_damping: Optional[float] = None,
        angle_b_friction: Optional[float] = None,
        angle_b_drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        angle_b_drive_times: Optional[Sequence[float]] = None,
        angle_b_drive_values: Optional[Sequence[float]] = None,
        angle_b_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        angle_b_drive_amplitude: Optional[float] = None,
        angle_b_drive_frequency: Optional[float] = None,
        angle_b_drive_phase: Optional[float] = None,
        angle_b_drive_limit: Optional[float] = None,
        angle_b_drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class PlaneJoint(Joint):
    """Leaves two bodies translations in a plane and the rotation about its normal.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: a point of the plane, world frame at time 0 ([x, y, z], numbers [m]; required)
    normal: of the plane, fixed to body_a; world frame at time 0 ([x, y, z], numbers; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: of the distance from the plane; 0 (default) is rigid (a number >= 0 [m/N]; default:
        0.0)
    angular_compliance: of the tilt; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default: 0.0)
    damping: viscous friction against sliding (a number >= 0 [N s/m]; default: 0.0)
    friction: dry friction against sliding (a number >= 0 [N]; default: 0.0)
    angle_lower: stops the angle of body_b about the normal from below (default: no stop) (a number
        [rad])
    angle_upper: stops the angle of body_b about the normal from above (default: no stop) (a number
        [rad])
    angle_limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    angle_stiffness: of a spring along the angle of body_b about the normal (a number >= 0 [N
        m/rad]; default: 0.0)
    angle_rest: coordinate at which the spring is relaxed (a number [rad]; default: 0.0)
    angle_damping: viscous friction (a number >= 0 [N m s/rad]; default: 0.0)
    angle_friction: dry friction, of bearings or guides (a number >= 0 [N m]; default: 0.0)
    angle_drive: quantity that the drive's values prescribe ("none", "angle", "speed", "torque";
        default: "none")
    angle_drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    angle_drive_values: values of the drive, one per time (a list of numbers [rad, rad/s or N m];
        default: [])
    angle_drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    angle_drive_amplitude: amplitude of a sine added to the values (a number [rad, rad/s or N m];
        default: 0.0)
    angle_drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    angle_drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    angle_drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake
        (a number >= 0 [N m])
    angle_drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a
        number >= 0 [rad/(N m)]; default: 0.0)
    """

    _kind = "joint"
    _type = "plane"
    _keys = keys(
        "name body_b anchor normal body_a breaking_force breaking_torque relative_to "
        "compliance angular_compliance damping friction angle_lower angle_upper "
        "angle_limit_compliance angle_stiffness angle_rest angle_damping angle_friction "
        "angle_drive angle_drive_times angle_drive_values angle_drive_interpolation "
        "angle_drive_amplitude angle_drive_frequency angle_drive_phase angle_drive_limit "
        "angle_drive_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    normal: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]
    damping: Optional[float]
    friction: Optional[float]
    angle_lower: Optional[float]
    angle_upper: Optional[float]
    angle_limit_compliance: Optional[float]
    angle_stiffness: Optional[float]
    angle_rest: Optional[float]
    angle_damping: Optional[float]
    angle_friction: Optional[float]
    angle_drive: Optional[Literal["none", "angle", "speed", "torque"]]
    angle_drive_times: Optional[Sequence[float]]
    angle_drive_values: Optional[Sequence[float]]
    angle_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    angle_drive_amplitude: Optional[float]
    angle_drive_frequency: Optional[float]
    angle_drive_phase: Optional[float]
    angle_drive_limit: Optional[float]
    angle_drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        normal: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
        damping: Optional[float] = None,
        friction: Optional[float] = None,
        angle_lower: Optional[float] = None,
        angle_upper: Optional[float] = None,
        angle_limit_compliance: Optional[float] = None,
        angle_stiffness: Optional[float] = None,
        angle_rest: Optional[float] = None,
        angle_damping: Optional[float] = None,
        angle_friction: Optional[float] = None,
        angle_drive: Optional[Literal["none", "angle", "speed", "torque"]] = None,
        angle_drive_times: Optional[Sequence[float]] = None,
        angle_drive_values: Optional[Sequence[float]] = None,
        angle_drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        angle_drive_amplitude: Optional[float] = None,
        angle_drive_frequency: Optional[float] = None,
        angle_drive_phase: Optional[float] = None,
        angle_drive_limit: Optional[float] = None,
        angle_drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class FixedJoint(Joint):
    """Welds two bodies together.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    anchor: point at which the bodies are joined, world frame at time 0 ([x, y, z], numbers [m];
        required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    compliance: of each direction of translation; 0 (default) is rigid (a number >= 0 [m/N];
        default: 0.0)
    angular_compliance: of each rotation; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    """

    _kind = "joint"
    _type = "fixed"
    _keys = keys(
        "name body_b anchor body_a breaking_force breaking_torque relative_to compliance "
        "angular_compliance "
    )

    name: str
    body_b: BodyLike
    anchor: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    compliance: Optional[float]
    angular_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        anchor: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        angular_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class GearJoint(Joint):
    """Couples the rotations of two bodies about given axes: gears, a chain drive.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    ratio: turns of body_b per turn of body_a, not 0; negative for wheels that mesh from outside (a
        number; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    axis_a: of body_a's rotation, world frame at time 0 (default z) ([x, y, z], numbers; default:
        [0.0,0.0,1.0])
    axis_b: of body_b's rotation, world frame at time 0 (default z) ([x, y, z], numbers; default:
        [0.0,0.0,1.0])
    carrier: the body that carries both axles (default: the world) (the name of a body, or "world";
        default: "world")
    compliance: of the angle of body_b; 0 (default) is rigid (a number >= 0 [rad/(N m)]; default:
        0.0)
    backlash: play of body_b (a number >= 0 [rad]; default: 0.0)
    """

    _kind = "joint"
    _type = "gear"
    _keys = keys(
        "name body_b ratio body_a breaking_force breaking_torque relative_to axis_a "
        "axis_b carrier compliance backlash "
    )

    name: str
    body_b: BodyLike
    ratio: float
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    axis_a: Optional[Sequence[float]]
    axis_b: Optional[Sequence[float]]
    carrier: Optional[BodyLike]
    compliance: Optional[float]
    backlash: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        ratio: float,
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        axis_a: Optional[Sequence[float]] = None,
        axis_b: Optional[Sequence[float]] = None,
        carrier: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        backlash: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class RackJoint(Joint):
    """Couples a rotation of one body with a translation of another: a rack, a screw.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    axis: of body_a's rotation, world frame at time 0 ([x, y, z], numbers; required)
    direction: of body_b's translation, world frame at time 0 ([x, y, z], numbers; required)
    anchor: point of body_b at which the force acts, world frame at time 0 ([x, y, z], numbers [m];
        required)
    radius: travel per angle, not 0; a screw has its pitch / 2 pi (a number [m/rad]; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    carrier: the body that carries axle and guide (default: the world) (the name of a body, or
        "world"; default: "world")
    compliance: of the travel; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    backlash: play of body_b (a number >= 0 [m]; default: 0.0)
    """

    _kind = "joint"
    _type = "rack"
    _keys = keys(
        "name body_b axis direction anchor radius body_a breaking_force breaking_torque "
        "relative_to carrier compliance backlash "
    )

    name: str
    body_b: BodyLike
    axis: Sequence[float]
    direction: Sequence[float]
    anchor: Sequence[float]
    radius: float
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    carrier: Optional[BodyLike]
    compliance: Optional[float]
    backlash: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        axis: Sequence[float],
        direction: Sequence[float],
        anchor: Sequence[float],
        radius: float,
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        carrier: Optional[BodyLike] = None,
        compliance: Optional[float] = None,
        backlash: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class CouplingJoint(Joint):
    """Couples coordinates of other joints: a fixed tendon, fingers that bend together, an inertia
    behind a gear.

    name: unique name among the joints (a string; required)
    body_b: differs from body_a (the name of a body, or "world"; required)
    joints: names of the coupled joints, 1 to 4: hinges, sliders, cylindrical, plane and universal
        joints; body_a and body_b are those of the last (a list of strings; required)
    factors: one per joint: travel per radius and rad, or per travel; not 0, but the last one beside
        a curve (a list of numbers; required)
    body_a: default: the world (the name of a body, or "world"; default: "world")
    breaking_force: a larger force breaks the joint (default: none does) (a number > 0 [N])
    breaking_torque: a larger torque breaks the joint (default: none does) (a number > 0 [N m])
    relative_to: the body whose frame at time 0 the points and directions below refer to; in scene
        files (the name of a body, or "world")
    joint_coordinates: names of their coordinates, one per joint (default: each joint has only one)
        (a list of strings; default: [])
    curve: factors of the powers 2, 3, ... of the last coordinate, an angle or travel / radius; at
        most 8 (a list of numbers; default: [])
    radius: travel per rad (default: 1) (a number > 0 [m]; default: 1.0)
    held: keeps the travel at 0 (default: true) (true or false; default: true)
    compliance: of a travel that is held; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    lower: stops the travel from below (default: no stop) (a number [m])
    upper: stops the travel from above (default: no stop) (a number [m])
    limit_compliance: of the stops; 0 (default) is rigid (a number >= 0 [m/N]; default: 0.0)
    stiffness: of a spring along the travel (a number >= 0 [N/m]; default: 0.0)
    rest: coordinate at which the spring is relaxed (a number [m]; default: 0.0)
    damping: viscous friction (a number >= 0 [N s/m]; default: 0.0)
    friction: dry friction, of bearings or guides (a number >= 0 [N]; default: 0.0)
    drive: quantity that the drive's values prescribe ("none", "position", "speed", "force";
        default: "none")
    drive_times: increasing times of the values; none for a constant (a list of numbers [s];
        default: [])
    drive_values: values of the drive, one per time (a list of numbers [m, m/s or N]; default: [])
    drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    drive_amplitude: amplitude of a sine added to the values (a number [m, m/s or N]; default: 0.0)
    drive_frequency: of the sine (a number >= 0 [Hz]; default: 0.0)
    drive_phase: of the sine at time 0 (a number [rad]; default: 0.0)
    drive_limit: largest force or torque of the drive (default: no limit); 0 is an open brake (a
        number >= 0 [N])
    drive_compliance: deflection per force of a drive to a position; 0 (default) is rigid (a number
        >= 0 [m/N]; default: 0.0)
    """

    _kind = "joint"
    _type = "coupling"
    _keys = keys(
        "name body_b joints factors body_a breaking_force breaking_torque relative_to "
        "joint_coordinates curve radius held compliance lower upper limit_compliance "
        "stiffness rest damping friction drive drive_times drive_values "
        "drive_interpolation drive_amplitude drive_frequency drive_phase drive_limit "
        "drive_compliance "
    )

    name: str
    body_b: BodyLike
    joints: Sequence[str]
    factors: Sequence[float]
    body_a: Optional[BodyLike]
    breaking_force: Optional[float]
    breaking_torque: Optional[float]
    relative_to: Optional[BodyLike]
    joint_coordinates: Optional[Sequence[str]]
    curve: Optional[Sequence[float]]
    radius: Optional[float]
    held: Optional[bool]
    compliance: Optional[float]
    lower: Optional[float]
    upper: Optional[float]
    limit_compliance: Optional[float]
    stiffness: Optional[float]
    rest: Optional[float]
    damping: Optional[float]
    friction: Optional[float]
    drive: Optional[Literal["none", "position", "speed", "force"]]
    drive_times: Optional[Sequence[float]]
    drive_values: Optional[Sequence[float]]
    drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    drive_amplitude: Optional[float]
    drive_frequency: Optional[float]
    drive_phase: Optional[float]
    drive_limit: Optional[float]
    drive_compliance: Optional[float]

    def __init__(
        self,
        name: str,
        body_b: BodyLike,
        joints: Sequence[str],
        factors: Sequence[float],
        *,
        body_a: Optional[BodyLike] = None,
        breaking_force: Optional[float] = None,
        breaking_torque: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        joint_coordinates: Optional[Sequence[str]] = None,
        curve: Optional[Sequence[float]] = None,
        radius: Optional[float] = None,
        held: Optional[bool] = None,
        compliance: Optional[float] = None,
        lower: Optional[float] = None,
        upper: Optional[float] = None,
        limit_compliance: Optional[float] = None,
        stiffness: Optional[float] = None,
        rest: Optional[float] = None,
        damping: Optional[float] = None,
        friction: Optional[float] = None,
        drive: Optional[Literal["none", "position", "speed", "force"]] = None,
        drive_times: Optional[Sequence[float]] = None,
        drive_values: Optional[Sequence[float]] = None,
        drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        drive_amplitude: Optional[float] = None,
        drive_frequency: Optional[float] = None,
        drive_phase: Optional[float] = None,
        drive_limit: Optional[float] = None,
        drive_compliance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Controller(Part):
    """Leads an observable to a setpoint."""

    _kind = "controller"


class PidController(Controller):
    """Proportional, integral and derivative action on setpoint - measured, with feed-forward; the
    integral does not wind up at the limits.

    name: unique name among the controllers (a string; required)
    measures: the observable or expression to control; no observable on request that is known only
        for the last substep (a string; required)
    control: the control to set, see Controls (a string; required)
    setpoint: constant, in the observable's unit (a number)
    setpoint_times: increasing times of the setpoint's values (a list of numbers [s]; default: [])
    setpoint_values: of a setpoint that changes, one per time (a list of numbers; default: [])
    setpoint_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    setpoint_quantity: an observable or expression that is the setpoint, or that is added to it (a
        string; default: "")
    sample_time: how often it acts, at most once per substep; default: dt (a number > 0 [s])
    on: at time 0; triggers switch it (true or false; default: true)
    proportional: control per error (a number; default: 0.0)
    integral: control per error and second (a number [1/s]; default: 0.0)
    derivative: control per rate of the error (a number [s]; default: 0.0)
    derivative_filter: time constant of a lag that the derivative has (a number >= 0 [s]; default:
        0.0)
    feed_forward: is added to the output (a number; default: 0.0)
    setpoint_gain: the setpoint times this, too (a number; default: 0.0)
    rate_gain: and the mean rate until the next sample, of a setpoint by table, times this (a number
        [s]; default: 0.0)
    lower: the least output (default: any) (a number)
    upper: the greatest output (default: any) (a number)
    """

    _kind = "controller"
    _type = "pid"
    _keys = keys(
        "name measures control setpoint setpoint_times setpoint_values "
        "setpoint_interpolation setpoint_quantity sample_time on proportional integral "
        "derivative derivative_filter feed_forward setpoint_gain rate_gain lower upper "
    )

    name: str
    measures: str
    control: str
    setpoint: Optional[float]
    setpoint_times: Optional[Sequence[float]]
    setpoint_values: Optional[Sequence[float]]
    setpoint_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    setpoint_quantity: Optional[str]
    sample_time: Optional[float]
    on: Optional[bool]
    proportional: Optional[float]
    integral: Optional[float]
    derivative: Optional[float]
    derivative_filter: Optional[float]
    feed_forward: Optional[float]
    setpoint_gain: Optional[float]
    rate_gain: Optional[float]
    lower: Optional[float]
    upper: Optional[float]

    def __init__(
        self,
        name: str,
        measures: str,
        control: str,
        *,
        setpoint: Optional[float] = None,
        setpoint_times: Optional[Sequence[float]] = None,
        setpoint_values: Optional[Sequence[float]] = None,
        setpoint_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        setpoint_quantity: Optional[str] = None,
        sample_time: Optional[float] = None,
        on: Optional[bool] = None,
        proportional: Optional[float] = None,
        integral: Optional[float] = None,
        derivative: Optional[float] = None,
        derivative_filter: Optional[float] = None,
        feed_forward: Optional[float] = None,
        setpoint_gain: Optional[float] = None,
        rate_gain: Optional[float] = None,
        lower: Optional[float] = None,
        upper: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class BangBangController(Controller):
    """One of two outputs, by whether the observable is below or above its setpoint.

    name: unique name among the controllers (a string; required)
    measures: the observable or expression to control; no observable on request that is known only
        for the last substep (a string; required)
    control: the control to set, see Controls (a string; required)
    low: output while the observable is above its setpoint (a number; required)
    high: output while it is below (a number; required)
    setpoint: constant, in the observable's unit (a number)
    setpoint_times: increasing times of the setpoint's values (a list of numbers [s]; default: [])
    setpoint_values: of a setpoint that changes, one per time (a list of numbers; default: [])
    setpoint_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    setpoint_quantity: an observable or expression that is the setpoint, or that is added to it (a
        string; default: "")
    sample_time: how often it acts, at most once per substep; default: dt (a number > 0 [s])
    on: at time 0; triggers switch it (true or false; default: true)
    hysteresis: the output switches half of this beyond the setpoint, in the observable's unit (a
        number >= 0; default: 0.0)
    """

    _kind = "controller"
    _type = "bang-bang"
    _keys = keys(
        "name measures control low high setpoint setpoint_times setpoint_values "
        "setpoint_interpolation setpoint_quantity sample_time on hysteresis "
    )

    name: str
    measures: str
    control: str
    low: float
    high: float
    setpoint: Optional[float]
    setpoint_times: Optional[Sequence[float]]
    setpoint_values: Optional[Sequence[float]]
    setpoint_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    setpoint_quantity: Optional[str]
    sample_time: Optional[float]
    on: Optional[bool]
    hysteresis: Optional[float]

    def __init__(
        self,
        name: str,
        measures: str,
        control: str,
        low: float,
        high: float,
        *,
        setpoint: Optional[float] = None,
        setpoint_times: Optional[Sequence[float]] = None,
        setpoint_values: Optional[Sequence[float]] = None,
        setpoint_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        setpoint_quantity: Optional[str] = None,
        sample_time: Optional[float] = None,
        on: Optional[bool] = None,
        hysteresis: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Load(Part):
    """Acts on a body over time, or prescribes its motion; or is a muscle along a cable."""

    _kind = "load"


class ForceLoad(Load):
    """A force and a torque over time.

    name: unique name among the loads (a string; required)
    body: the body on which it acts; required, but for a muscle, which has none (the name of a body,
        or "world"; default: "world")
    times: increasing times of the values; none for a constant (a list of numbers [s]; default: [])
    forces: [x, y, z] of the force, one per time (a list of [x, y, z], numbers [N]; default: [])
    torques: [x, y, z] of a torque in addition to the moment of the force, one per time (a list of
        [x, y, z], numbers [N m]; default: [])
    interpolation: of the values between their times; cubic: a smooth spline, which may overshoot
        the values and may start backwards; clamped: a spline with rate 0 at both ends; monotone:
        smooth, and within the range of the two values around a time ("linear", "cubic", "clamped",
        "monotone"; default: "linear")
    point: where the force acts, body frame; default: the centre of mass ([x, y, z], numbers [m])
    frame: of force and torque: of the world, or of the body, with which they turn ("world", "body";
        default: "world")
    """

    _kind = "load"
    _type = "force"
    _keys = keys(
        "name body times forces torques interpolation point frame "
    )

    name: str
    body: Optional[BodyLike]
    times: Optional[Sequence[float]]
    forces: Optional[Sequence[Sequence[float]]]
    torques: Optional[Sequence[Sequence[float]]]
    interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    point: Optional[Sequence[float]]
    frame: Optional[Literal["world", "body"]]

    def __init__(
        self,
        name: str,
        *,
        body: Optional[BodyLike] = None,
        times: Optional[Sequence[float]] = None,
        forces: Optional[Sequence[Sequence[float]]] = None,
        torques: Optional[Sequence[Sequence[float]]] = None,
        interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        point: Optional[Sequence[float]] = None,
        frame: Optional[Literal["world", "body"]] = None,
    ) -> None:
        super().__init__(locals())


class WindLoad(Load):
    """The drag of a wind on a body, by its drag area.

    name: unique name among the loads (a string; required)
    drag_area: drag coefficient times area (a number > 0 [m2]; required)
    body: the body on which it acts; required, but for a muscle, which has none (the name of a body,
        or "world"; default: "world")
    density: of the air (a number > 0 [kg/m3]; default: 1.225)
    times: increasing times of the velocities; none for a constant (a list of numbers [s]; default:
        [])
    velocities: [x, y, z] of the wind, one per time; none: still air (a list of [x, y, z], numbers
        [m/s]; default: [])
    interpolation: of the values between their times; cubic: a smooth spline, which may overshoot
        the values and may start backwards; clamped: a spline with rate 0 at both ends; monotone:
        smooth, and within the range of the two values around a time ("linear", "cubic", "clamped",
        "monotone"; default: "linear")
    point: where the drag acts, body frame; default: the centre of mass ([x, y, z], numbers [m])
    """

    _kind = "load"
    _type = "wind"
    _keys = keys(
        "name drag_area body density times velocities interpolation point "
    )

    name: str
    drag_area: float
    body: Optional[BodyLike]
    density: Optional[float]
    times: Optional[Sequence[float]]
    velocities: Optional[Sequence[Sequence[float]]]
    interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    point: Optional[Sequence[float]]

    def __init__(
        self,
        name: str,
        drag_area: float,
        *,
        body: Optional[BodyLike] = None,
        density: Optional[float] = None,
        times: Optional[Sequence[float]] = None,
        velocities: Optional[Sequence[Sequence[float]]] = None,
        interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        point: Optional[Sequence[float]] = None,
    ) -> None:
        super().__init__(locals())


class MotionLoad(Load):
    """Moves a kinematic body in six degrees of freedom: sums of sines, and a table.

    name: unique name among the loads (a string; required)
    body: the body on which it acts; required, but for a muscle, which has none (the name of a body,
        or "world"; default: "world")
    frequencies: of sines, one per sine (a list of numbers >= 0 [Hz]; default: [])
    phases: of the sines at time 0; none: 0 (a list of numbers [rad]; default: [])
    translations: [x, y, z], the amplitude of each sine: surge, heave, sway (a list of [x, y, z],
        numbers [m]; default: [])
    rotations: [x, y, z], the amplitude of each sine about these axes of the world: roll, yaw, pitch
        (a list of [x, y, z], numbers [rad]; default: [])
    times: increasing times of a table, which is added to the sines (a list of numbers [s]; default:
        [])
    positions: [x, y, z], one per time; only their changes count (a list of [x, y, z], numbers [m];
        default: [])
    turns: rotation vectors, one per time; only their changes count (a list of [x, y, z], numbers
        [rad]; default: [])
    interpolation: of the values between their times; cubic: a smooth spline, which may overshoot
        the values and may start backwards; clamped: a spline with rate 0 at both ends; monotone:
        smooth, and within the range of the two values around a time ("linear", "cubic", "clamped",
        "monotone"; default: "cubic")
    """

    _kind = "load"
    _type = "motion"
    _keys = keys(
        "name body frequencies phases translations rotations times positions turns "
        "interpolation "
    )

    name: str
    body: Optional[BodyLike]
    frequencies: Optional[Sequence[float]]
    phases: Optional[Sequence[float]]
    translations: Optional[Sequence[Sequence[float]]]
    rotations: Optional[Sequence[Sequence[float]]]
    times: Optional[Sequence[float]]
    positions: Optional[Sequence[Sequence[float]]]
    turns: Optional[Sequence[Sequence[float]]]
    interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]

    def __init__(
        self,
        name: str,
        *,
        body: Optional[BodyLike] = None,
        frequencies: Optional[Sequence[float]] = None,
        phases: Optional[Sequence[float]] = None,
        translations: Optional[Sequence[Sequence[float]]] = None,
        rotations: Optional[Sequence[Sequence[float]]] = None,
        times: Optional[Sequence[float]] = None,
        positions: Optional[Sequence[Sequence[float]]] = None,
        turns: Optional[Sequence[Sequence[float]]] = None,
        interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
    ) -> None:
        super().__init__(locals())


class MuscleLoad(Load):
    """A muscle along a cable: force by length, velocity and activation.

    name: unique name among the loads (a string; required)
    cable: name of the cable along which the muscle lies; its own tension acts beside that of the
        muscle (a string; required)
    force: peak active force (a number > 0 [N]; required)
    optimal_length: length of the fibres at that force (a number > 0 [m]; required)
    body: the body on which it acts; required, but for a muscle, which has none (the name of a body,
        or "world"; default: "world")
    tendon_length: part of the path that is rigid tendon (a number [m]; default: 0.0)
    max_speed: fastest shortening, in optimal lengths per second (a number > 0 [1/s]; default: 1.5)
    shortest: least length with active force, in optimal lengths, below 1 (a number 0 ... 1;
        default: 0.5)
    longest: greatest length with active force, in optimal lengths (a number > 1; default: 1.6)
    passive_force: twice the passive force at (1 + longest) / 2 optimal lengths, in peak forces (a
        number >= 0; default: 1.3)
    lengthening_force: active force of fast lengthening, in peak forces (a number >= 1; default:
        1.2)
    activation_time: time constant of activation (a number > 0 [s]; default: 0.01)
    deactivation_time: time constant of deactivation (a number > 0 [s]; default: 0.04)
    activation: at time 0 (a number 0 ... 1; default: 0.0)
    times: increasing times of the excitations; none for a constant (a list of numbers [s]; default:
        [])
    excitations: one per time; none: 0. The control excitation replaces them (a list of numbers 0
        ... 1; default: [])
    interpolation: of the values between their times; cubic: a smooth spline, which may overshoot
        the values and may start backwards; clamped: a spline with rate 0 at both ends; monotone:
        smooth, and within the range of the two values around a time ("linear", "cubic", "clamped",
        "monotone"; default: "linear")
    """

    _kind = "load"
    _type = "muscle"
    _keys = keys(
        "name cable force optimal_length body tendon_length max_speed shortest longest "
        "passive_force lengthening_force activation_time deactivation_time activation "
        "times excitations interpolation "
    )

    name: str
    cable: str
    force: float
    optimal_length: float
    body: Optional[BodyLike]
    tendon_length: Optional[float]
    max_speed: Optional[float]
    shortest: Optional[float]
    longest: Optional[float]
    passive_force: Optional[float]
    lengthening_force: Optional[float]
    activation_time: Optional[float]
    deactivation_time: Optional[float]
    activation: Optional[float]
    times: Optional[Sequence[float]]
    excitations: Optional[Sequence[float]]
    interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]

    def __init__(
        self,
        name: str,
        cable: str,
        force: float,
        optimal_length: float,
        *,
        body: Optional[BodyLike] = None,
        tendon_length: Optional[float] = None,
        max_speed: Optional[float] = None,
        shortest: Optional[float] = None,
        longest: Optional[float] = None,
        passive_force: Optional[float] = None,
        lengthening_force: Optional[float] = None,
        activation_time: Optional[float] = None,
        deactivation_time: Optional[float] = None,
        activation: Optional[float] = None,
        times: Optional[Sequence[float]] = None,
        excitations: Optional[Sequence[float]] = None,
        interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
    ) -> None:
        super().__init__(locals())


class Shape(Part):
    """A solid form."""

    _kind = "shape"


class Box(Shape):
    """Rectangular box about its centre.

    size: full edge lengths along x, y, z ([x, y, z], numbers > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "box"
    _keys = keys(
        "size position orientation density rotation "
    )

    size: Sequence[float]
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        size: Sequence[float],
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Sphere(Shape):
    """Solid ball about its centre.

    radius: radius (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "sphere"
    _keys = keys(
        "radius position orientation density rotation "
    )

    radius: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        radius: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Cylinder(Shape):
    """Solid cylinder about its centre, axis along z; the shape of a wheel.

    radius: radius (a number > 0 [m]; required)
    length: length along z (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "cylinder"
    _keys = keys(
        "radius length position orientation density rotation "
    )

    radius: float
    length: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        radius: float,
        length: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Capsule(Shape):
    """Cylinder along z with half balls at both ends, about its centre.

    radius: radius (a number > 0 [m]; required)
    length: length of the cylindrical part along z (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "capsule"
    _keys = keys(
        "radius length position orientation density rotation "
    )

    radius: float
    length: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        radius: float,
        length: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Cone(Shape):
    """Cone or frustum about z, its origin half way between the ends.

    radius: radius of the end at -z (a number > 0 [m]; required)
    length: length along z (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    top_radius: radius of the end at +z, other than `radius`; 0 is a tip (a number >= 0 [m];
        default: 0.0)
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "cone"
    _keys = keys(
        "radius length position orientation density top_radius rotation "
    )

    radius: float
    length: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    top_radius: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        radius: float,
        length: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        top_radius: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Torus(Shape):
    """Ring of round section about z.

    radius: radius of the circle in the middle of the tube (a number > 0 [m]; required)
    tube_radius: radius of the tube, below `radius` (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "torus"
    _keys = keys(
        "radius tube_radius position orientation density rotation "
    )

    radius: float
    tube_radius: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        radius: float,
        tube_radius: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Ellipsoid(Shape):
    """Solid ellipsoid about its centre.

    half_axes: half axes along x, y and z ([x, y, z], numbers > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "ellipsoid"
    _keys = keys(
        "half_axes position orientation density rotation "
    )

    half_axes: Sequence[float]
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        half_axes: Sequence[float],
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Prism(Shape):
    """Convex hull of an outline in the plane z = 0, extruded along z to both sides.

    outline: 3 to 4096 points [x, y, 0] whose convex hull is the cross-section (a list of [x, y, z],
        numbers [m]; required)
    length: length along z, half to each side of the plane z = 0 (a number > 0 [m]; required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "prism"
    _keys = keys(
        "outline length position orientation density rotation "
    )

    outline: Sequence[Sequence[float]]
    length: float
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        outline: Sequence[Sequence[float]],
        length: float,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Polyhedron(Shape):
    """Convex hull of points.

    points: 4 to 4096 points whose convex hull is the solid (a list of [x, y, z], numbers [m];
        required)
    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "polyhedron"
    _keys = keys(
        "points position orientation density rotation "
    )

    points: Sequence[Sequence[float]]
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        points: Sequence[Sequence[float]],
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class HalfSpace(Shape):
    """Everything beneath a plane through its origin, for static and kinematic bodies: a floor, a
    wall, a slope for colliders.

    position: origin of the shape in the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], shape frame to body frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    density: of this shape, in place of the body's; the body then has no mass of its own (a number >
        0 [kg/m3])
    normal: away from the solid side, shape frame; any length but 0 ([x, y, z], numbers; default:
        [0.0,1.0,0.0])
    rotation: the orientation as a turn in degrees; excludes orientation
    """

    _kind = "shape"
    _type = "half-space"
    _keys = keys(
        "position orientation density normal rotation "
    )

    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    density: Optional[float]
    normal: Optional[Sequence[float]]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]

    def __init__(
        self,
        *,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        density: Optional[float] = None,
        normal: Optional[Sequence[float]] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
    ) -> None:
        super().__init__(locals())


class Link(Part):
    """One contact of a cable with a body."""

    _kind = "link"


class AttachmentLink(Link):
    """The cable is fixed to a point of a body.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    point: where the cable is fixed, body frame (default its origin) ([x, y, z], numbers [m];
        default: [0.0,0.0,0.0])
    feed_speed: cable that comes out of the point (negative: goes in); at an end of the cable; 0: at
        a speed that is set later (a number [m/s])
    """

    _kind = "link"
    _type = "attachment"
    _keys = keys(
        "body point feed_speed "
    )

    body: BodyLike
    point: Optional[Sequence[float]]
    feed_speed: Optional[float]

    def __init__(
        self,
        body: BodyLike,
        *,
        point: Optional[Sequence[float]] = None,
        feed_speed: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class RollingLink(Link):
    """The cable runs over a wheel without slipping, or is wound onto it at a cable's end.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    winding: which way the cable runs round the wheel, seen against the plane's normal; or give side
        ("counter-clockwise", "clockwise")
    side: instead of winding: the side of the cable's way on which the wheel lies, seen against the
        normal (left: counter-clockwise), or the side on which the cable is shortest ("left",
        "right", "shortest")
    center: centre of the wheel, body frame; default: the centre of the body's first wheel-like
        shape, or of its first shape ([x, y, z], numbers [m])
    normal: normal of the cable's plane, body frame; default: that shape's z axis ([x, y, z],
        numbers)
    radius: of a circular wheel; default: that shape's radius, or without a wheel-like shape the
        hull of the section of all the body's shapes with the plane (a number > 0 [m])
    stored_length: cable wound on the wheel at time 0; required at the end of an open cable,
        elsewhere it follows from the tangents (a number >= 0 [m])
    friction: capstan coefficient: the cable slips when the ratio of the tensions passes e^(friction
        x wrap angle); default: no slip (a number >= 0)
    passes: directions in which cable slides over the wheel, relative to the body; needs friction;
        forward is from the cable's first link to its last; with one direction the wheel is a
        ratchet, which holds any tension in the other ("both", "forward", "backward"; default:
        "both")
    efficiency: of a rotor's bearing: tension of the cable that comes to it over that of the cable
        that goes from it, while it turns steadily; default: 1 (a number > 0 and <= 1)
    bending_loss: share of the tension that the rope loses by being bent onto the wheel and
        straightened again; only on a rotor, in place of efficiency (a number >= 0 and < 1; default:
        0.0)
    bearing_friction: coefficient of friction of the pin, whose load is the vector sum of the
        tensions and, if the wheel has a spin inertia, of its weight; only on a rotor, in place of
        efficiency (a number >= 0; default: 0.0)
    journal_radius: radius of the pin on which the wheel turns; needed with bearing_friction (a
        number > 0 [m])
    lifted: whether the cable passes the wheel by at time 0; it is wound on when it comes to touch
        it (true or false; default: false)
    turns: whole turns in addition to the arc between the tangents; an arc of more than 300 degrees
        without any is refused (an integer 0 ... 1000; default: 0)
    """

    _kind = "link"
    _type = "rolling"
    _keys = keys(
        "body winding side center normal radius stored_length friction passes efficiency "
        "bending_loss bearing_friction journal_radius lifted turns "
    )

    body: BodyLike
    winding: Optional[Literal["counter-clockwise", "clockwise"]]
    side: Optional[Literal["left", "right", "shortest"]]
    center: Optional[Sequence[float]]
    normal: Optional[Sequence[float]]
    radius: Optional[float]
    stored_length: Optional[float]
    friction: Optional[float]
    passes: Optional[Literal["both", "forward", "backward"]]
    efficiency: Optional[float]
    bending_loss: Optional[float]
    bearing_friction: Optional[float]
    journal_radius: Optional[float]
    lifted: Optional[bool]
    turns: Optional[int]

    def __init__(
        self,
        body: BodyLike,
        *,
        winding: Optional[Literal["counter-clockwise", "clockwise"]] = None,
        side: Optional[Literal["left", "right", "shortest"]] = None,
        center: Optional[Sequence[float]] = None,
        normal: Optional[Sequence[float]] = None,
        radius: Optional[float] = None,
        stored_length: Optional[float] = None,
        friction: Optional[float] = None,
        passes: Optional[Literal["both", "forward", "backward"]] = None,
        efficiency: Optional[float] = None,
        bending_loss: Optional[float] = None,
        bearing_friction: Optional[float] = None,
        journal_radius: Optional[float] = None,
        lifted: Optional[bool] = None,
        turns: Optional[int] = None,
    ) -> None:
        super().__init__(locals())


class PinholeLink(Link):
    """The cable slides through a point of a body, freely or with friction.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    point: where the hole is, body frame (default its origin) ([x, y, z], numbers [m]; default:
        [0.0,0.0,0.0])
    friction: capstan coefficient: the tensions on both sides differ by at most e^(friction x angle
        of deflection) (a number >= 0; default: 0.0)
    passes: directions in which cable slides through: forward is from the cable's first link to its
        last; with one direction the hole is a ratchet, which holds any tension in the other
        ("both", "forward", "backward"; default: "both")
    """

    _kind = "link"
    _type = "pinhole"
    _keys = keys(
        "body point friction passes "
    )

    body: BodyLike
    point: Optional[Sequence[float]]
    friction: Optional[float]
    passes: Optional[Literal["both", "forward", "backward"]]

    def __init__(
        self,
        body: BodyLike,
        *,
        point: Optional[Sequence[float]] = None,
        friction: Optional[float] = None,
        passes: Optional[Literal["both", "forward", "backward"]] = None,
    ) -> None:
        super().__init__(locals())


class HybridLink(Link):
    """An end of the cable is wound onto a round wheel until it is used up, then fixed to its rim.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    stored_length: cable wound on the wheel at time 0 (a number >= 0 [m]; required)
    winding: which way the cable runs round the wheel, seen against the plane's normal; or give side
        ("counter-clockwise", "clockwise")
    side: instead of winding: the side of the cable's way on which the wheel lies, seen against the
        normal (left: counter-clockwise), or the side on which the cable is shortest ("left",
        "right", "shortest")
    center: centre of the wheel, body frame; default: the centre of the body's first wheel-like
        shape, or of its first shape ([x, y, z], numbers [m])
    normal: normal of the cable's plane, body frame; default: that shape's z axis ([x, y, z],
        numbers)
    radius: of a circular wheel; default: that shape's radius, or without a wheel-like shape the
        hull of the section of all the body's shapes with the plane (a number > 0 [m])
    """

    _kind = "link"
    _type = "hybrid"
    _keys = keys(
        "body stored_length winding side center normal radius "
    )

    body: BodyLike
    stored_length: float
    winding: Optional[Literal["counter-clockwise", "clockwise"]]
    side: Optional[Literal["left", "right", "shortest"]]
    center: Optional[Sequence[float]]
    normal: Optional[Sequence[float]]
    radius: Optional[float]

    def __init__(
        self,
        body: BodyLike,
        stored_length: float,
        *,
        winding: Optional[Literal["counter-clockwise", "clockwise"]] = None,
        side: Optional[Literal["left", "right", "shortest"]] = None,
        center: Optional[Sequence[float]] = None,
        normal: Optional[Sequence[float]] = None,
        radius: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class SpoolLink(Link):
    """An end of the cable is wound onto a drum, in layers if it has a pitch, in a helical groove if
    it has a lead.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    stored_length: cable wound on the drum at time 0 (a number >= 0 [m]; required)
    winding: which way the cable runs round the wheel, seen against the plane's normal; or give side
        ("counter-clockwise", "clockwise")
    side: instead of winding: the side of the cable's way on which the wheel lies, seen against the
        normal (left: counter-clockwise), or the side on which the cable is shortest ("left",
        "right", "shortest")
    center: centre of the wheel, body frame; default: the centre of the body's first wheel-like
        shape, or of its first shape ([x, y, z], numbers [m])
    normal: normal of the cable's plane, body frame; default: that shape's z axis ([x, y, z],
        numbers)
    radius: of a circular wheel; default: that shape's radius, or without a wheel-like shape the
        hull of the section of all the body's shapes with the plane (a number > 0 [m])
    layer_pitch: growth of the drum's radius with every turn on it (a number >= 0 [m]; default: 0.0)
    lead: of a helical groove: way of the rope along the normal with every turn that is wound on;
        every second layer goes back; excludes layer_pitch (a number [m])
    turns_per_layer: turns with which a layer is full; default: one layer without end (a number >=
        1)
    layer_height: growth of the drum's radius with every layer; needed with turns_per_layer (a
        number > 0 [m])
    layers: layers that fit between the flanges; when they are full, the run has the event "full",
        and further layers follow; 0: any number (an integer 0 ... 10000; default: 0)
    groove_start: place of the rope along the normal, from the center, when nothing is stored;
        default: -lead turns_per_layer / 2, and 0 without turns_per_layer (a number [m])
    most_fleet_angle: angle of the rope to the plane of the drum above which the run warns (a number
        > 0 [rad])
    """

    _kind = "link"
    _type = "spool"
    _keys = keys(
        "body stored_length winding side center normal radius layer_pitch lead "
        "turns_per_layer layer_height layers groove_start most_fleet_angle "
    )

    body: BodyLike
    stored_length: float
    winding: Optional[Literal["counter-clockwise", "clockwise"]]
    side: Optional[Literal["left", "right", "shortest"]]
    center: Optional[Sequence[float]]
    normal: Optional[Sequence[float]]
    radius: Optional[float]
    layer_pitch: Optional[float]
    lead: Optional[float]
    turns_per_layer: Optional[float]
    layer_height: Optional[float]
    layers: Optional[int]
    groove_start: Optional[float]
    most_fleet_angle: Optional[float]

    def __init__(
        self,
        body: BodyLike,
        stored_length: float,
        *,
        winding: Optional[Literal["counter-clockwise", "clockwise"]] = None,
        side: Optional[Literal["left", "right", "shortest"]] = None,
        center: Optional[Sequence[float]] = None,
        normal: Optional[Sequence[float]] = None,
        radius: Optional[float] = None,
        layer_pitch: Optional[float] = None,
        lead: Optional[float] = None,
        turns_per_layer: Optional[float] = None,
        layer_height: Optional[float] = None,
        layers: Optional[int] = None,
        groove_start: Optional[float] = None,
        most_fleet_angle: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class SurfaceLink(Link):
    """The cable lies on a ball, a cylinder, a capsule, a cone, a torus or an ellipsoid along a
    geodesic, and slides over it.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    winding: side on which the cable passes the body: which way it runs round the normal; or give
        side, or side_point ("counter-clockwise", "clockwise")
    side: instead of winding: the side of the cable's way on which the body lies, seen against the
        normal (left: counter-clockwise) ("left", "right")
    normal: direction from which the winding is seen, body frame; default: the z axis of the body's
        shape ([x, y, z], numbers)
    side_point: point outside the shape, body frame, on whose side the cable passes the body at time
        0; of a torus it selects the place, too ([x, y, z], numbers [m])
    friction: capstan coefficient along the cable; nothing holds the cable sideways (a number >= 0;
        default: 0.0)
    shape: which of the body's shapes, from 0: a sphere, a cylinder, a capsule, a cone, a torus or
        an ellipsoid (an integer 0 ... 4095; default: 0)
    lifted: whether the cable passes the body by at time 0; it is laid on when it comes to touch it
        (true or false; default: false)
    """

    _kind = "link"
    _type = "surface"
    _keys = keys(
        "body winding side normal side_point friction shape lifted "
    )

    body: BodyLike
    winding: Optional[Literal["counter-clockwise", "clockwise"]]
    side: Optional[Literal["left", "right"]]
    normal: Optional[Sequence[float]]
    side_point: Optional[Sequence[float]]
    friction: Optional[float]
    shape: Optional[int]
    lifted: Optional[bool]

    def __init__(
        self,
        body: BodyLike,
        *,
        winding: Optional[Literal["counter-clockwise", "clockwise"]] = None,
        side: Optional[Literal["left", "right"]] = None,
        normal: Optional[Sequence[float]] = None,
        side_point: Optional[Sequence[float]] = None,
        friction: Optional[float] = None,
        shape: Optional[int] = None,
        lifted: Optional[bool] = None,
    ) -> None:
        super().__init__(locals())


class SheathLink(Link):
    """The cable slides through a sheath along a curve of a body, with friction all along it: a
    Bowden cable.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    points: the curve from the cable's entry to its exit, body frame; the two ends are enough with
        length and bend (a list of [x, y, z], numbers [m]; required)
    exit_body: the body that holds the exit, with the last point in its frame; default: the link's
        body (the name of a body, or "world")
    length: of the curve, at least the distance of its ends; default: that of the points (a number >
        0 [m])
    bend: sum of the angles by which the curve bends the cable, even along the length; default: that
        at the points (a number >= 0 [rad])
    friction: Coulomb's coefficient along the sheath: the tensions at both ends differ by at most
        e^(friction x bend); friction x bend is at most 50 (a number >= 0; default: 0.0)
    """

    _kind = "link"
    _type = "sheath"
    _keys = keys(
        "body points exit_body length bend friction "
    )

    body: BodyLike
    points: Sequence[Sequence[float]]
    exit_body: Optional[BodyLike]
    length: Optional[float]
    bend: Optional[float]
    friction: Optional[float]

    def __init__(
        self,
        body: BodyLike,
        points: Sequence[Sequence[float]],
        *,
        exit_body: Optional[BodyLike] = None,
        length: Optional[float] = None,
        bend: Optional[float] = None,
        friction: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class OpeningLink(Link):
    """The cable passes the inside of a ball or a cylinder, freely and by the shortest way.

    body: the body the cable touches, or "world" (the name of a body, or "world"; required)
    shape: which of the body's shapes, from 0: a sphere or a cylinder (an integer 0 ... 4095;
        default: 0)
    """

    _kind = "link"
    _type = "opening"
    _keys = keys(
        "body shape "
    )

    body: BodyLike
    shape: Optional[int]

    def __init__(
        self,
        body: BodyLike,
        *,
        shape: Optional[int] = None,
    ) -> None:
        super().__init__(locals())


class Step(Part):
    """How the scene is stepped through time.

    preset: source of settings that are not given; standard: the defaults below; paper:
        gauss-seidel, xpbd, dt 1/60 s, substeps 1, iterations 10, as in "Cable Joints" (2018)
        ("standard", "paper"; default: "standard")
    dt: time per step, one frame (a number > 0 [s]; default: 0.016666666666666666)
    substeps: substeps per step (an integer 1 ... 100000; default: 4)
    iterations: sweeps over all constraint rows per substep; for the direct solver, the most rounds
        (an integer 1 ... 1000000; default: 50)
    solver: gauss-seidel: row after row as in the paper, rough unless there are many iterations;
        direct: all rows at once, for more than a few wheels, light wheels, large mass ratios or
        accurate results (bench/SOLVERS.md) ("gauss-seidel", "direct"; default: "direct")
    integrator: xpbd: as in the paper, of first order, with numerical damping that grows with the
        step; rattle: of second order, conserves energy ("xpbd", "rattle"; default: "rattle")
    tolerance: in place of substeps: the error of positions that one second of motion may add; the
        lengths of substeps follow from it, also at events; needs direct and rattle; 0: fixed
        substeps (a number >= 0 [m]; default: 0.0)
    """

    _kind = "step"
    _keys = keys(
        "preset dt substeps iterations solver integrator tolerance "
    )

    preset: Optional[Literal["standard", "paper"]]
    dt: Optional[float]
    substeps: Optional[int]
    iterations: Optional[int]
    solver: Optional[Literal["gauss-seidel", "direct"]]
    integrator: Optional[Literal["xpbd", "rattle"]]
    tolerance: Optional[float]

    def __init__(
        self,
        *,
        preset: Optional[Literal["standard", "paper"]] = None,
        dt: Optional[float] = None,
        substeps: Optional[int] = None,
        iterations: Optional[int] = None,
        solver: Optional[Literal["gauss-seidel", "direct"]] = None,
        integrator: Optional[Literal["xpbd", "rattle"]] = None,
        tolerance: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Body(Part):
    """A rigid body.

    name: unique name, not "world" (a string; required)
    mobility: which motions the body has; knot: ends of cables meet ("static", "free", "planar",
        "slider", "rotor", "kinematic", "knot"; default: "free")
    axis: planar: normal (default z); slider: direction (required); rotor: axle (default the body's
        own z axis); kinematic: normal of the plane that the body keeps ([x, y, z], numbers)
    mount: rotor: the body that carries the axle; none: the axle does not move (the name of a body,
        or "world")
    position: origin of the body frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    orientation: unit quaternion [w, x, y, z], body frame to world frame (a unit quaternion [w, x,
        y, z]; default: [1.0,0.0,0.0,0.0])
    velocity: of the body frame's origin ([x, y, z], numbers [m/s]; default: [0.0,0.0,0.0])
    angular_velocity: absolute, also for a mounted rotor ([x, y, z], numbers [rad/s]; default:
        [0.0,0.0,0.0])
    mass: excludes density; the shapes share it by their volumes, overlaps counted twice, which
        places the centre of mass; without shapes that is the body's origin (a number > 0 [kg])
    density: mass and inertia follow from the shapes; excludes mass (a number > 0 [kg/m3])
    center_of_mass: in the body frame, with mass and inertia; default: from the shapes ([x, y, z],
        numbers [m])
    inertia: moments Ixx, Iyy, Izz about the centre of mass and the body's x, y, z axes; default:
        from the shapes, scaled to the mass ([x, y, z], numbers > 0 [kg m2])
    products_of_inertia: entries Ixy, Ixz, Iyz of the inertia tensor, Ixy = -(integral of x y dm),
        about the centre of mass; with inertia ([x, y, z], numbers [kg m2]; default: [0.0,0.0,0.0])
    spin_inertia: rotor: moment of inertia about the axle, in place of that of the shapes; 0: a
        massless wheel (a number >= 0 [kg m2])
    drive: rotor: quantity that drive_values prescribe about the axis; for a mounted rotor relative
        to the carrier, which takes the opposite torque ("none", "speed", "angle", "torque";
        default: "none")
    drive_times: increasing times of the drive's values; none for one constant value (a list of
        numbers [s]; default: [])
    drive_values: values of the drive, one per time (a list of numbers [rad/s, rad or N m]; default:
        [])
    drive_interpolation: of the values between their times; cubic: a smooth spline, which may
        overshoot the values and may start backwards; clamped: a spline with rate 0 at both ends;
        monotone: smooth, and within the range of the two values around a time ("linear", "cubic",
        "clamped", "monotone"; default: "linear")
    wrappable: whether cables that come against the body are wrapped round it (true or false;
        default: false)
    force: constant, at the centre of mass ([x, y, z], numbers [N]; default: [0.0,0.0,0.0])
    torque: constant ([x, y, z], numbers [N m]; default: [0.0,0.0,0.0])
    damping: drag: force per velocity; free, planar and slider bodies (a number >= 0 [N s/m];
        default: 0.0)
    angular_damping: torque per angular velocity; free and planar bodies and rotors on fixed axles
        (a number >= 0 [N m s/rad]; default: 0.0)
    oscillation: kinematic: amplitude A of the motion position + velocity t + A (sin(2 pi f t + p) -
        sin p) ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    oscillation_frequency: kinematic: frequency f of the oscillation (a number >= 0 [Hz]; default:
        0.0)
    oscillation_phase: kinematic: phase p of the oscillation (a number [rad]; default: 0.0)
    relative_to: the body whose frame position, orientation (or rotation) and axis refer to; in
        scene files (the name of a body, or "world")
    rotation: the orientation as a turn in degrees; excludes orientation
    shape: the body's form, if it is one shape; excludes shapes
    shapes: the body's form, if it is several shapes
    """

    _kind = "body"
    _keys = keys(
        "name mobility axis mount position orientation velocity angular_velocity mass "
        "density center_of_mass inertia products_of_inertia spin_inertia drive "
        "drive_times drive_values drive_interpolation wrappable force torque damping "
        "angular_damping oscillation oscillation_frequency oscillation_phase relative_to "
        "rotation shape shapes "
    )

    name: str
    mobility: Optional[Literal["static", "free", "planar", "slider", "rotor", "kinematic", "knot"]]
    axis: Optional[Sequence[float]]
    mount: Optional[BodyLike]
    position: Optional[Sequence[float]]
    orientation: Optional[Sequence[float]]
    velocity: Optional[Sequence[float]]
    angular_velocity: Optional[Sequence[float]]
    mass: Optional[float]
    density: Optional[float]
    center_of_mass: Optional[Sequence[float]]
    inertia: Optional[Sequence[float]]
    products_of_inertia: Optional[Sequence[float]]
    spin_inertia: Optional[float]
    drive: Optional[Literal["none", "speed", "angle", "torque"]]
    drive_times: Optional[Sequence[float]]
    drive_values: Optional[Sequence[float]]
    drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]]
    wrappable: Optional[bool]
    force: Optional[Sequence[float]]
    torque: Optional[Sequence[float]]
    damping: Optional[float]
    angular_damping: Optional[float]
    oscillation: Optional[Sequence[float]]
    oscillation_frequency: Optional[float]
    oscillation_phase: Optional[float]
    relative_to: Optional[BodyLike]
    rotation: Optional[Union[Rotation, Mapping[str, Any]]]
    shape: Optional[Union[Shape, Mapping[str, Any]]]
    shapes: Optional[Sequence[Union[Shape, Mapping[str, Any]]]]

    def __init__(
        self,
        name: str,
        *,
        mobility: Optional[Literal["static", "free", "planar", "slider", "rotor", "kinematic", "knot"]] = None,
        axis: Optional[Sequence[float]] = None,
        mount: Optional[BodyLike] = None,
        position: Optional[Sequence[float]] = None,
        orientation: Optional[Sequence[float]] = None,
        velocity: Optional[Sequence[float]] = None,
        angular_velocity: Optional[Sequence[float]] = None,
        mass: Optional[float] = None,
        density: Optional[float] = None,
        center_of_mass: Optional[Sequence[float]] = None,
        inertia: Optional[Sequence[float]] = None,
        products_of_inertia: Optional[Sequence[float]] = None,
        spin_inertia: Optional[float] = None,
        drive: Optional[Literal["none", "speed", "angle", "torque"]] = None,
        drive_times: Optional[Sequence[float]] = None,
        drive_values: Optional[Sequence[float]] = None,
        drive_interpolation: Optional[Literal["linear", "cubic", "clamped", "monotone"]] = None,
        wrappable: Optional[bool] = None,
        force: Optional[Sequence[float]] = None,
        torque: Optional[Sequence[float]] = None,
        damping: Optional[float] = None,
        angular_damping: Optional[float] = None,
        oscillation: Optional[Sequence[float]] = None,
        oscillation_frequency: Optional[float] = None,
        oscillation_phase: Optional[float] = None,
        relative_to: Optional[BodyLike] = None,
        rotation: Optional[Union[Rotation, Mapping[str, Any]]] = None,
        shape: Optional[Union[Shape, Mapping[str, Any]]] = None,
        shapes: Optional[Sequence[Union[Shape, Mapping[str, Any]]]] = None,
    ) -> None:
        super().__init__(locals())


class Cable(Part):
    """A cable: an ordered list of links.

    name: unique name (a string; required)
    closed: a last span joins the last link and the first: a belt (true or false; default: false)
    compliance: of each span whatever its length, also of those that a touched body divides; 0
        (default) is rigid; excludes axial_stiffness (a number >= 0 [m/N])
    axial_stiffness: EA of the cable's material; a span then has the compliance rest length / EA,
        and cable comes onto wheels with its strain (a number > 0 [N])
    strain_table: strains of a table of tensions, rising from 0; instead of axial_stiffness (a list
        of numbers >= 0; default: [])
    tension_table: tension at each of these strains, rising from 0; between the points a smooth
        rising curve, beyond the last one along its tangent (a list of numbers >= 0 [N]; default:
        [])
    unloading_stiffness: slope of the line on which a rope with a table is let off and stretched
        again: it yields, and keeps the strain at which this line reaches the tension 0 (a number >
        0 [N])
    unloading_table: tensions of a rope that is let off, at the strains of strain_table; at most
        those of tension_table (a list of numbers >= 0 [N]; default: [])
    transition_strain: strain over which a rope with unloading_table goes from one curve to the
        other where it turns (a number > 0)
    damping: of each span whatever its length; needs an elastic cable (a number >= 0 [N s/m];
        default: 0.0)
    axial_damping: of the cable's material: tension per rate of strain; a span of rest length L has
        a damper of axial_damping / L; needs axial_stiffness or tension_table, and no friction where
        cable slides over an arc (a number >= 0 [N s]; default: 0.0)
    linear_density: mass per unstretched length; the rope then has weight, and spans hang as
        catenaries, also between pinholes, and wheels and drums in a vertical plane; needs
        axial_stiffness (a number >= 0 [kg/m]; default: 0.0)
    axial_inertia: the mass of linear_density also has inertia, so that rope that runs has momentum
        and kinetic energy; between attachments, wheels with inertia and drums (true or false;
        default: false)
    floor: height of a level floor above the origin, against gravity, on which the rope lies where
        it would hang below it; needs linear_density; default: none (a number [m])
    floor_friction: coefficient of friction of the floor along the rope that lies between an anchor,
        an attachment at an end of the cable that stays in its place on the floor, and the next
        link; needs floor (a number 0 ... 10; default: 0.0)
    tangent_update: when tangents and rest lengths follow the bodies; substep is the paper's, for
        cables that stay on circles in one plane ("iteration", "substep"; default: "iteration")
    rest_lengths: of each span at time 0; default: its length, so that the cable is just taut (a
        list of numbers > 0 [m]; default: [])
    pretension: tension of all spans at time 0, instead of rest_lengths, which follow from it; needs
        an elastic cable (a number > 0 [N])
    pretensions: the same, of each span (a list of numbers >= 0 [N]; default: [])
    wrap_friction: capstan coefficient on wrappable bodies that the cable comes to touch (a number
        >= 0; default: 0.0)
    most_wraps: on how many wrappable bodies it can lie at the same time; 0: it goes through them
        (an integer 0 ... 1000; default: 16)
    breaking_tension: tension at which it breaks; default: never (a number > 0 [N])
    cut_time: when it is cut; default: never (a number >= 0 [s])
    links: contacts of the cable with bodies, in order; at least 2
    """

    _kind = "cable"
    _keys = keys(
        "name closed compliance axial_stiffness strain_table tension_table "
        "unloading_stiffness unloading_table transition_strain damping axial_damping "
        "linear_density axial_inertia floor floor_friction tangent_update rest_lengths "
        "pretension pretensions wrap_friction most_wraps breaking_tension cut_time links "
    )

    name: str
    closed: Optional[bool]
    compliance: Optional[float]
    axial_stiffness: Optional[float]
    strain_table: Optional[Sequence[float]]
    tension_table: Optional[Sequence[float]]
    unloading_stiffness: Optional[float]
    unloading_table: Optional[Sequence[float]]
    transition_strain: Optional[float]
    damping: Optional[float]
    axial_damping: Optional[float]
    linear_density: Optional[float]
    axial_inertia: Optional[bool]
    floor: Optional[float]
    floor_friction: Optional[float]
    tangent_update: Optional[Literal["iteration", "substep"]]
    rest_lengths: Optional[Sequence[float]]
    pretension: Optional[float]
    pretensions: Optional[Sequence[float]]
    wrap_friction: Optional[float]
    most_wraps: Optional[int]
    breaking_tension: Optional[float]
    cut_time: Optional[float]
    links: Optional[Sequence[Union[Link, Mapping[str, Any]]]]

    def __init__(
        self,
        name: str,
        *,
        closed: Optional[bool] = None,
        compliance: Optional[float] = None,
        axial_stiffness: Optional[float] = None,
        strain_table: Optional[Sequence[float]] = None,
        tension_table: Optional[Sequence[float]] = None,
        unloading_stiffness: Optional[float] = None,
        unloading_table: Optional[Sequence[float]] = None,
        transition_strain: Optional[float] = None,
        damping: Optional[float] = None,
        axial_damping: Optional[float] = None,
        linear_density: Optional[float] = None,
        axial_inertia: Optional[bool] = None,
        floor: Optional[float] = None,
        floor_friction: Optional[float] = None,
        tangent_update: Optional[Literal["iteration", "substep"]] = None,
        rest_lengths: Optional[Sequence[float]] = None,
        pretension: Optional[float] = None,
        pretensions: Optional[Sequence[float]] = None,
        wrap_friction: Optional[float] = None,
        most_wraps: Optional[int] = None,
        breaking_tension: Optional[float] = None,
        cut_time: Optional[float] = None,
        links: Optional[Sequence[Union[Link, Mapping[str, Any]]]] = None,
    ) -> None:
        super().__init__(locals())


class Collider(Part):
    """Makes a body touch others, with the shapes it has.

    body: a body with at least one shape (the name of a body, or "world"; required)
    friction: coefficient while sliding; of a pair the geometric mean (a number >= 0; default: 0.0)
    static_friction: coefficient while sticking (default: friction) (a number >= 0)
    restitution: separation speed over approach speed; of a pair the larger one. Rigid bodies do not
        rebound if they approach more slowly than the speed that gravity gives them in two substeps.
        A compliant contact has a damper for this ratio, which is critical below 0.135 (a number 0
        ... 1; default: 0.0)
    compliance: of each point of contact; of a pair the sum; 0 is rigid (a number >= 0 [m/N];
        default: 0.0)
    groups: groups to which the collider belongs, names of your choice (a list of strings; default:
        [])
    ignores: groups whose members the collider does not touch (a list of strings; default: [])
    """

    _kind = "collider"
    _keys = keys(
        "body friction static_friction restitution compliance groups ignores "
    )

    body: BodyLike
    friction: Optional[float]
    static_friction: Optional[float]
    restitution: Optional[float]
    compliance: Optional[float]
    groups: Optional[Sequence[str]]
    ignores: Optional[Sequence[str]]

    def __init__(
        self,
        body: BodyLike,
        *,
        friction: Optional[float] = None,
        static_friction: Optional[float] = None,
        restitution: Optional[float] = None,
        compliance: Optional[float] = None,
        groups: Optional[Sequence[str]] = None,
        ignores: Optional[Sequence[str]] = None,
    ) -> None:
        super().__init__(locals())


class Ground(Part):
    """A flat immovable floor.

    point: any point of the floor ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
    normal: away from the solid side (default y) ([x, y, z], numbers; default: [0.0,1.0,0.0])
    """

    _kind = "ground"
    _keys = keys(
        "point normal "
    )

    point: Optional[Sequence[float]]
    normal: Optional[Sequence[float]]

    def __init__(
        self,
        *,
        point: Optional[Sequence[float]] = None,
        normal: Optional[Sequence[float]] = None,
    ) -> None:
        super().__init__(locals())


class Trigger(Part):
    """Acts at a time or once a condition holds.

    name: unique name among the triggers (a string; required)
    action: set: a control to value; clear: the control gets the value of the scene again; release:
        a joint holds nothing any more; lock: a joint that was released or has broken holds again,
        from the present poses of its bodies; cut: a cable parts as soon as it pulls; on, off:
        switches a controller; stop: the run ends. A brake is applied, or fails, when the
        drive_limit of a drive to the speed 0 is set ("set", "clear", "release", "lock", "cut",
        "on", "off", "stop"; required)
    at: time at which it acts; the alternative is quantity with above or below (a number >= 0 [s])
    quantity: an observable or an expression; no observable on request that is known of the last
        substep only (a string; default: "")
    above: it acts once the quantity is above this value, in the quantity's unit (a number)
    below: it acts once the quantity is below this value, in the quantity's unit (a number)
    repeats: whether it acts every time, and not only the first time (true or false; default: false)
    target: the control, joint, cable or controller (a string; default: "")
    value: value of the control for set, in the control's unit (a number)
    place: of cut: where, as the unstretched length from the cable's first link on, in a free span;
        the cable then needs no tension. Default: in the span with the largest tension (a number > 0
        [m])
    over: time that a drive or a feed takes to reach the value; default: an angle or a position in a
        substep, any other value at once (a number >= 0 [s]; default: 0.0)
    """

    _kind = "trigger"
    _keys = keys(
        "name action at quantity above below repeats target value place over "
    )

    name: str
    action: Literal["set", "clear", "release", "lock", "cut", "on", "off", "stop"]
    at: Optional[float]
    quantity: Optional[str]
    above: Optional[float]
    below: Optional[float]
    repeats: Optional[bool]
    target: Optional[str]
    value: Optional[float]
    place: Optional[float]
    over: Optional[float]

    def __init__(
        self,
        name: str,
        action: Literal["set", "clear", "release", "lock", "cut", "on", "off", "stop"],
        *,
        at: Optional[float] = None,
        quantity: Optional[str] = None,
        above: Optional[float] = None,
        below: Optional[float] = None,
        repeats: Optional[bool] = None,
        target: Optional[str] = None,
        value: Optional[float] = None,
        place: Optional[float] = None,
        over: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Camera(Part):
    """Where pictures are taken from.

    projection: how the world is mapped to the picture ("perspective", "orthographic"; default:
        "perspective")
    position: position of the eye; needs target; default: all bodies are in view ([x, y, z], numbers
        [m])
    target: point in the middle of the picture; needs position ([x, y, z], numbers [m])
    direction: to look along, with the distance chosen automatically; excludes position and target
        ([x, y, z], numbers)
    up: up in the picture; default: against gravity ([x, y, z], numbers)
    vertical_fov: perspective: full vertical opening angle (a number > 0 and < 3.141592653589793
        [rad])
    height: orthographic: height of the picture; needs position; default: all bodies are in view (a
        number > 0 [m])
    labels: write the tensions [N] beside the cables (true or false; default: false)
    joints: draw pins, rods and rails of the joints (true or false; default: true)
    axes: draw the directions of x, y and z in the corner of stills and films, as pages always do
        (true or false; default: false)
    time_line: write the duration beside the time in stills and films, and draw a line with a mark
        for the time, as pages always do (true or false; default: false)
    cable_radius: radius with which cables are drawn; default: by the size of the scene (a number >
        0 [m])
    tension_max: tension at the top of the colour scale; default: 98 % of the run's tensions are
        below it (a number > 0 [N])
    """

    _kind = "camera"
    _keys = keys(
        "projection position target direction up vertical_fov height labels joints axes "
        "time_line cable_radius tension_max "
    )

    projection: Optional[Literal["perspective", "orthographic"]]
    position: Optional[Sequence[float]]
    target: Optional[Sequence[float]]
    direction: Optional[Sequence[float]]
    up: Optional[Sequence[float]]
    vertical_fov: Optional[float]
    height: Optional[float]
    labels: Optional[bool]
    joints: Optional[bool]
    axes: Optional[bool]
    time_line: Optional[bool]
    cable_radius: Optional[float]
    tension_max: Optional[float]

    def __init__(
        self,
        *,
        projection: Optional[Literal["perspective", "orthographic"]] = None,
        position: Optional[Sequence[float]] = None,
        target: Optional[Sequence[float]] = None,
        direction: Optional[Sequence[float]] = None,
        up: Optional[Sequence[float]] = None,
        vertical_fov: Optional[float] = None,
        height: Optional[float] = None,
        labels: Optional[bool] = None,
        joints: Optional[bool] = None,
        axes: Optional[bool] = None,
        time_line: Optional[bool] = None,
        cable_radius: Optional[float] = None,
        tension_max: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class CameraKey(Part):
    """A pose of the camera at a time; the camera moves smoothly between two poses.

    time: time of the keyframe, after that of the one before (a number >= 0 [s]; required)
    position: position of the eye ([x, y, z], numbers [m]; required)
    target: point in the middle of the picture ([x, y, z], numbers [m]; required)
    up: up in the picture; default: that of the camera ([x, y, z], numbers)
    vertical_fov: perspective: full vertical opening angle; default: that of the camera (a number >
        0 and < 3.141592653589793 [rad])
    height: orthographic: height of the picture; required there (a number > 0 [m])
    """

    _kind = "camera key"
    _keys = keys(
        "time position target up vertical_fov height "
    )

    time: float
    position: Sequence[float]
    target: Sequence[float]
    up: Optional[Sequence[float]]
    vertical_fov: Optional[float]
    height: Optional[float]

    def __init__(
        self,
        time: float,
        position: Sequence[float],
        target: Sequence[float],
        *,
        up: Optional[Sequence[float]] = None,
        vertical_fov: Optional[float] = None,
        height: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Annotation(Part):
    """A text in pictures, films and pages.

    kind: title: upper left, in place of the scene's name; caption: below the machine; arrow: beside
        a point, with an arrow to it ("title", "caption", "arrow"; required)
    text: one line of at most 400 bytes; a long title or caption is broken between words (a string;
        required)
    body: arrow: the body with the point (the name of a body, or "world"; default: "world")
    point: arrow: the point, in the frame of the body ([x, y, z], numbers [m]; default:
        [0.0,0.0,0.0])
    from_: first time of the text (a number >= 0 [s]; default: 0.0)
    to: last time of the text; default: the end (a number >= 0 [s])
    """

    _kind = "annotation"
    _keys = keys(
        "kind text body point from_ to "
    )

    kind: Literal["title", "caption", "arrow"]
    text: str
    body: Optional[BodyLike]
    point: Optional[Sequence[float]]
    from_: Optional[float]
    to: Optional[float]

    def __init__(
        self,
        kind: Literal["title", "caption", "arrow"],
        text: str,
        *,
        body: Optional[BodyLike] = None,
        point: Optional[Sequence[float]] = None,
        from_: Optional[float] = None,
        to: Optional[float] = None,
    ) -> None:
        super().__init__(locals())


class Paint(Part):
    """The colour of a body in pictures.

    body: body to be painted, once at most (the name of a body, or "world"; required)
    color: red, green and blue as on a screen (sRGB) ([x, y, z], numbers 0 ... 1; required)
    """

    _kind = "paint"
    _keys = keys(
        "body color "
    )

    body: BodyLike
    color: Sequence[float]

    def __init__(
        self,
        body: BodyLike,
        color: Sequence[float],
    ) -> None:
        super().__init__(locals())


class Check(Part):
    """A value that the scene should show, with a tolerance.

    quantity: an observable, as in the columns of a CSV file, or an expression (a string; required)
    equals: the right value, in the observable's unit (per second for a rate, times seconds for an
        integral) (a number; required)
    statistic: at: value at the step nearest to the time at; mean, minimum, maximum: of the values
        at the ends of the steps in the window; rate: (last - first value) / time between them;
        range: maximum - minimum; drift: last - first value; integral: by the trapezium rule, a
        power's is work ("at", "mean", "rate", "minimum", "maximum", "range", "drift", "integral";
        default: "at")
    at: time for the statistic at; default: the end (a number >= 0 [s])
    from_: start of the window of all other statistics; default: 0 (a number >= 0 [s])
    to: end of that window; default: the end (a number >= 0 [s])
    tolerance: largest error that passes, in the same unit (a number >= 0)
    relative_tolerance: the same as a fraction of |equals|; of the two tolerances the larger counts,
        and one must be given (a number >= 0)
    because: the closed form, as a text (a string; default: "")
    """

    _kind = "check"
    _keys = keys(
        "quantity equals statistic at from_ to tolerance relative_tolerance because "
    )

    quantity: str
    equals: float
    statistic: Optional[Literal["at", "mean", "rate", "minimum", "maximum", "range", "drift", "integral"]]
    at: Optional[float]
    from_: Optional[float]
    to: Optional[float]
    tolerance: Optional[float]
    relative_tolerance: Optional[float]
    because: Optional[str]

    def __init__(
        self,
        quantity: str,
        equals: float,
        *,
        statistic: Optional[Literal["at", "mean", "rate", "minimum", "maximum", "range", "drift", "integral"]] = None,
        at: Optional[float] = None,
        from_: Optional[float] = None,
        to: Optional[float] = None,
        tolerance: Optional[float] = None,
        relative_tolerance: Optional[float] = None,
        because: Optional[str] = None,
    ) -> None:
        super().__init__(locals())


class Parameter(Part):
    """A named number that expressions may use, and --param sets.

    name: a word of letters, digits and _ that begins with a letter, and is no word of expressions;
        unique among the parameters (a string; required)
    value: the number, in its unit (a number; required)
    unit: made of m, kg, s, rad, N, J, W and Hz, as N m or m/s2; default: a pure number (a string;
        default: "")
    meaning: for readers (a string; default: "")
    """

    _kind = "parameter"
    _keys = keys(
        "name value unit meaning "
    )

    name: str
    value: float
    unit: Optional[str]
    meaning: Optional[str]

    def __init__(
        self,
        name: str,
        value: float,
        *,
        unit: Optional[str] = None,
        meaning: Optional[str] = None,
    ) -> None:
        super().__init__(locals())


class Rotation(Part):
    """A turn about an axis, in degrees.

    degrees: by how much, counter-clockwise seen against the axis (a number; required)
    axis: of the turn, of any length but 0 ([x, y, z], numbers; default: [0.0,0.0,1.0])
    """

    _kind = "rotation"
    _keys = keys(
        "degrees axis "
    )

    degrees: float
    axis: Optional[Sequence[float]]

    def __init__(
        self,
        degrees: float,
        *,
        axis: Optional[Sequence[float]] = None,
    ) -> None:
        super().__init__(locals())


__all__ = [
    "Annotation",
    "AttachmentLink",
    "BallJoint",
    "BangBangController",
    "Body",
    "Box",
    "Cable",
    "Camera",
    "CameraKey",
    "Capsule",
    "Check",
    "Collider",
    "Cone",
    "Controller",
    "CouplingJoint",
    "Cylinder",
    "CylindricalJoint",
    "DistanceJoint",
    "Ellipsoid",
    "FixedJoint",
    "ForceLoad",
    "GearJoint",
    "Ground",
    "HalfSpace",
    "HingeJoint",
    "HybridLink",
    "Joint",
    "Link",
    "Load",
    "MotionLoad",
    "MuscleLoad",
    "OpeningLink",
    "Paint",
    "Parameter",
    "PidController",
    "PinholeLink",
    "PlaneJoint",
    "Polyhedron",
    "Prism",
    "RackJoint",
    "RollingLink",
    "Rotation",
    "Shape",
    "SheathLink",
    "SliderJoint",
    "Sphere",
    "SpoolLink",
    "Step",
    "SurfaceLink",
    "Torus",
    "Trigger",
    "UniversalJoint",
    "WindLoad",
]
