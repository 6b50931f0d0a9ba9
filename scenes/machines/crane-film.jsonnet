// A film of the crane: titles, arrows, and a camera that comes closer and turns.
//
//   sheave render scenes/machines/crane-film.jsonnet --video crane.mp4
(import 'crane.json') {
  name: 'A film of the crane',
  duration: 12,
  checks: [],
  camera: {},
  camera_path: [
    { time: 0, position: [4, 9, 46], target: [5, 7.5, 0] },
    { time: 3, position: [4, 9, 46], target: [5, 7.5, 0] },
    { time: 7, position: [34, 10, 19], target: [11.5, 7, 0] },
  ],
  annotations: [
    { kind: 'title', text: 'How a crane lifts' },
    { kind: 'caption', to: 6.5, text: 'The winch hauls a rope that runs over the tip of the boom to the hook.' },
    { kind: 'caption', from: 6.5, text: 'Two parts of the rope carry the hook, so it rises at half of the speed of the rope, and each part has half of the weight.' },
    { kind: 'arrow', text: 'winch', body: 'hoist winch', to: 3 },
    { kind: 'arrow', text: '4950 kg', body: 'hook', point: [0, -0.5, 0] },
  ],
}
