// The page of the playground, and of `sheave view --live`: a running scene and its text.

import createEngine from 'sheave-engine';

import { element } from './dom';
import { Editor } from './editor';
import { Engine } from './engine';
import { readLink, writeLink } from './link';
import { Live } from './live';
import { fromBase64, inflate } from './recording';

/** The scene inside the file, if there is one. */
function ownScene(): string | null {
  return document.getElementById('scene')?.textContent?.trim() || null;
}

async function fetchScene(name: string): Promise<string> {
  const answer = await fetch(`scenes/${name}.json`);
  if (!answer.ok) throw new Error(`there is no scene "${name}" here (${answer.status})`);
  return answer.text();
}

async function start(): Promise<void> {
  const host = document.getElementById('page')!;
  try {
    const packed = document.getElementById('engine')?.textContent;
    if (!packed) throw new Error('the file has no engine');
    const engine = await Engine.load(createEngine, await inflate(fromBase64(packed)));
    const link = await readLink(location.hash);
    let name = link.scene;
    const own = ownScene();
    const text = link.text ?? (own === null ? null : (JSON.parse(own) as string));
    const scene = text ?? (await fetchScene((name ??= 'paper/pulley')));
    if (text !== null) name = undefined;

    const share = async (): Promise<void> => {
      // A link refers to an unchanged scene of the repository by name, and contains any other by
      // its text.
      const content = name !== undefined && editor.text === scene ? { scene: name } : { text: editor.text };
      const hash = await writeLink({ ...content, settings: live.changed });
      history.replaceState(null, '', hash);
      await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    };
    const editor = new Editor((edited) => {
      const playing = live.page.player.playing;
      const faults = live.open(edited, live.changed);
      editor.show(faults);
      if (faults.length === 0 && playing) live.page.player.play();
    });
    const live = new Live({
      host,
      engine,
      share: () => void share(),
      built: (page) => {
        page.extras.append(editor.element);
        document.title = `${page.frames.machine.name} – Sheave`;
        Object.assign(window, { sheave: { live, page, editor } });
      },
    });
    editor.text = scene;
    const faults = live.open(scene, link.settings);
    if (faults.length > 0) {
      host.replaceChildren(element('p', { class: 'fault', role: 'alert' }, 'This scene has faults.'), editor.element);
      editor.show(faults);
      return;
    }
    live.page.player.play();
  } catch (error) {
    host.replaceChildren(
      element('p', { class: 'fault', role: 'alert' }, `This machine cannot be shown: ${String(error)}`),
    );
    throw error;
  }
}

void start();
