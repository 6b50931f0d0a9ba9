// IFToMM's benchmark A02 with n windows of four bars; scenes/analytic/iftomm-four-bars.json is that of n = 2 with free bodies.
//
//   sheave run bench/benchmarks/four-bars.jsonnet --param n=40 --param mobility=planar
local bar(name, mobility, place, velocity, spin, along) = {
  name: name,
  mobility: mobility,
  position: place,
  velocity: velocity,
  angular_velocity: [0, 0, spin],
  mass: 1,
  center_of_mass: [0, 0, 0],
  inertia: if along == 'y' then [1 / 12, 0.001, 1 / 12] else [0.001, 1 / 12, 1 / 12],
  shape: { type: 'box', size: if along == 'y' then [0.06, 1.06, 0.04] else [1.06, 0.06, 0.04] },
};
local hinge(name, a, b, place) = {
  type: 'hinge', name: name, body_a: a, body_b: b, anchor: place, axis: [0, 0, 1],
};

function(n=2, mobility='free') {
  format: 'sheave-scene/1',
  name: 'IFToMM A02 with %d windows' % n,
  description: 'Windows of four bars fall over from the top and pass singular positions.',
  gravity: [0, -9.81, 0],
  duration: 10,
  step: { dt: 0.01, substeps: 4, solver: 'direct', integrator: 'rattle' },
  bodies: [bar('upright %d' % i, mobility, [i, 0.5, 0], [0.5, 0, 0], -1, 'y') for i in std.range(0, n)]
          + [bar('coupler %d' % i, mobility, [i - 0.5, 1, 0], [1, 0, 0], 0, 'x') for i in std.range(1, n)],
  joints: [hinge('A%d' % i, 'world', 'upright %d' % i, [i, 0, 0]) for i in std.range(0, n)]
          + std.flattenArrays([
            [
              hinge('B%d right' % (i - 1), 'upright %d' % (i - 1), 'coupler %d' % i, [i - 1, 1, 0]),
              hinge('B%d left' % i, 'coupler %d' % i, 'upright %d' % i, [i, 1, 0]),
            ]
            for i in std.range(1, n)
          ]),
}
