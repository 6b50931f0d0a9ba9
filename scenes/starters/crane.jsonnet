// A crane: a winch lifts a hook on two parts of a rope, which runs over a sheave at the head.
//
//   sheave run crane.jsonnet --check                   the numbers, checked against closed forms
//   sheave explain crane.jsonnet                       what is in it, in sentences
//   sheave view crane.jsonnet --open                   the machine in the browser
//   sheave run crane.jsonnet --param load=2000         another load
//
// Units are SI. The machine stands in the plane z = 0, and y is up.
local sheave = import 'sheave.libsonnet';

// Parameters with their defaults: mass of hook and load [kg], height of the head [m], lift [m].
function(load=500, height=8, lift=3)
  local gravity = 9.81;

  // The winch: a drum of 0.2 m whose drive turns it. It speeds up for 1 s, turns for 3 s and stops
  // within 1 s, so it winds 4 s x speed x radius of rope. On two parts of rope the hook rises by half of that.
  local radius = 0.2;
  local speed = 2 * lift / (4 * radius);
  local winch = sheave.drum('winch', [0, 0.5, 0], radius, [0, speed, speed, 0], [0.5, 1.5, 4.5, 5.5]);

  // The sheave at the head, and the hook with its own sheave. The two parts of rope are plumb.
  local head = sheave.wheel('head sheave', [4, height, 0], 0.3, mass=10);
  local hook = sheave.block('hook', load, [[4.5, height - 4, 0]], 0.2);

  // The rope: from the winch over the head and round the hook to the tip of the jib. The side
  // "shortest" lets the geometry choose how the rope runs round a wheel.
  local rope = {
    name: 'rope',
    links: [
      winch.clockwise,
      head.shortest,
      hook.sheaves[0].shortest,
      { type: 'attachment', body: 'world', point: [4.7, height, 0] },
    ],
  };

  sheave.scene({
    name: 'Crane',
    description: 'A winch lifts a load on two parts of a rope.',
    gravity: [0, -gravity, 0],
    duration: 7,
    cables: [rope],
    camera: { direction: [-0.2, -0.1, -1], labels: true },
    // Closed forms. `sheave run --check` compares the run with them.
    checks: [
      sheave.check('hook.y', hook.center[1] + lift, tolerance=1e-6, because='half of the rope that the winch has wound'),
      sheave.check('rope.2.tension', load * gravity / 2, relative=1e-6, because='two parts carry the load at rest'),
    ],
  }, [winch, head, hook])
