// A cable robot: eight cables with a pretension hold a platform in the middle of a frame. A push
// moves the platform, and its cables pull it back.
//
//   sheave run robot.jsonnet --check                   the numbers, checked against closed forms
//   sheave explain robot.jsonnet                       what is in it, in sentences
//   sheave view robot.jsonnet --open                   the machine in the browser
//   sheave modes robot.jsonnet                         its natural frequencies
//
// Units are SI, and y is up.
local sheave = import 'sheave.libsonnet';

// Parameters with their defaults: mass [kg], size of the frame [m], pretension [N], axial stiffness [N].
function(mass=20, width=6, height=4, pretension=2000, stiffness=1e5)
  local gravity = 9.81;
  local signs = [-1, 1];
  local corners = [[sx * width / 2, y, sz * width / 2] for y in [0, height] for sx in signs for sz in signs];
  // The upper cables are tied to the lower edge of the platform and the lower ones to its upper
  // edge: cables that cross hold it against turning, too.
  local ties = [[sx * 0.2, y, sz * 0.2] for y in [0.05, -0.05] for sx in signs for sz in signs];
  local robot = sheave.cable_robot('platform', corners, [0, height / 2, 0], mass, ties, elasticity=stiffness, damping=60, pretension=pretension);

  sheave.scene({
    name: 'Cable robot',
    description: 'A platform on eight cables is pushed and comes back.',
    gravity: [0, -gravity, 0],
    duration: 6,
    // Under its weight the platform sinks a little before the run begins.
    start: 'rest',
    camera: { direction: [-0.5, -0.3, -1] },
    // A push of 200 N to the side for a tenth of a second.
    triggers: [
      { name: 'push', at: 1, action: 'set', target: 'platform.force_x', value: 200 },
      { name: 'end of push', at: 1.1, action: 'set', target: 'platform.force_x', value: 0 },
    ],
    checks: [
      sheave.check('platform.x', 0, tolerance=1e-6, at=0.9, because='the frame is alike on both sides'),
      sheave.check('platform.x', 0, tolerance=1e-3, because='the swing has died away'),
    ],
  }, [robot])
