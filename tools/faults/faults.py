"""The faults of tools/mutation-table, and the scenes that are run with them."""

from dataclasses import dataclass


@dataclass
class Fault:
    name: str
    what: str  # as a sentence's end: what has been changed
    changes: list  # (file, old text, new text); the old text occurs once
    units: list  # translation units that have it
    why_unseen: str = ""


def one(name, what, file, old, new, units=None, why=""):
    return Fault(name, what, [(file, old, new)], units or [file], why)


SPAN = ["cable/span_row.cpp"]
JOINTS = [f"engine/joints/{name}.cpp" for name in
          ("ball", "cylindrical", "distance", "fixed", "gear", "hinge", "plane", "rack", "slider", "universal")]

FAULTS = [
    # Spans.
    one("span-gradient", "a span pulls its second end with 0.9 of its first end's force", "cable/span_planar.h",
        "add_planar_force(substep, setup, second, -setup.second_radius, span.end, -span.direction, row);",
        "add_planar_force(substep, setup, second, -0.9 * setup.second_radius, span.end, -0.9 * span.direction, row);",
        SPAN),
    one("wheel-arm", "the arm of a span on its first wheel is 5 % short", "cable/span_planar.h",
        "add_planar_force(substep, setup, first, setup.first_radius, span.start,",
        "add_planar_force(substep, setup, first, 0.95 * setup.first_radius, span.start,", SPAN),
    one("transport-first", "no transport at a span's first end", "cable/span_planar.h",
        "transport.from_first = -setup.first_radius * own;", "transport.from_first = 0.0 * own;", SPAN),
    one("transport-second", "transport at a span's second end with the wrong sign", "cable/span_planar.h",
        "transport.from_second = setup.second_radius * own;", "transport.from_second = -setup.second_radius * own;",
        SPAN),
    one("transport-share", "transport 3 % too small at both ends", "cable/span_planar.h",
        "const double turn = unwrapped(\n", "const double turn = 0.97 * unwrapped(\n", SPAN),
    one("body-turn", "the turn of the second wheel counts 1.05 times", "cable/span_planar.h",
        "const double own = turn - dot(setup.normal, substep.moving[at(second.body)].turn);",
        "const double own = turn - 1.05 * dot(setup.normal, substep.moving[at(second.body)].turn);", SPAN),
    one("tangent-side", "tangents of crossing wheels with the wrong sign of a radius", "cable/span_geometry.h",
        "const double difference = signed_radius2 - signed_radius1;",
        "const double difference = signed_radius2 + signed_radius1;", SPAN + ["cable/span_geometry.cpp"]),
    Fault("skew-climb", "spans leave skew wheels at the radius of the rim",
          [("cable/span_geometry.cpp", "radius = circle.signed_radius / share;", "radius = circle.signed_radius;"),
           ("cable/span_geometry.cpp", "radius * std::sqrt(1.0 + off_plane * off_plane / seen_squared)", "radius")],
          ["cable/span_geometry.cpp"]),
    one("skew-transport", "transport on skew wheels 2 % too large", "cable/span_skew.cpp",
        "return std::abs(link.signed_radius) * turn +", "return 1.02 * std::abs(link.signed_radius) * turn +"),
    one("compliance-half", "elastic spans half as soft as they should be", "cable/cable_system.cpp",
        "return cable.compliance + cable.inverse_stiffness * std::max(rest_length, 0.0);",
        "return 0.5 * (cable.compliance + cable.inverse_stiffness * std::max(rest_length, 0.0));"),
    one("pushing-cable", "spans that also push", "cable/cable_system.cpp",
        "row.lower = 0.0;  // a cable pulls and never pushes", "row.lower = -Row::unbounded;"),
    Fault("tension-report", "tensions reported 2 % too small",
          [("cable/cable_system.cpp", "tension = multipliers_[at(k)] / (substep.h * substep.h);",
            "tension = 0.98 * multipliers_[at(k)] / (substep.h * substep.h);"),
           ("cable/cable_system.cpp", "tension = multipliers_[at(span)] / (substep.h * substep.h);",
            "tension = 0.98 * multipliers_[at(span)] / (substep.h * substep.h);")], ["cable/cable_system.cpp"]),
    one("affine-turn", "wheels give affine spans 0.95 of what they turn by", "cable/affine_span.h",
        "return dot(end.turn, substep.moving[static_cast<std::size_t>(end.wheel)].turn);",
        "return 0.95 * dot(end.turn, substep.moving[static_cast<std::size_t>(end.wheel)].turn);", ["cable/cable_system.cpp"]),
    one("affine-slide", "affine spans become longer by 0.9 of what slides", "cable/affine_span.h",
        "sum += dot(direction, position(substep, second));", "sum += 0.9 * dot(direction, position(substep, second));",
        ["cable/cable_system.cpp", "cable/cable_affine.cpp"]),
    one("affine-gradient", "the row of an affine span turns its wheels 10 % too far", "cable/cable_affine.cpp",
        "affine.direction = span.direction;",
        "affine.direction = span.direction;\n  affine.row.terms[0].angular *= 1.1;"),
    one("feed-sign", "feeds with the wrong sign", "cable/cable_ends.cpp",
        "first = links_[at(setup.first)].feed_speed * h;", "first = -links_[at(setup.first)].feed_speed * h;",
        why="what has been fed is reported with the same sign"),
    one("stored-lost", "half of what a wheel takes is not stored", "cable/cable_drives.cpp",
        "    stored -= moved[end];", "    stored -= 0.5 * moved[end];"),
    one("merge-loss", "what a wheel has stored is lost when the cable leaves it", "cable/cable_contacts.cpp",
        "rest_before += rest_after + stored;", "rest_before += rest_after;",
        why="when a cable leaves a wheel, next to nothing is stored there: the length that is lost is 1.4e-4 of the "
            "cable"),
    # Friction.
    one("capstan-exponent", "twice the exponent of friction at links", "cable/cable_friction.cpp",
        "return geometry.friction *\n", "return 2.0 * geometry.friction *\n"),
    one("capstan-direction", "links slip against the pull", "cable/cable_friction.cpp",
        "if (excess > held && !is_drained(cable, pieces_[start].run)) set_slip(start, i, 1);",
        "if (excess > held) set_slip(start, i, -1);"),
    one("capstan-sticks", "links that never begin to slip", "cable/cable_friction.cpp",
        "if (excess > held && !is_drained(cable, pieces_[start].run)) set_slip(start, i, 1);\n    "
        "if (-excess > held && !is_drained(cable, piece.run)) set_slip(start, i, -1);", ""),
    one("open-spans", "spans that only prescribed motion changes do not make their neighbours slip",
        "cable/cable_friction.cpp", "  serve_pieces(substep, first, last);\n  const auto decided",
        "  const auto decided"),
    one("open-tensions", "spans between immovable points keep what the solver leaves them", "cable/cable_held.cpp",
        "  collect_pieces(substep, cable);\n  hold_all(substep, cable, Held::reported);",
        "  if (true) return;\n  collect_pieces(substep, cable);\n  hold_all(substep, cable, Held::reported);"),
    one("open-idle", "a wheel that spins under a rope between immovable points is not braked by it", "cable/cable_runs.cpp",
        "const bool acts = open && turns_wheel(substep, cable, run);", "const bool acts = false && open;"),
    # Joints.
    one("hinge-lever", "joints pull body_a with 0.95 of what they pull body_b with", "engine/joints/lock_rows.h",
        "terms.set_value(dot(direction, at_a - at_b));\n  terms.add_force(a.body, at_a, direction);",
        "terms.set_value(dot(direction, at_a - at_b));\n  terms.add_force(a.body, at_a, 0.95 * direction);", JOINTS),
    one("offset-lever", "sliders push body_a at its own anchor, not at that of body_b", "engine/joints/lock_rows.h",
        "terms.set_value(dot(direction, at_b - a.position(terms.substep())));\n  terms.add_force(a.body, at_b, -direction);",
        "terms.set_value(dot(direction, at_b - a.position(terms.substep())));\n"
        "  terms.add_force(a.body, a.position(terms.substep()), -direction);", JOINTS),
    one("spring-start", "springs of joints relaxed elsewhere", "engine/joints/joint_effect.cpp",
        "case Kind::spring:\n      row.value = now - effect.at;", "case Kind::spring:\n      row.value = 0.9 * now - effect.at;"),
    one("damper", "dampers of joints twice as strong", "engine/joints/joint_effect.cpp",
        "row.compliance = substep.damper_compliance(effect.damping);",
        "row.compliance = 0.5 * substep.damper_compliance(effect.damping);"),
    one("drive-speed", "drives of joints 2 % slow", "engine/joints/joint_effect.cpp",
        "row.value = now - start - drive.integral(from, to);",
        "row.value = now - start - 0.98 * drive.integral(from, to);"),
    one("joint-friction", "dry friction of joints twice as large", "engine/joints/joint_effect.cpp",
        "if (settings.friction > 0.0) add(Kind::friction).limit = settings.friction;",
        "if (settings.friction > 0.0) add(Kind::friction).limit = 2.0 * settings.friction;"),
    one("friction-box", "friction of joints in several directions bounded along each by itself",
        "engine/joints/joint_effect.cpp", "effects[own].shares = count;", "effects[own].shares = 0;"),
    one("joint-stop", "stops of joints 0.05 too far", "engine/joints/joint_effect.cpp",
        "effect.at = *stop;", "effect.at = *stop * 1.1 + (*stop > 0.0 ? 0.05 : -0.05);"),
    one("gear-ratio", "gears with 1.02 times their ratio", "engine/joints/coupling.h",
        ".factor = -ratio,", ".factor = -1.02 * ratio,", ["engine/joints/gear.cpp", "engine/joints/rack.cpp"]),
    # Bodies and integrators.
    one("gravity", "gravity 2 % too weak for planar bodies' loads", "engine/integrators/xpbd.cpp",
        "body.mass * substep.gravity + force_on(substep, i, substep.start.bodies);",
        "0.98 * body.mass * substep.gravity + force_on(substep, i, substep.start.bodies);"),
    one("drag", "no drag of bodies", "engine/integrators/xpbd.cpp",
        "const double keep = decay(substep.bodies.definition(i).damping / body.mass, time).keep;",
        "const double keep = 1.0;"),
    one("angular-drag", "no drag of rotation", "engine/integrators/xpbd.cpp",
        "const auto [keep, gain] = decay(substep.bodies.definition(i).angular_damping / inertia,\n"
        "                                      substep.load_share * substep.h);",
        "const auto [keep, gain] = decay(0.0 / inertia, substep.load_share * substep.h);"),
    one("spin-inertia", "rotation about axes with 1.1 times the inertia", "engine/substep.cpp",
        "body.angular_yield = 1.0 / properties.axis_inertia;\n      break;\n    case Mobility::slider:",
        "body.angular_yield = 1.0 / (1.1 * properties.axis_inertia);\n      break;\n    case Mobility::slider:"),
    one("rotor-inertia", "wheels with 0.9 of their inertia", "engine/substep.cpp",
        "body.angular_yield = 1.0 / properties.axis_inertia;\n      }\n      break;",
        "body.angular_yield = 1.0 / (0.9 * properties.axis_inertia);\n      }\n      break;"),
    one("mounted-reaction", "carriers feel all of the torque about their rotors' axles", "engine/substep.cpp",
        "row.add(mount, direction, cross(arm, direction) - spin, dot(arm, direction));",
        "row.add(mount, direction, cross(arm, direction), dot(arm, direction));"),
    Fault("free-inertia", "free bodies that do not turn their inertia with them",
          [("engine/substep.cpp", ": turned_tensor(body.orientation, properties.inverse_inertia);",
            ": properties.inverse_inertia;"),
           ("engine/substep.cpp", "body.inverse_inertia = turned_tensor(body.orientation, properties.inverse_inertia);\n  }\n}",
            "body.inverse_inertia = properties.inverse_inertia;\n  }\n}")], ["engine/substep.cpp"]),
    one("gyroscopic", "no gyroscopic torque of a body's own spin", "engine/integrators/xpbd.cpp",
        "times_inertia(body, moving.orientation, true,\n                      momentum +",
        "times_inertia(body, start.orientation, true,\n                      momentum +"),
    one("precession", "bodies with an axis of symmetry precess 10 % too slowly", "engine/integrators/xpbd.cpp",
        "const Vector3 precession = across * momentum;", "const Vector3 precession = 0.9 * across * momentum;"),
    one("rattle-second-half", "rattle without the second half of the loads", "engine/integrators/rattle.cpp",
        "const double half = 0.5 * substep.h;\n  const double middle", "const double half = 1e-9 * substep.h;\n  const double middle"),
    one("rattle-tensions", "rattle forgets the forces of the second half in what it reports",
        "engine/solvers/row_velocities.cpp",
        "multipliers[at(rows_[i].index)] = previous_[i] + substep.h * impulse;",
        "multipliers[at(rows_[i].index)] = previous_[i];"),
    one("rattle-impulses", "rattle does not apply impulses of the velocities", "engine/solvers/row_velocities.cpp",
        "if (!group.elastic) slots_.add_row(r, impulse, motion_.data());",
        "if (!group.elastic) slots_.add_row(r, 0.0 * impulse, motion_.data());"),
    one("kinetic-energy", "rotation counted twice in the kinetic energy", "engine/world.cpp",
        "0.5 * body.mass * state.velocity.squaredNorm() + 0.5 * own_w.dot(body.inertia * own_w);",
        "0.5 * body.mass * state.velocity.squaredNorm() + own_w.dot(body.inertia * own_w);"),
    # Solvers.
    one("few-rounds", "the direct solver ends after its first round", "engine/solvers/direct.cpp",
        "if (round + 1 == substep.iterations) break;", "break;"),
    one("loose-rounds", "the direct solver is satisfied with 1e-2 of the scene's size", "engine/solvers/direct.h",
        "static constexpr double tolerance = 1e-10;", "static constexpr double tolerance = 1e-2;",
        ["engine/solvers/direct.cpp", "engine/integrators/rattle.cpp", "engine/step.cpp"]),
    one("half-multiplier", "the direct solver applies half of its last change", "engine/solvers/row_system.cpp",
        "const double multiplier = rows_[i].weight * unknown;", "const double multiplier = 0.99 * rows_[i].weight * unknown;"),
    one("matrix-entry", "an entry of the direct solver's matrix is 10 % off", "engine/solvers/row_slots.cpp",
        "values[e] = gradient[from] * motion[to];", "values[e] = 0.9 * gradient[from] * motion[to];"),
    one("stale-copies", "rows keep the gradients of the substep before", "engine/solvers/row_slots.cpp",
        "if (row.source != nullptr && source == row.source && edition == row.edition) {",
        "if (changed_[at(unknown_of_[i])] == 0) {"),
    one("joint-weights", "rows that share an unknown act without their weights", "engine/solvers/row_slots.cpp",
        "const double weight = rows[at(i)].weight;", "const double weight = 1.0;"),
    # Contacts.
    one("contact-normal", "contacts that push one body only with 0.9", "engine/contacts/contact.cpp",
        "substep.add_force(row, body_b, surface_b, -normal);", "substep.add_force(row, body_b, surface_b, -0.9 * normal);"),
    one("contact-friction", "friction of contacts twice as large", "engine/contacts/contact.cpp",
        "row.upper = friction * pressed;", "row.upper = 2.0 * friction * pressed;"),
    one("ground-height", "the ground lies 0.05 m too low", "engine/contacts/ground_batch.cpp",
        "row.value = height(at);", "row.value = height(at) + 0.05;"),
    one("bounce", "bounces with 1.3 times the speed", "engine/contacts/rebound.cpp",
        "return std::max(0.0, contact.restitution * impact + a * since);",
        "return std::max(0.0, 1.3 * contact.restitution * impact + a * since);",
        why="the speed at which bodies meet is not reported, so the coefficient of restitution cannot be checked, only that "
            "no bounce makes energy; and the one scene that bounces was doubtful without the fault when this was made"),
    # Faults that there once were.
    one("open-stuck", "runs that no body can lengthen and that have become too short or too long are taken as held",
        "cable/cable_friction.cpp",
        "piece.kind = spare > rounding    ? Piece::Kind::too_long\n                   : spare < -rounding ? Piece::Kind::too_short\n"
        "                                       : Piece::Kind::open;",
        "static_cast<void>(spare > rounding);\n      piece.kind = Piece::Kind::open;"),
    one("open-halved", "tensions that statics leaves open are half of what they were", "cable/cable_held.cpp",
        "multipliers_[at(k)] = portable::exp(pull);", "multipliers_[at(k)] = 0.5 * portable::exp(pull);"),
    one("strain-left", "material comes onto wheels without its strain", "cable/cable_system.cpp",
        "if (cable.inverse_stiffness > 0.0) {\n    transport = material_transport",
        "if (false && cable.inverse_stiffness > 0.0) {\n    transport = material_transport"),
    Fault("unconverged-kept", "what rattle's rounds leave off is accepted, and becomes velocity",
          [("engine/integrators/rattle.cpp",
            "substep.failed = solver_ == SolverKind::direct && substep.resort == Resort::none;\n      if (substep.failed) return;",
            "return;"),
           ("engine/integrators/rattle.cpp",
            "    substep.failed = true;\n    return;\n  }\n  velocities_.apply_impulses",
            "  }\n  velocities_.apply_impulses")], ["engine/integrators/rattle.cpp"]),
]

REPOSITORY = [f"scenes/analytic/{name}.json" for name in
              ("atwood", "belt", "block-and-tackle-4", "bouncing-ball", "cam", "capstan-1-turns", "double-pendulum",
               "four-bar", "gear-train", "gyroscope", "massless-tackle", "pendulum", "pinhole-chain", "slider-crank",
               "sliding-box", "spinning-top", "spring-oscillator", "tipping-box", "tumbling-body", "yo-yo")]
REPOSITORY += [f"scenes/paper/{name}.json" for name in ("bow", "elastic", "hybrid", "merge-split", "servin", "skewed-wheels")]
REPOSITORY += [f"scenes/machines/{name}.json" for name in ("elevator-brake", "geared-hoist", "winch")]
REPOSITORY += [f"tools/faults/{name}.json" for name in ("a1-drum-and-post", "a1-eyelets", "a1-feed", "brake-wheel",
               "a1-holes", "a2-post", "a3-drum", "a4-strained", "a5-cart", "a5-cart-1", "axles", "feed", "levers",
               "sliding-plate", "strained")]
SCENES = [(scene, "direct", integrator) for scene in REPOSITORY for integrator in ("xpbd", "rattle")]
