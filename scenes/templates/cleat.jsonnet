// A load on a rope that a cleat pinches; the cleat opens at 1 s. A load beyond the limit slides from
// the start.
//   sheave run scenes/templates/cleat.jsonnet --check --param load=30
local sheave = import 'sheave.libsonnet';

function(load=30, limit=400)
  local gravity = 10;
  local jaw = sheave.cleat('cleat', [0, 0, 0], limit);
  local weight = sheave.weight('load', load, [-0.02, -3, 0]);
  local slides = std.max(load * gravity - limit, 0) / (load + jaw.inertia);
  local falls = load * gravity / (load + jaw.inertia);
  sheave.scene({
    name: 'Cleat',
    description: 'A load on a rope in a cleat, which opens.',
    gravity: [0, -gravity, 0],
    duration: 1.5,
    step: { dt: 0.005 },
    camera: { direction: [0, 0, -1], labels: true },
    cables: [{
      name: 'rope',
      links: [weight.tie, jaw.clockwise, { type: 'attachment', body: 'world', point: [2, 1, 0] }],
      // The tail is slack enough for all that comes.
      rest_lengths: [2.85, 20],
    }],
    triggers: [{ name: 'open', at: 1, action: 'set', target: jaw.control, value: 0 }],
    checks: [
      sheave.check('load.vy', -slides, tolerance=1e-6, at=1, because='(m g - limit) / (m + I / r^2) after 1 s'),
      sheave.check('load.vy', -slides - 0.5 * falls, relative=1e-6, because='m g / (m + I / r^2) for 0.5 s more'),
    ],
  }, [jaw, weight])
