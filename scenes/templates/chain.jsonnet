// A chain of so many rods on hinges, let go when it is level.
//   sheave run scenes/templates/chain.jsonnet --check --param rods=20
local sheave = import 'sheave.libsonnet';

function(rods=10, length=0.2, mass=0.1, duration=1)
  sheave.scene({
    name: 'Chain of %d rods' % rods,
    duration: duration,
    bodies: [
      {
        name: 'rod %d' % (i + 1),
        mobility: 'planar',
        mass: mass,
        position: [(i + 0.5) * length, 0, 0],
        shape: { type: 'box', size: [length, 0.2 * length, 0.2 * length] },
      }
      for i in std.range(0, rods - 1)
    ],
    joints: [
      {
        type: 'hinge',
        name: 'pin %d' % (i + 1),
        body_a: if i == 0 then 'world' else 'rod %d' % i,
        body_b: 'rod %d' % (i + 1),
        anchor: [i * length, 0, 0],
        axis: [0, 0, 1],
      }
      for i in std.range(0, rods - 1)
    ],
    checks: [sheave.check('energy.total', 0, tolerance=2e-3 * rods * mass * 9.81 * length * rods, statistic='drift', because='pins without friction')],
  }, [])
