// One cable over so many wheels side by side, up and down, with weights at its ends.
//   sheave run scenes/templates/wheel-train.jsonnet --check --param wheels=7
local sheave = import 'sheave.libsonnet';

function(wheels=3, light=1, heavy=2, radius=0.2, wheel_mass=0.5, duration=1)
  assert wheels % 2 == 1 : 'wheels must be odd, or the heavy weight would hang upwards';
  local spacing = 2 * radius;
  local low = -1;
  local train = [
    sheave.wheel('wheel %d' % (i + 1), [i * spacing, if i % 2 == 0 then 0 else low, 0], radius, wheel_mass)
    for i in std.range(0, wheels - 1)
  ];
  local a = (heavy - light) * 10 / (heavy + light + wheels * wheel_mass / 2);
  // Room for both to move.
  local drop = 2 + 0.55 * std.abs(a) * duration * duration;
  local left = sheave.weight('light', light, [-radius, -drop, 0]);
  local right = sheave.weight('heavy', heavy, [(wheels - 1) * spacing + radius, -drop, 0]);
  sheave.scene({
    name: 'Wheel train of %d' % wheels,
    gravity: [0, -10, 0],
    duration: duration,
    camera: { direction: [0, 0, -1], labels: true },
    cables: [{
      name: 'cable',
      links: [left.tie] + [
        if i % 2 == 0 then train[i].clockwise else train[i].counter_clockwise
        for i in std.range(0, wheels - 1)
      ] + [right.tie],
    }],
    checks: [
      sheave.check('light.vy', a, tolerance=1e-6, statistic='rate', because='(m2 - m1) g / (m1 + m2 + n I / r^2)'),
      sheave.check('cable.0.tension', light * (10 + a), relative=1e-6, statistic='mean', because='m1 (g + a)'),
      sheave.check('cable.%d.tension' % wheels, heavy * (10 - a), relative=1e-6, statistic='mean', because='m2 (g - a)'),
    ],
  }, train + [left, right])
