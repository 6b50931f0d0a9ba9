// Everything by keys.

export interface KeyAction {
  keys: string[];
  meaning: string;
  run(event: KeyboardEvent): void;
}

/** Elements that want the keys for themselves. */
function isTyping(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement) return target.type !== 'checkbox';
  return target instanceof HTMLSelectElement;
}

export function listenToKeys(actions: readonly KeyAction[]): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    // A dialog has keys of its own.
    if (document.querySelector('dialog[open]')) return;
    // A button that has the focus is pressed by the space bar as everywhere.
    const focused = event.target instanceof HTMLButtonElement || event.target instanceof HTMLInputElement;
    if (focused && (event.key === ' ' || event.key === 'Enter')) return;
    const action = actions.find((a) => a.keys.includes(event.key));
    if (!action) return;
    event.preventDefault();
    action.run(event);
  });
}
