// Keyboard control of the page.

export interface KeyAction {
  keys: string[];
  meaning: string;
  run(event: KeyboardEvent): void;
}

/** Whether the element uses the keys itself. */
function isTyping(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement) return target.type !== 'checkbox';
  return target instanceof HTMLSelectElement;
}

export function listenToKeys(actions: readonly KeyAction[]): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    // A dialog handles its own keys.
    if (document.querySelector('dialog[open]')) return;
    // The space bar presses a focused button, as usual.
    const focused = event.target instanceof HTMLButtonElement || event.target instanceof HTMLInputElement;
    if (focused && (event.key === ' ' || event.key === 'Enter')) return;
    const action = actions.find((a) => a.keys.includes(event.key));
    if (!action) return;
    event.preventDefault();
    action.run(event);
  });
}
