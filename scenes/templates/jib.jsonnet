// A jib on a wall, held by a rope of a given length: the angle of the rope decides its tension.
//   sheave statics scenes/templates/jib.jsonnet --param angle=0.6
//   sheave tune scenes/templates/jib.jsonnet --of statics --vary angle=0.2:1.2 --minimise rope.0.tension
// The rope makes `angle` with the jib, and `aside` with the plane of the wall bracket [rad]. Moments about the foot:
// T sin(angle) cos(aside)^2 cos(angle) rope = m g jib / 2, least at angle = pi / 4 and aside = 0.
function(angle=0.6, aside=0, rope=3, jib=4, mass=100)
  local reach = rope * std.cos(angle) * std.cos(aside);
  local height = rope * std.sin(angle) * std.cos(aside);
  local side = rope * std.sin(aside);
  {
    assert reach < jib : 'the rope must meet the jib: rope * cos(angle) must be less than jib',
    format: 'sheave-scene/1',
    name: 'Jib on a wall',
    description: 'A jib on a hinge, held by a rope from the wall.',
    gravity: [0, -10, 0],
    duration: 1,
    bodies: [
      { name: 'wall', mobility: 'static', position: [-0.1, 1.5, 0], shape: { type: 'box', size: [0.2, 4, 1] } },
      { name: 'jib', mass: mass, position: [jib / 2, 0, 0], shape: { type: 'box', size: [jib, 0.1, 0.1] } },
    ],
    joints: [{ type: 'hinge', name: 'foot', body_b: 'jib', anchor: [0, 0, 0], axis: [0, 0, 1] }],
    cables: [{
      name: 'rope',
      links: [
        { type: 'attachment', body: 'world', point: [0, height, side] },
        { type: 'attachment', body: 'jib', point: [reach - jib / 2, 0, 0] },
      ],
    }],
    checks: [{
      quantity: 'rope.0.tension',
      equals: mass * 10 * jib / (rope * std.sin(2 * angle) * std.pow(std.cos(aside), 2)),
      relative_tolerance: 1e-9,
      because: 'm g jib / (rope sin 2 angle cos^2 aside)',
    }],
  }
