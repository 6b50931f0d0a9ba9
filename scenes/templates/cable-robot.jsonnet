// A platform on four rigid cables from the corners of a hall, in balance in the middle.
//   sheave run scenes/templates/cable-robot.jsonnet --check --param mass=40 --param height=2
local sheave = import 'sheave.libsonnet';

function(mass=20, width=6, depth=4, ceiling=4, height=1.5, duration=2)
  assert height < ceiling : 'the platform must hang below the ceiling';
  local corners = [[sx * width / 2, ceiling, sz * depth / 2] for sx in [-1, 1] for sz in [-1, 1]];
  local ties = [[sx * 0.2, 0.05, sz * 0.2] for sx in [-1, 1] for sz in [-1, 1]];
  local robot = sheave.cable_robot('platform', corners, [0, height, 0], mass, ties, damping=20);
  local length = robot.lengths_at([0, height, 0])[0];
  sheave.scene({
    name: 'Cable robot',
    description: 'A platform on four cables.',
    duration: duration,
    camera: { direction: [-0.4, -0.3, -1], labels: true },
    checks: [
      sheave.check('%s.0.tension' % rope, mass * 9.81 * length / (4 * (ceiling - height - 0.05)), relative=1e-6, because='four cables carry the weight, m g l / (4 h)')
      for rope in robot.ropes
    ] + [sheave.check('platform.y', height, tolerance=1e-6, because='in balance')],
  }, [robot])
