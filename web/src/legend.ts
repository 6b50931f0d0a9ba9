// The colour scale of tensions, equal for the whole run.

import { sample, slackColor, toCss } from './color_map';
import { element } from './dom';
import { numberText } from './numbers';

export function legend(tensionMax: number, dark: boolean): HTMLElement {
  const stops = Array.from({ length: 17 }, (_, k) => toCss(sample(k / 16, dark)));
  return element(
    'figure',
    { class: 'legend', 'aria-label': `colours: tension from 0 to ${numberText(tensionMax)} N` },
    element('figcaption', {}, 'tension [N]'),
    element('div', { class: 'bar', style: `background: linear-gradient(to right, ${stops.join()})` }),
    element(
      'div',
      { class: 'ticks' },
      ...[0, 0.5, 1].map((share) => element('span', {}, numberText(share * tensionMax, 4))),
    ),
    element(
      'div',
      { class: 'slack' },
      element('i', { style: `background: ${toCss(slackColor)}` }),
      'slack',
    ),
  );
}
