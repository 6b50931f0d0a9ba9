// A block and tackle: a load on so many parts of one rope, and an effort at its free end.
//   sheave run scenes/templates/tackle.jsonnet --check --param parts=6 --param load=300 --param effort=60
local sheave = import 'sheave.libsonnet';

function(parts=4, load=100, effort=null, duration=1)
  local hoist = sheave.tackle('hoist', parts, load, effort, gravity=10, drop=6);
  sheave.scene({
    name: 'Block and tackle, %d parts' % parts,
    description: 'A load on several parts of one rope, and the effort at its free end.',
    gravity: [0, -10, 0],
    duration: duration,
    camera: { direction: [0, 0, -1], labels: true },
    checks: [
      sheave.check('hoist block.vy', -hoist.acceleration, tolerance=1e-6, statistic='rate', because='(M - n m) g / (M + n^2 m + (I / r^2) sum k^2)'),
      sheave.check('hoist rope.%d.tension' % parts, hoist.tension, relative=1e-6, statistic='mean', because='m (g + n a)'),
    ],
  }, [hoist])
