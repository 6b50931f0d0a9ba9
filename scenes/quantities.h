#pragma once
// The names, units and meanings of all observables, for ObservableSet and the documentation.

#include <array>

#include "scenes/observables.h"

namespace sheave {

inline constexpr std::array<Quantity, 14> body_quantities{{
    {"x", "m", "position of the body frame's origin"},
    {"y", "m", "the same"},
    {"z", "m", "the same"},
    {"qw", "", "orientation"},
    {"qx", "", "the same"},
    {"qy", "", "the same"},
    {"qz", "", "the same"},
    {"vx", "m/s", "velocity of the body frame's origin"},
    {"vy", "m/s", "the same"},
    {"vz", "m/s", "the same"},
    {"wx", "rad/s", "angular velocity"},
    {"wy", "rad/s", "the same"},
    {"wz", "rad/s", "the same"},
    {"angle", "rad",
     "angle turned about the axis: planar bodies and rotors; of a mounted rotor relative to its "
     "carrier"},
}};
inline constexpr std::array<Quantity, 5> span_quantities{{
    {"tension", "N", "of the free span that begins at a link, counted from 0"},
    {"length", "m", "the same"},
    {"rest_length", "m", "the same"},
    {"start_tension", "N",
     "the same, where the span begins; other than `tension` for ropes with weight only"},
    {"end_tension", "N", "the same, where the span ends"},
}};
inline constexpr std::array<Quantity, 9> link_quantities{{
    {"stored_length", "m", "cable on link k, counted from 0; unstretched"},
    {"wrap_angle", "rad", "wrap angle; for a pinhole the angle of deflection"},
    {"slip", "m", "cable that has slid over the surface of the link, which may turn, forwards"},
    {"entry_x", "m", "where the cable meets the link"},
    {"entry_y", "m", "the same"},
    {"entry_z", "m", "the same"},
    {"exit_x", "m", "where the cable leaves the link"},
    {"exit_y", "m", "the same"},
    {"exit_z", "m", "the same"},
}};
inline constexpr std::array<Quantity, 5> cable_quantities{{
    {"length_error", "", "relative error of the length invariant"},
    {"total_length", "m", "rest lengths and stored lengths together"},
    {"wraps", "", "number of wrappable bodies that the cable lies on"},
    {"wrapped_length", "m", "of it on these bodies, stretched as it lies there: the arcs"},
    {"cut", "", "1 when the cable has been cut or has broken, 0 before"},
}};
inline constexpr std::array<Quantity, 9> joint_quantities{{
    {"force", "N", "size of the joint's force on body_b in the last substep"},
    {"fx", "N", "its parts along the axes of the world"},
    {"fy", "N", "the same"},
    {"fz", "N", "the same"},
    {"torque", "N m", "size of its torque about body_b's anchor"},
    {"tx", "N m", "its parts along the axes of the world"},
    {"ty", "N m", "the same"},
    {"tz", "N m", "the same"},
    {"broken", "", "1 when the joint has broken, 0 before"},
}};
// "<coordinate>" stands for the names in JointDef::coordinates().
inline constexpr std::array<Quantity, 3> coordinate_quantities{{
    {"<coordinate>", "m, rad",
     "coordinates of the joint since time 0, angles with all turns: extension (distance), twist "
     "and swing (ball with an axis), angle (hinge, plane), travel (slider, coupling), travel "
     "and angle (cylindrical, rack), angle_a and angle_b (universal, gear)"},
    {"<coordinate>_rate", "m/s, rad/s", "rate of the coordinate"},
    {"drive_force", "N, N m",
     "of its drive; <coordinate>_drive_force where a joint has two coordinates"},
}};
inline constexpr std::array<Quantity, 2> muscle_quantities{{
    {"activation", "", "of a muscle, 0 to 1"},
    {"tension", "N", "of a muscle along its path, the mean over the last substep"},
}};
inline constexpr int muscle_tension = 1;  // in muscle_quantities
inline constexpr std::array<Quantity, 4> energy_quantities{{
    {"kinetic", "J", "of the whole scene"},
    {"potential", "J", "the same"},
    {"elastic", "J", "the same"},
    {"total", "J", "the same"},
}};

// On request.

inline constexpr std::array<Quantity, 6> momentum_quantities{{
    {"momentum_x", "kg m/s", "linear momentum, of a carrier with the rotors mounted on it"},
    {"momentum_y", "kg m/s", "the same"},
    {"momentum_z", "kg m/s", "the same"},
    {"angular_momentum_x", "kg m2/s",
     "angular momentum about its centre of mass; of a rotor that of its spin, which its carrier's "
     "is without"},
    {"angular_momentum_y", "kg m2/s", "the same"},
    {"angular_momentum_z", "kg m2/s", "the same"},
}};
inline constexpr std::array<Quantity, 8> bearing_quantities{{
    {"bearing_force", "N", "size of the force of its bearings on it in the last substep"},
    {"bearing_fx", "N", "its parts along the axes of the world"},
    {"bearing_fy", "N", "the same"},
    {"bearing_fz", "N", "the same"},
    {"bearing_torque", "N m", "size of their torque about its centre, which is across the axle"},
    {"bearing_tx", "N m", "its parts along the axes of the world"},
    {"bearing_ty", "N m", "the same"},
    {"bearing_tz", "N m", "the same"},
}};
inline constexpr std::array<Quantity, 3> body_drive_quantities{{
    {"drive_torque", "N m", "of its drive on the rotor in the last substep, about its axis"},
    {"drive_power", "W", "power of the drive on the rotor"},
    {"drive_error", "rad, rad/s",
     "deviation of the rotor from the target of its drive, an angle or a speed"},
}};
inline constexpr std::array<Quantity, 4> requested_span_quantities{{
    {"direction_x", "", "unit vector along the span, from its first link to its second"},
    {"direction_y", "", "the same"},
    {"direction_z", "", "the same"},
    {"floor_length", "m", "unstretched length of the span that lies on the `floor` of its cable"},
}};
inline constexpr std::array<Quantity, 1> link_friction_quantities{{
    {"friction_power", "W", "power that friction takes from the cable sliding over link k"},
}};
inline constexpr std::array<Quantity, 3> groove_quantities{{
    {"axial_position", "m", "place of the rope of a drum with a groove along the link's normal"},
    {"fleet_angle", "rad", "angle of its free rope to the plane of the drum, > 0 to the normal"},
    {"layer", "", "its layer in which the rope is wound, 1 on the drum itself"},
}};
inline constexpr std::array<Quantity, 3> memory_quantities{{
    {"permanent_stretch", "m", "length gained by a rope with unloading_stiffness"},
    {"hysteresis_loss", "J",
     "energy lost by a rope with unloading_stiffness or unloading_table since time 0"},
    {"floor_loss", "J", "energy lost by friction of a floor with floor_friction since time 0"},
}};
inline constexpr std::array<Quantity, 1> joint_friction_quantities{{
    {"friction_power", "W", "power that the joint's dry friction takes"},
}};
inline constexpr std::array<Quantity, 2> joint_drive_quantities{{
    {"drive_power", "W",
     "power of its drive; <coordinate>_drive_power where a joint has two coordinates"},
    {"drive_error", "m, rad, m/s, rad/s",
     "deviation of the coordinate from the target of a drive that is not at its limit; with the "
     "coordinate's "
     "name likewise"},
}};
inline constexpr std::array<Quantity, 2> fibre_quantities{{
    {"fibre_length", "",
     "L of a muscle: its path without `tendon_length`, over `optimal_length`; none when its cable "
     "is cut"},
    {"fibre_velocity", "",
     "V of a muscle: rate of its path, over `max_speed` times `optimal_length`; above 0 while it "
     "lengthens"},
}};
inline constexpr std::array<Quantity, 6> scene_momentum_quantities{{
    {"linear_x", "kg m/s", "of all bodies together"},
    {"linear_y", "kg m/s", "the same"},
    {"linear_z", "kg m/s", "the same"},
    {"angular_x", "kg m2/s", "of all bodies together, about the world's origin"},
    {"angular_y", "kg m2/s", "the same"},
    {"angular_z", "kg m2/s", "the same"},
}};
inline constexpr std::array<Quantity, 2> power_quantities{{
    {"drives", "W", "power of all drives in the last substep"},
    {"friction", "W",
     "power that dry friction takes in joints, in contacts and under cables that slide"},
}};

inline constexpr std::array<QuantityGroup, 8> quantity_group_table{{
    {"<body>.", body_quantities},
    {"<cable>.<span>.", span_quantities},
    {"<cable>.link<k>.", link_quantities},
    {"<cable>.", cable_quantities},
    {"<joint>.", joint_quantities},
    {"<joint>.", coordinate_quantities},
    {"<muscle>.", muscle_quantities},
    {"energy.", energy_quantities},
}};
inline constexpr std::array<QuantityGroup, 12> requested_group_table{{
    {"<body>.", momentum_quantities},
    {"<rotor>.", bearing_quantities},
    {"<driven rotor>.", body_drive_quantities},
    {"<cable>.<span>.", requested_span_quantities},
    {"<cable>.link<k>.", link_friction_quantities},
    {"<cable>.link<k>.", groove_quantities},
    {"<cable>.", memory_quantities},
    {"<joint>.", joint_friction_quantities},
    {"<joint>.", joint_drive_quantities},
    {"<muscle>.", fibre_quantities},
    {"momentum.", scene_momentum_quantities},
    {"power.", power_quantities},
}};

}  // namespace sheave
