// Parts of machines for scenes in Jsonnet:
//
//   local sheave = import 'sheave.libsonnet';
//   function(load=100) sheave.scene({duration: 2}, [sheave.tackle('hoist', parts=4, load=load)])
//
// A part is an object with lists of a scene (bodies, joints, cables, ...). Hidden fields (written
// with ::, they are not in the scene) tell what others need to know of it: points, names, closed
// forms. Units are SI; machines stand in the plane z = 0, y is up. docs/how-to/jsonnet.md has pictures.
{
  local sheave = self,
  local lists = ['bodies', 'joints', 'cables', 'controllers', 'triggers', 'loads', 'colliders', 'paint', 'checks'],

  // Vectors.
  add(a, b):: [a[0] + b[0], a[1] + b[1], a[2] + b[2]],
  sub(a, b):: [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  scale(k, a):: [k * a[0], k * a[1], k * a[2]],
  dot(a, b):: a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  length(a):: std.sqrt(sheave.dot(a, a)),

  // The columns of a table in CSV, with `importstr 'table.csv'` for example: one list of numbers per
  // name in the first line. Faults tell file, row and column.
  csv(text):: std.native('csv')(text),
  // Vectors of three lists of numbers.
  vectors(x, y, z):: [[x[i], y[i], z[i]] for i in std.range(0, std.length(x) - 1)],

  pi:: 3.141592653589793,
  radians(degrees):: degrees * sheave.pi / 180,
  // The orientation that a turn by so many degrees about an axis of length 1 makes.
  turned(degrees, axis=[0, 0, 1])::
    local half = sheave.radians(degrees) / 2;
    [std.cos(half)] + sheave.scale(std.sin(half), axis),

  // A scene of parts. `settings`: what a scene has besides lists (gravity has a default), and lists
  // of its own, which come first.
  scene(settings, parts)::
    { format: 'sheave-scene/1', gravity: [0, -9.81, 0] } + settings + {
      [name]: (if std.objectHas(settings, name) then settings[name] else []) +
              std.flatMap(function(part) if std.objectHas(part, name) then part[name] else [], parts)
      for name in lists
      if std.objectHas(settings, name) || std.length([part for part in parts if std.objectHas(part, name)]) > 0
    },

  // A box that can only move along an axis: a weight that hangs, or a block in its guides.
  weight(name, mass, position, size=[0.3, 0.3, 0.3], axis=[0, 1, 0]):: {
    assert mass > 0 : 'weight "%s": the mass must be > 0' % name,
    bodies: [{
      name: name,
      mobility: 'slider',
      axis: axis,
      mass: mass,
      position: position,
      shape: { type: 'box', size: size },
    }],
    top:: sheave.add(position, [0, size[1] / 2, 0]),
    // The link of a cable that is tied to the middle of its upper side.
    tie:: { type: 'attachment', body: name, point: [0, size[1] / 2, 0] },
  },

  // A wheel on a fixed axle, or on that of a body that carries it. Its mass is that of a disc;
  // `inertia` is its moment of inertia in place of the disc's, 0 for a wheel that costs nothing.
  wheel(name, position, radius, mass=1, width=null, mount=null, inertia=null):: {
    assert radius > 0 : 'wheel "%s": the radius must be > 0' % name,
    bodies: [{
      name: name,
      mobility: 'rotor',
      mass: mass,
      position: position,
      shape: { type: 'cylinder', radius: radius, length: if width == null then 0.5 * radius else width },
    } + (if mount == null then {} else { mount: mount })
      + (if inertia == null then {} else { spin_inertia: inertia })],
    // Links of a cable that runs round it.
    clockwise:: { type: 'rolling', body: name, winding: 'clockwise' },
    counter_clockwise:: { type: 'rolling', body: name, winding: 'counter-clockwise' },
    // The same on the side on which the whole cable is shortest.
    shortest:: { type: 'rolling', body: name, side: 'shortest' },
  },

  // A pulley on a ratchet: the rope slides over it from the cable's first link towards its last, and
  // not back. `passes`: 'backward' for the other direction.
  ratchet(name, position, radius, passes='forward', friction=0):: {
    assert radius > 0 : 'ratchet "%s": the radius must be > 0' % name,
    bodies: [{
      name: name,
      mobility: 'static',
      position: position,
      shape: { type: 'cylinder', radius: radius, length: 0.5 * radius },
    }],
    local over = { type: 'rolling', body: name, friction: friction, passes: passes },
    clockwise:: over { winding: 'clockwise' },
    counter_clockwise:: over { winding: 'counter-clockwise' },
    shortest:: over { side: 'shortest' },
  },

  // A cleat that pinches a rope: the rope holds as long as the tensions before and behind the cleat
  // differ by less than `limit` [N], and otherwise slides with that difference. A trigger or a
  // controller opens and closes the cleat by the control `.control`, whose value is the limit times
  // `.arm`. The rope lies once round a drum with a brake, so it may also run straight on.
  cleat(name, position, limit, radius=0.02, mass=0.1)::
    local arm = radius;
    {
      assert limit >= 0 : 'cleat "%s": the limit must be >= 0 N' % name,
      bodies: [{
        name: name,
        mass: mass,
        position: position,
        shape: { type: 'cylinder', radius: radius, length: 2 * radius },
      }],
      joints: [{
        type: 'hinge',
        name: name + ' jaw',
        body_b: name,
        anchor: position,
        axis: [0, 0, 1],
        drive: 'speed',
        drive_values: [0],
        drive_limit: limit * arm,
      }],
      local round = { type: 'rolling', body: name, turns: 1 },
      clockwise:: round { winding: 'clockwise' },
      counter_clockwise:: round { winding: 'counter-clockwise' },
      control:: name + ' jaw.drive_limit',
      arm:: arm,
      // What a moving rope feels of the drum [kg].
      inertia:: mass / 2,
    },

  // A car on a guide rail between two buffers. `lower` and `upper`: how far the car may travel along
  // the axis from its place before it meets them [m]; `buffer`: their stiffness [N/m], null: rigid;
  // `friction`: of the guide [N].
  rail(name, mass, position, lower, upper, buffer=null, axis=[0, 1, 0], friction=0, size=[0.5, 0.5, 0.5]):: {
    assert mass > 0 : 'rail "%s": the mass must be > 0' % name,
    assert lower <= 0 && upper >= 0 && lower < upper :
           'rail "%s": the car starts between its buffers, so lower must be <= 0 and upper >= 0' % name,
    assert buffer == null || buffer > 0 : 'rail "%s": the stiffness of the buffers must be > 0' % name,
    bodies: [{
      name: name,
      mobility: 'slider',
      axis: axis,
      mass: mass,
      position: position,
      shape: { type: 'box', size: size },
    }],
    joints: [{
      type: 'slider',
      name: name + ' guide',
      body_b: name,
      anchor: position,
      axis: axis,
      lower: lower,
      upper: upper,
    } + (if buffer == null then {} else { limit_compliance: 1 / buffer })
      + (if friction == 0 then {} else { friction: friction })],
    // Links of cables that are tied to the middle of the upper and of the lower side.
    top:: { type: 'attachment', body: name, point: [0, size[1] / 2, 0] },
    bottom:: { type: 'attachment', body: name, point: [0, -size[1] / 2, 0] },
    guide:: name + ' guide',
    // How far a buffer gives way to the car that falls from rest over a height onto it:
    // m g (h + x) = buffer x^2 / 2.
    stroke(height, gravity=9.81)::
      local weight = mass * gravity;
      (weight + std.sqrt(weight * weight + 2 * buffer * weight * height)) / buffer,
  },

  // A frame that slides up and down and carries wheels: `wheels` are their centres in the world.
  // `mass` includes them.
  block(name, mass, wheels, radius, wheel_mass=1, axis=[0, 1, 0])::
    local count = std.length(wheels);
    local xs = [w[0] for w in wheels];
    local left = std.foldl(std.min, xs, xs[0]);
    local right = std.foldl(std.max, xs, xs[0]);
    local center = [(left + right) / 2, wheels[0][1] - 2.2 * radius, 0];
    local names = [name + ' sheave ' + (i + 1) for i in std.range(0, count - 1)];
    local sheaves = [
      sheave.wheel(names[i], wheels[i], radius, wheel_mass, mount=name)
      for i in std.range(0, count - 1)
    ];
    {
      assert mass > count * wheel_mass :
             'block "%s": its mass includes its %d wheels, so it must be more than %g kg' % [name, count, count * wheel_mass],
      bodies: [{
        name: name,
        mobility: 'slider',
        axis: axis,
        mass: mass - count * wheel_mass,
        position: center,
        shape: { type: 'box', size: [right - left + 2 * radius, 1.6 * radius, 1.2 * radius] },
      }] + std.flatMap(function(s) s.bodies, sheaves),
      center:: center,
      // Wheels in the order of `wheels`.
      sheaves:: sheaves,
    },

  // A block and tackle of n parts of rope between a beam and a block, all of them plumb and one
  // diameter apart, and a weight at the free end, `effort`. `load` includes the lower block's
  // wheels. In balance (the default) effort = load / parts.
  tackle(name, parts, load, effort=null, diameter=0.4, wheel_mass=1, drop=4, at=[0, 0, 0], gravity=9.81, travel=null)::
    local even = parts % 2 == 0;
    local r = diameter / 2;
    local m = if effort == null then load / parts else effort;
    local is_lower(k) = (k % 2 == 1) == even;  // wheel k is between part k and part k + 1
    local center(k) = sheave.add(at, [(k - 0.5) * diameter, if is_lower(k) then -drop else 0, 0]);
    local lower = [k for k in std.range(1, parts) if is_lower(k)];
    local upper = [k for k in std.range(1, parts) if !is_lower(k)];
    local the_block = sheave.block(name + ' block', load, [center(k) for k in lower], r, wheel_mass);
    local wheels = {
      [std.toString(lower[i])]: the_block.sheaves[i]
      for i in std.range(0, std.length(lower) - 1)
    } + {
      [std.toString(k)]: sheave.wheel(name + ' upper ' + k, center(k), r, wheel_mass)
      for k in upper
    };
    local fixed = sheave.add(at, [0, if even then 1.4 * diameter else -drop - 1.4 * r, 0]);
    local pull = sheave.weight(name + ' effort', m, sheave.add(at, [parts * diameter, -0.6 * drop, 0]), [0.7 * diameter, 0.7 * diameter, 0.7 * diameter]);
    local squares = parts * (parts + 1) * (2 * parts + 1) / 6;
    local a = (load - parts * m) * gravity / (load + parts * parts * m + wheel_mass / 2 * squares);
    {
      assert parts >= 2 && parts == std.floor(parts) : 'tackle "%s": parts must be a whole number from 2 on' % name,
      assert drop > diameter : 'tackle "%s": drop must be more than the diameter' % name,
      bodies: [{
        name: name + ' beam',
        mobility: 'static',
        position: sheave.add(at, [parts * diameter / 2, 1.6 * diameter, 0]),
        shape: { type: 'box', size: [(parts + 0.5) * diameter, 0.4 * diameter, 0.6 * diameter] },
      }] + the_block.bodies + std.flatMap(function(k) wheels[std.toString(k)].bodies, upper) + pull.bodies,
      cables: [{
        name: name + ' rope',
        links: [
          if even then { type: 'attachment', body: 'world', point: fixed }
          else { type: 'attachment', body: name + ' block', point: sheave.sub(fixed, the_block.center) },
        ] + [
          local wheel = wheels[std.toString(k)];
          if is_lower(k) then wheel.counter_clockwise else wheel.clockwise
          for k in std.range(1, parts)
        ] + [pull.tie],
      }],
      // Closed forms: the load's acceleration downwards, and the tension at the effort.
      acceleration:: a,
      tension:: m * (gravity + parts * a),
      block:: name + ' block',
      effort:: name + ' effort',
      rope:: name + ' rope',
    },

  // A drum that its drive turns: `speeds` [rad/s] at `times` [s], positive counter-clockwise.
  drum(name, position, radius, speeds, times=null, mass=100, width=null, stored=2):: {
    bodies: [{
      name: name,
      mobility: 'rotor',
      mass: mass,
      position: position,
      shape: { type: 'cylinder', radius: radius, length: if width == null then 2 * radius else width },
      drive: 'speed',
      drive_values: speeds,
    } + (if times == null then {} else { drive_times: times })],
    // Links of a cable's end that is wound onto it.
    clockwise:: { type: 'spool', body: name, winding: 'clockwise', stored_length: stored },
    counter_clockwise:: { type: 'spool', body: name, winding: 'counter-clockwise', stored_length: stored },
  },

  // A trolley that a motor moves along x (`places` [m] from its start at `times` [s]), with a hook
  // below on two parts of one rope, whose end is held at the beam's right end: so the hook keeps its
  // height while the trolley travels. `height`: of the trolley above the hook's wheel.
  trolley(name, position, load, height, places, times, mass=500, radius=0.2, reach=10)::
    local frame = name + ' frame';
    local left = sheave.wheel(name + ' left sheave', sheave.add(position, [-2 * radius, 0, 0]), radius, 1, mount=frame, inertia=0);
    local right = sheave.wheel(name + ' right sheave', sheave.add(position, [2 * radius, 0, 0]), radius, 1, mount=frame, inertia=0);
    local hook = sheave.wheel(name + ' hook sheave', sheave.add(position, [0, -height, 0]), radius, 1, mount=name + ' hook', inertia=0);
    local hook_center = sheave.add(position, [0, -height - 4 * radius, 0]);
    {
      assert load > 1 : 'trolley "%s": the load includes the hook\'s wheel of 1 kg' % name,
      bodies: [
        {
          name: frame,
          mobility: 'slider',
          axis: [1, 0, 0],
          mass: mass,
          position: position,
          shape: { type: 'box', size: [6 * radius, radius, 2 * radius] },
        },
      ] + left.bodies + right.bodies + [
        {
          name: name + ' hook',
          mobility: 'planar',
          mass: load - 1,
          position: hook_center,
          shape: { type: 'box', size: [5 * radius, 4 * radius, 4 * radius] },
        },
      ] + hook.bodies,
      joints: [{
        type: 'slider',
        name: name + ' drive',
        body_a: 'world',
        body_b: frame,
        anchor: position,
        axis: [1, 0, 0],
        drive: 'position',
        drive_times: times,
        drive_values: places,
        drive_interpolation: 'clamped',
      }],
      cables: [{
        name: name + ' rope',
        links: [
          { type: 'attachment', body: 'world', point: sheave.add(position, [-reach, radius, 0]) },
          left.clockwise,
          hook.counter_clockwise,
          right.clockwise,
          { type: 'attachment', body: 'world', point: sheave.add(position, [reach, radius, 0]) },
        ],
      }],
      hook:: name + ' hook',
      rope:: name + ' rope',
    },

  // A finger of phalanges of these lengths along x, on hinges with springs, and a tendon below it
  // that a drum pulls with a force: through two holes beside each hinge, `before` and behind it, at
  // the depth `offset` below the hinge's axis. Without gravity every hinge bends by the same angle.
  finger(name, lengths, force, stiffness=0.08, damping=0.01, thickness=0.016, offset=0.01, before=0.006, base=[0, 0, 0], mass=0.02)::
    local count = std.length(lengths);
    local joint_x(i) = if i == 0 then 0 else joint_x(i - 1) + lengths[i - 1];
    local part(i) = '%s phalanx %d' % [name, i + 1];
    local drum_radius = 0.01;
    local drum_at = sheave.add(base, [-0.06, drum_radius - offset, 0]);
    local rho = std.sqrt(before * before + offset * offset);
    local phi = 2 * std.atan(before / offset);
    {
      assert force * rho < stiffness * phi :
             'finger "%s": a force of %g N bends it until its holes meet; it must be below %g N' % [name, force, stiffness * phi / rho],
      assert count >= 1 : 'finger "%s": needs a phalanx' % name,
      assert std.length([l for l in lengths if l <= 2 * before]) == 0 :
             'finger "%s": each phalanx must be longer than %g m, or its holes meet' % [name, 2 * before],
      bodies: [{
        name: name + ' drum',
        mobility: 'rotor',
        mass: 0.05,
        position: drum_at,
        angular_damping: 1e-4,
        shape: { type: 'cylinder', radius: drum_radius, length: 0.01 },
        drive: 'torque',
        // Winding the tendon in turns it clockwise.
        drive_values: [-force * drum_radius],
      }] + [
        {
          name: part(i),
          mobility: 'planar',
          mass: mass,
          position: sheave.add(base, [joint_x(i) + lengths[i] / 2, 0, 0]),
          shape: { type: 'box', size: [0.94 * lengths[i], thickness, thickness] },
        }
        for i in std.range(0, count - 1)
      ],
      joints: [
        {
          type: 'hinge',
          name: '%s hinge %d' % [name, i + 1],
          body_a: if i == 0 then 'world' else part(i - 1),
          body_b: part(i),
          anchor: sheave.add(base, [joint_x(i), 0, 0]),
          axis: [0, 0, 1],
          stiffness: stiffness,
          damping: damping,
        }
        for i in std.range(0, count - 1)
      ],
      cables: [{
        name: name + ' tendon',
        links: [
          { type: 'spool', body: name + ' drum', winding: 'counter-clockwise', stored_length: 0.1 },
          { type: 'pinhole', body: 'world', point: sheave.add(base, [-before, -offset, 0]) },
        ] + std.flatMap(
          function(i)
            local near = { body: part(i), point: [-lengths[i] / 2 + before, -offset, 0] };
            if i == count - 1 then [{ type: 'attachment' } + near]
            else [
              { type: 'pinhole' } + near,
              { type: 'pinhole', body: part(i), point: [lengths[i] / 2 - before, -offset, 0] },
            ],
          std.range(0, count - 1)
        ),
      }],
      tendon:: name + ' tendon',
      hinges:: ['%s hinge %d' % [name, i + 1] for i in std.range(0, count - 1)],
      // How far every hinge bends: force rho cos((phi - theta) / 2) = stiffness theta, with the
      // holes rho from the axis and seen from it under phi when straight. By Newton's method.
      bend::
        local next(theta) = theta - (force * rho * std.cos((phi - theta) / 2) - stiffness * theta)
                                    / (force * rho / 2 * std.sin((phi - theta) / 2) - stiffness);
        std.foldl(function(theta, i) next(theta), std.range(1, 20), 0),
    },

  // A platform on cables from winches at `corners` to `ties` on it (body frame), each cable as long
  // as it is at the start, in space. `elasticity`: EA of the cables [N]; null: rigid.
  // `pretension` [N]: needs an elasticity.
  cable_robot(name, corners, position, mass, ties, size=[0.4, 0.1, 0.4], elasticity=null, damping=0, pretension=null):: {
    assert std.length(corners) == std.length(ties) : 'cable robot "%s": a tie for each corner' % name,
    bodies: [{
      name: name,
      mass: mass,
      position: position,
      damping: damping,
      angular_damping: damping * 0.01,
      shape: { type: 'box', size: size },
    }],
    cables: [
      {
        name: '%s cable %d' % [name, i + 1],
        links: [
          { type: 'attachment', body: 'world', point: corners[i] },
          { type: 'attachment', body: name, point: ties[i] },
        ],
      } + (if elasticity == null then {} else { axial_stiffness: elasticity })
        + (if pretension == null then {} else { pretension: pretension })
      for i in std.range(0, std.length(corners) - 1)
    ],
    platform:: name,
    ropes:: ['%s cable %d' % [name, i + 1] for i in std.range(0, std.length(corners) - 1)],
    // Lengths of the cables with the platform's middle at a point, not turned.
    lengths_at(point):: [
      sheave.length(sheave.sub(corners[i], sheave.add(point, ties[i])))
      for i in std.range(0, std.length(corners) - 1)
    ],
  },

  // A check of a scene: that a quantity has a value.
  check(quantity, equals, tolerance=null, relative=null, statistic=null, because=null, at=null)::
    {
      quantity: quantity,
      equals: equals,
    } + (if tolerance == null then {} else { tolerance: tolerance })
    + (if relative == null then {} else { relative_tolerance: relative })
    + (if statistic == null then {} else { statistic: statistic })
    + (if at == null then {} else { at: at })
    + (if because == null then {} else { because: because }),
}
