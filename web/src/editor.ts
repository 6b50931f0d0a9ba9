// The scene's text. Faults that the loader finds are underlined.

import { button, element } from './dom';
import type { Fault } from './engine';

/** The underlined ranges of the text: from a fault's column to the end of the word or line. */
export function underlined(text: string, faults: readonly Fault[]): [number, number][] {
  const starts = [0];
  for (let k = 0; k < text.length; ++k) if (text[k] === '\n') starts.push(k + 1);
  const places: [number, number][] = [];
  for (const fault of faults) {
    if (fault.line < 1 || fault.line > starts.length) continue;
    const begin = starts[fault.line - 1];
    const end = fault.line < starts.length ? starts[fault.line] - 1 : text.length;
    // Columns count characters, and some characters have two UTF-16 units in a string.
    const before = [...text.slice(begin, end)].slice(0, Math.max(fault.column - 1, 0)).join('').length;
    const from = Math.min(begin + before, end);
    const word = /^("([^"\\]|\\.)*"|[\w.+-]+|.)/.exec(text.slice(from, end));
    const to = Math.max(from + (word ? word[0].length : 0), Math.min(from + 1, text.length));
    places.push([from, to]);
  }
  return places.sort((a, b) => a[0] - b[0]);
}

export class Editor {
  readonly element = element('details', { class: 'editor' });
  private readonly area = element('textarea', {
    spellcheck: 'false',
    'aria-label': 'the scene in JSON',
    wrap: 'off',
  });
  private readonly marks = element('pre', { class: 'marks', 'aria-hidden': 'true' });
  private readonly list = element('ol', { class: 'faults', 'aria-live': 'polite' });
  private faults: readonly Fault[] = [];
  private waiting = 0;

  /** `changed` is called when the text has not changed for a moment. */
  constructor(private readonly changed: (text: string) => void) {
    const sheet = element('div', { class: 'sheet' }, this.marks, this.area);
    this.element.append(element('summary', {}, 'Scene'), sheet, this.list);
    this.area.addEventListener('input', () => {
      this.show(this.faults);
      clearTimeout(this.waiting);
      this.waiting = window.setTimeout(() => this.changed(this.area.value), 350);
    });
    this.area.addEventListener('scroll', () => this.follow());
  }

  get text(): string {
    return this.area.value;
  }
  set text(text: string) {
    this.area.value = text;
    this.show([]);
  }

  show(faults: readonly Fault[]): void {
    this.faults = faults;
    const text = this.area.value;
    const pieces: (Node | string)[] = [];
    let at = 0;
    for (const [from, to] of underlined(text, faults)) {
      if (from < at) continue;
      pieces.push(text.slice(at, from), element('u', {}, text.slice(from, to)));
      at = to;
    }
    // One line more than the text has, so that both elements scroll equally.
    this.marks.replaceChildren(...pieces, text.slice(at), '\n ');
    this.list.replaceChildren(
      ...faults.map((fault) => {
        const place = fault.line > 0 ? `${fault.line}:${fault.column} ` : '';
        const words = [place + (fault.pointer ? `${fault.pointer}: ` : '') + fault.message];
        return element('li', {}, button(words.join(' '), 'go there', () => this.goTo(fault)));
      }),
    );
    if (faults.length > 0) this.element.open = true;
    this.follow();
  }

  private goTo(fault: Fault): void {
    const place = underlined(this.area.value, [fault])[0];
    if (!place) return;
    this.area.focus();
    this.area.setSelectionRange(place[0], place[1]);
    const line = parseFloat(getComputedStyle(this.area).lineHeight) || 18;
    this.area.scrollTop = Math.max(0, (fault.line - 4) * line);
  }
  private follow(): void {
    this.marks.scrollTop = this.area.scrollTop;
    this.marks.scrollLeft = this.area.scrollLeft;
  }
}
