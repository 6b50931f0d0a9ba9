// A finger that a tendon bends against the springs in its hinges.
//   sheave run scenes/templates/finger.jsonnet --check --param force=5 --param 'lengths=[0.05,0.03]'
local sheave = import 'sheave.libsonnet';

function(force=3, lengths=[0.045, 0.03, 0.022], stiffness=0.08, duration=4)
  local finger = sheave.finger('index', lengths, force, stiffness);
  sheave.scene({
    name: 'Finger of %d phalanges' % std.length(lengths),
    gravity: [0, 0, 0],
    duration: duration,
    step: { dt: 0.005 },
    camera: { direction: [-0.2, -0.2, -1] },
    checks: [
      sheave.check(hinge + '.angle', -finger.bend, tolerance=1e-6, because='force rho cos((phi - theta) / 2) = stiffness theta')
      for hinge in finger.hinges
    ] + [
      sheave.check(finger.tendon + '.1.tension', force, relative=1e-6, because='torque of the drum / its radius'),
    ],
  }, [finger])
