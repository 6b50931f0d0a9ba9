// The page of a machine: the picture, the time line, the numbers and the curves. The page shows
// frames from any source; controls of a running engine are in `extras`.

import { Chooser, firstChoice } from './chooser';
import { button, download, element } from './dom';
import { annotated, csv } from './exports';
import type { Frames } from './frames';
import type { KeyAction } from './keyboard';
import { listenToKeys } from './keyboard';
import { legend } from './legend';
import type { Machine } from './machine';
import { MachineState } from './machine_state';
import { timeText } from './numbers';
import { Player } from './player';
import { Plots } from './plots';
import { Readout } from './readout';
import { Scene3D } from './scene3d';
import { Timeline } from './timeline';
import { isDark, onTheme, startTheme, toggleTheme } from './theme';

export interface Page {
  frames: Frames;
  player: Player;
  state: MachineState;
  timeline: Timeline;
  plots: Plots;
  readout: Readout;
  /** Null if the browser has no 3D graphics. */
  scene: Scene3D | null;
  /** Container for further controls beside the curves. */
  extras: HTMLElement;
  /** Draws the player's present time again. */
  refresh(): void;
  dispose(): void;
}

/** A press that moves no further than this is a tap [pixels]. */
const tapMoves = 6;
const mouseReach = 7;
const touchReach = 18;

export interface PageOptions {
  /** Keys in addition to the page's own. */
  keys?: KeyAction[];
  /** Text beside the name. */
  note?: string;
}

export function buildPage(host: HTMLElement, frames: Frames, options: PageOptions = {}): Page {
  const machine = frames.machine;
  const player = new Player();
  const state = new MachineState(frames);
  const plots = new Plots(frames, player);
  const timeline = new Timeline(player, frames);
  const readout = new Readout(frames, state, plots);
  const extras = element('div', { class: 'extras' });
  const stage = element('section', { class: 'stage', 'aria-label': 'the machine' });
  const overlay = element('div', { class: 'overlay' });
  const help = element('dialog', { class: 'help' });
  const fileName = machine.name.replace(/[^\w.-]+/g, '-') || 'machine';

  const saveTable = (names: readonly string[]): void =>
    download(`${fileName}.csv`, new Blob([csv(frames, names)], { type: 'text/csv' }));
  const savePicture = async (): Promise<void> => {
    if (!scene) return;
    const ratio = scene.canvas.width / Math.max(scene.canvas.clientWidth, 1);
    const picture = await annotated(await scene.picture(), frames, player.time, isDark(), ratio, scene.annotations);
    download(`${fileName}-${timeText(player.time, machine.dt)}s.png`, picture);
  };

  const header = element(
    'header',
    { class: 'top' },
    element('h1', { title: machine.description }, machine.name),
    element('span', { class: 'note' }, options.note ?? '', ...verdictOf(machine)),
    button('Fit', 'the whole machine into the picture (F)', () => scene?.fit()),
    button('PNG', 'save the picture (P)', () => void savePicture()),
    button('CSV', 'save the chosen quantities; all with shift (C)', () => saveTable(plots.names)),
    button('◐', 'dark or light (T)', toggleTheme),
    button('?', 'keys (?)', () => help.showModal()),
  );
  const side = element('aside', { class: 'side' }, extras, new Chooser(frames, plots).element, plots.element);
  host.replaceChildren(header, element('main', {}, stage, side), timeline.element, help);
  stage.append(overlay, readout.element);

  let scene: Scene3D | null = null;
  if (Scene3D.isSupported()) {
    state.look(player.time);
    scene = new Scene3D(stage, state);
    if (machine.description) scene.canvas.setAttribute('aria-label', machine.description);
    followPointer(scene, readout);
  } else {
    stage.append(
      element(
        'p',
        { class: 'no-webgl', role: 'alert' },
        'This browser draws nothing in three dimensions (WebGL 2 is missing or switched off). ' +
          'The time line, the numbers and the curves work all the same.',
      ),
    );
  }

  const refresh = (): void => {
    state.look(player.time);
    scene?.show();
    readout.update();
  };
  player.onChange(refresh);
  onTheme((dark) => {
    overlay.replaceChildren(...(machine.cables.length > 0 ? [legend(machine.tension_max, dark)] : []));
    scene?.setDark(dark);
    plots.restyle();
  });

  const keys: KeyAction[] = [
    { keys: [' '], meaning: 'space: play or pause', run: () => player.toggle() },
    { keys: ['ArrowLeft'], meaning: '← →: one frame; ten with shift', run: (e) => timeline.step(e.shiftKey ? -10 : -1) },
    { keys: ['ArrowRight'], meaning: '', run: (e) => timeline.step(e.shiftKey ? 10 : 1) },
    { keys: ['Home'], meaning: 'Home, End: to the start, to the end', run: () => timeline.jump(0) },
    { keys: ['End'], meaning: '', run: () => timeline.jump(frames.count - 1) },
    { keys: ['+', '='], meaning: '+ −: faster, slower', run: () => player.changeSpeed(1) },
    { keys: ['-', '_'], meaning: '', run: () => player.changeSpeed(-1) },
    { keys: ['l', 'L'], meaning: 'L: again and again', run: () => player.setLoop(!player.loop) },
    { keys: ['f', 'F'], meaning: 'F: the whole machine', run: () => scene?.fit() },
    { keys: ['1'], meaning: '1 2 3: from the front, from the side, from above', run: () => scene?.look('front') },
    { keys: ['2'], meaning: '', run: () => scene?.look('side') },
    { keys: ['3'], meaning: '', run: () => scene?.look('top') },
    { keys: ['t', 'T'], meaning: 'T: dark or light', run: toggleTheme },
    { keys: ['p', 'P'], meaning: 'P: save the picture', run: () => void savePicture() },
    { keys: ['c'], meaning: 'C: save the curves as CSV; all quantities with shift', run: () => saveTable(plots.names) },
    { keys: ['C'], meaning: '', run: () => saveTable([]) },
    { keys: ['Escape'], meaning: 'Esc: let go of what was tapped', run: () => readout.tap(null) },
    { keys: ['?'], meaning: '?: this list', run: () => help.showModal() },
    ...(options.keys ?? []),
  ];
  listenToKeys(keys);
  help.append(
    element('h2', {}, 'Keys'),
    element('ul', {}, ...keys.filter((k) => k.meaning).map((k) => element('li', {}, k.meaning))),
    element('p', {}, 'Drag turns the picture, two fingers or the right button move it, the wheel zooms. ' +
      'Tap a span, a body or a joint to keep its numbers and to see them as curves.'),
    button('Close', 'close', () => help.close()),
  );

  let scheduled = 0;
  const tick = (now: number): void => {
    player.tick(now);
    scheduled = requestAnimationFrame(tick);
  };
  scheduled = requestAnimationFrame(tick);
  const skipPause = (): void => player.skipPause();
  document.addEventListener('visibilitychange', skipPause);
  startTheme();
  if (frames.count > 0) {
    player.setRange(frames.time(0), frames.time(frames.count - 1));
    plots.choose(firstChoice(frames));
  }
  return {
    frames, player, state, timeline, plots, readout, scene, extras, refresh,
    dispose: () => {
      cancelAnimationFrame(scheduled);
      document.removeEventListener('visibilitychange', skipPause);
      scene?.dispose();
      host.replaceChildren();
    },
  };
}

/** The verdict of the run's certificate, if the machine has run already. */
function verdictOf(machine: Machine): HTMLElement[] {
  if (!machine.verdict) return [];
  const { clean, text } = machine.verdict;
  return [element('span', { class: clean ? 'verdict' : 'verdict doubtful', title: text }, text)];
}

function followPointer(scene: Scene3D, readout: Readout): void {
  let pressed: { x: number; y: number } | null = null;
  const reach = (event: PointerEvent): number => (event.pointerType === 'mouse' ? mouseReach : touchReach);
  scene.canvas.addEventListener('pointerdown', (event) => {
    pressed = { x: event.clientX, y: event.clientY };
  });
  scene.canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0) return;
    readout.hover(scene.pick(event.clientX, event.clientY, reach(event)));
    scene.highlight(readout.picked);
  });
  scene.canvas.addEventListener('pointerleave', () => {
    readout.hover(null);
    scene.highlight(readout.picked);
  });
  scene.canvas.addEventListener('pointerup', (event) => {
    const moved = pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
    pressed = null;
    if (moved === null || moved > tapMoves) return;
    readout.tap(scene.pick(event.clientX, event.clientY, reach(event)));
    scene.highlight(readout.picked);
  });
}
