// A car falls along its guide rail onto a buffer, and is thrown back.
//   sheave run scenes/templates/rail.jsonnet --check --param mass=800 --param height=2
local sheave = import 'sheave.libsonnet';

function(mass=500, height=1, buffer=2e5)
  local gravity = 10;
  local car = sheave.rail('car', mass, [0, height, 0], lower=-height, upper=1, buffer=buffer);
  local fall = std.sqrt(2 * height / gravity);
  sheave.scene({
    name: 'Car on its buffer',
    description: 'A car falls along a guide rail onto a buffer.',
    gravity: [0, -gravity, 0],
    duration: 1.5 * fall,
    step: { dt: 0.001 },
    camera: { direction: [0, 0, -1] },
    checks: [
      // At its lowest point the car moves by v = a h / 2 in half a step: a part of 1e-5 of the stroke.
      sheave.check(car.guide + '.travel', -height - car.stroke(height, gravity), relative=1e-4, statistic='minimum', because='m g (h + x) = buffer x^2 / 2'),
    ],
  }, [car])
