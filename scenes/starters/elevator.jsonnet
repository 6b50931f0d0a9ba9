// An elevator: a sheave that a motor turns carries a cabin and a counterweight on elastic ropes.
//
//   sheave run elevator.jsonnet --check                the numbers, checked against closed forms
//   sheave explain elevator.jsonnet                    what is in it, in sentences
//   sheave view elevator.jsonnet --open                the machine in the browser
//   sheave run elevator.jsonnet --param cabin=1500     a full cabin
//
// Units are SI. The machine stands in the plane z = 0, and y is up.
local sheave = import 'sheave.libsonnet';

// Parameters with their defaults: masses [kg], height of the ride [m], axial stiffness of the ropes [N].
function(cabin=1000, counterweight=1400, ride=8, stiffness=2e7)
  local gravity = 9.81;
  local radius = 0.5;

  // Cabin and counterweight run in guide rails between buffers, 1 m beyond their ride.
  local car = sheave.rail('cabin', cabin, [-radius, 2, 0], lower=-1, upper=ride + 1, buffer=1e5, size=[0.9, 2, 1]);
  local weight = sheave.rail('counterweight', counterweight, [radius, 2 + ride, 0], lower=-ride - 1, upper=1, buffer=1e5, size=[0.4, 2, 1]);

  // The motor turns the sheave by a trapezoid: 1 s faster, 4 s even, 1 s slower. The rope moves by
  // 5 s x speed x radius. A positive speed is counter-clockwise, and lifts the counterweight.
  local speed = -ride / (5 * radius);
  local machine = sheave.drum('machine', [0, 6 + ride, 0], radius, [0, speed, speed, 0], [1, 2, 6, 7], width=0.3);

  // The ropes hang at both sides of the sheave and do not slip on it. A "friction" in this link
  // would let them slip beyond the ratio e^(friction x pi) of their tensions.
  local ropes = {
    name: 'ropes',
    axial_stiffness: stiffness,
    damping: 2e4,
    links: [car.top, { type: 'rolling', body: 'machine', side: 'shortest' }, weight.top],
  };

  sheave.scene({
    name: 'Elevator',
    description: 'A traction sheave moves a cabin and its counterweight.',
    gravity: [0, -gravity, 0],
    duration: 10,
    // The ropes are stretched by the weights before the run begins.
    start: 'rest',
    cables: [ropes],
    camera: { direction: [-0.2, -0.1, -1], labels: true },
    checks: [
      sheave.check('ropes.0.tension', cabin * gravity, relative=1e-4, at=0.5, because='the cabin hangs at rest'),
      sheave.check('ropes.0.tension', cabin * (gravity - speed * radius), relative=1e-3, at=1.8, because='m (g + a), but for vibration'),
      sheave.check('cabin.y', 2 + ride, tolerance=0.01, because='the rim has moved by the ride; the ropes are stretched otherwise'),
    ],
  }, [machine, car, weight])
