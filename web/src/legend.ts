// The colour scale of tensions, equal for the whole run.

import { sample, slackColor, toCss } from './color_map';
import { element } from './dom';
import { numberText, quantityText } from './numbers';
import { unitScale } from './units';

/** The heading of the colour scale, and the numbers at its start, middle and end. */
export function legendTexts(tensionMax: number): { heading: string; ticks: string[] } {
  const { factor, prefix } = unitScale(tensionMax, 'N');
  return {
    heading: `tension [${prefix}N]`,
    ticks: [0, 0.5, 1].map((share) => numberText((share * tensionMax) / factor, 4)),
  };
}

export function legend(tensionMax: number, dark: boolean): HTMLElement {
  const { heading, ticks } = legendTexts(tensionMax);
  const stops = Array.from({ length: 17 }, (_, k) => toCss(sample(k / 16, dark)));
  return element(
    'figure',
    { class: 'legend', 'aria-label': `colours: tension from 0 to ${quantityText(tensionMax, 'N')}` },
    element('figcaption', {}, heading),
    element('div', { class: 'bar', style: `background: linear-gradient(to right, ${stops.join()})` }),
    element(
      'div',
      { class: 'ticks' },
      ...ticks.map((tick) => element('span', {}, tick)),
    ),
    element(
      'div',
      { class: 'slack' },
      element('i', { style: `background: ${toCss(slackColor)}` }),
      'slack',
    ),
  );
}
