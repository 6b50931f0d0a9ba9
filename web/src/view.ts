// The page of `sheave view`: a recording inside the file.

import { tautestTime } from './chooser';
import { button, element } from './dom';
import { buildPage } from './page';
import { fromBase64, inflate, requireChecksum, unpack } from './recording';

function recordingText(): string {
  const holder = document.getElementById('recording');
  if (!holder?.textContent) throw new Error('the file has no recording');
  requireChecksum(holder.textContent, holder.dataset.checksum);
  return holder.textContent;
}

async function start(): Promise<void> {
  const host = document.getElementById('page')!;
  try {
    const frames = unpack(await inflate(fromBase64(recordingText())));
    const page = buildPage(host, frames);
    if (frames.count > 0) page.player.showStill(tautestTime(frames));
    performance.mark('sheave-first-picture');
    document.title = `${frames.machine.name} – Sheave`;
    const last = page.frames.events.at(-1);
    if (last?.kind === 'diverged') showFault(host, last.text);
    Object.assign(window, { sheave: page });
  } catch (error) {
    host.replaceChildren(
      element('p', { class: 'fault', role: 'alert' }, `This recording cannot be shown: ${String(error)}`),
    );
    throw error;
  }
}

/** A run that stopped early says so over everything. */
function showFault(host: HTMLElement, text: string): void {
  const note = element('p', { class: 'fault', role: 'alert' }, text);
  note.append(button('×', 'close', () => note.remove()));
  host.append(note);
}

void start();
