// A load that pulls on a rope raise: a ratchet keeps the progress of each pull.
//   sheave run scenes/templates/ratchet.jsonnet --check --param load=40 --param pull=600
local sheave = import 'sheave.libsonnet';

function(load=40, hand=5, pull=600, time=0.4)
  local gravity = 10;
  local block = sheave.ratchet('ratchet', [0, 0, 0], 0.1);
  local weight = sheave.weight('load', load, [-0.1, -5, 0]);
  local grip = sheave.weight('hand', hand, [0.1, -2, 0], size=[0.1, 0.1, 0.1]);
  local up = (pull + (hand - load) * gravity) / (load + hand);
  local back = (load - hand) * gravity / (load + hand);
  local rise = up * time * time / 2 + up * up * time * time / (2 * back);
  local rest = 2 * (1 + time);
  {
    assert up > 0 : 'the pull of %g N does not raise the load' % pull,
    assert back > 0 : 'the load must be heavier than the hand',
  } + sheave.scene({
    name: 'Ratchet',
    description: 'Two pulls raise a load, which a ratchet holds.',
    gravity: [0, -gravity, 0],
    duration: 2 * rest,
    step: { dt: 0.005 },
    camera: { direction: [0, 0, -1], labels: true },
    cables: [{ name: 'rope', links: [weight.tie, block.shortest, grip.tie] }],
    triggers: std.flattenArrays([
      [
        { name: 'pull %d' % (i + 1), at: i * rest, action: 'set', target: 'hand.force_y', value: -pull },
        { name: 'rest %d' % (i + 1), at: i * rest + time, action: 'set', target: 'hand.force_y', value: 0 },
      ]
      for i in [0, 1]
    ]),
    checks: [
      // The load stops within the substep after its highest point: back h^2 = 2e-4 m for each pull.
      sheave.check('load.y', -5 + 2 * rise, tolerance=5e-4, because='each pull raises it by a t^2 / 2 + v^2 / (2 b)'),
      sheave.check('load.vy', 0, tolerance=1e-9, because='the ratchet holds'),
      sheave.check('rope.0.tension', load * gravity, relative=1e-6, because='and bears the load'),
    ],
  }, [block, weight, grip])
