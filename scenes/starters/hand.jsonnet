// A hand: fingers of phalanges on hinges with springs, each bent by a tendon that a drum pulls.
//
//   sheave run hand.jsonnet --check                    the numbers, checked against closed forms
//   sheave explain hand.jsonnet                        what is in it, in sentences
//   sheave view hand.jsonnet --open                    the machine in the browser
//   sheave run hand.jsonnet --param 'forces=[5,5,5,5]' all fingers at one force
//
// Units are SI. There is no gravity, so every hinge of a finger bends by the same angle.
local sheave = import 'sheave.libsonnet';

// Parameters with their defaults: the force of each tendon [N], the lengths of the phalanges [m].
function(forces=[2, 3, 3, 2], lengths=[0.045, 0.03, 0.022], stiffness=0.08)
  // One finger per force, side by side. A finger knows the angle `bend` of its hinges in closed form.
  local fingers = [
    sheave.finger('finger %d' % (i + 1), lengths, forces[i], stiffness, base=[0, 0, 0.025 * i])
    for i in std.range(0, std.length(forces) - 1)
  ];

  sheave.scene({
    name: 'Hand',
    description: 'Fingers that tendons bend against springs.',
    gravity: [0, 0, 0],
    duration: 4,
    step: { dt: 0.005 },
    camera: { direction: [-0.6, -0.5, -1] },
    checks: std.flattenArrays([
      [
        sheave.check(hinge + '.angle', -finger.bend, tolerance=1e-6, because='force rho cos((phi - theta) / 2) = stiffness theta')
        for hinge in finger.hinges
      ]
      for finger in fingers
    ]),
  }, fingers)
