// A trolley that travels along a beam with a load on two parts of a rope; the load keeps its height
// and sways.
//   sheave run scenes/templates/trolley-crane.jsonnet --check --param load=2000 --param travel=4
local sheave = import 'sheave.libsonnet';

function(load=1000, height=5, travel=3, time=4, duration=8)
  local crane = sheave.trolley('trolley', [0, 8, 0], load, height, [0, travel], [0, time]);
  sheave.scene({
    name: 'Trolley with a load',
    description: 'A motor moves a trolley; its hook hangs on two parts of one rope.',
    duration: duration,
    step: { dt: 0.01 },
    bodies: [
      { name: 'beam', mobility: 'static', position: [0, 8.6, 0], shape: { type: 'box', size: [20, 0.3, 0.6] } },
    ],
    camera: { direction: [-0.1, -0.05, -1] },
    checks: [
      sheave.check('trolley frame.x', travel, tolerance=1e-6, because='the motor takes it there'),
      sheave.check('trolley rope.length_error', 0, tolerance=1e-12, statistic='range', because='no cable is made or lost'),
    ],
  }, [crane])
