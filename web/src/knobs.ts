// The settings that can be changed while the machine runs, and their effect on the numbers.

import { button, element } from './dom';
import type { Certificate, Control, Settings } from './engine';
import { numberText } from './numbers';

export interface KnobsHost {
  set(control: string, value: number): void;
  change(settings: Partial<Settings>): void;
  compare(on: boolean): void;
  goBack(seconds: number): void;
  share(): void;
}

function choice<T extends string>(
  label: string,
  values: readonly T[],
  now: T,
  chosen: (value: T) => void,
): HTMLElement {
  const select = element('select', { 'aria-label': label, onchange: () => chosen(select.value as T) });
  for (const value of values) select.append(element('option', { value }, value));
  select.value = now;
  return element('label', { class: 'knob' }, element('span', {}, label), select);
}

interface SliderOptions {
  label: string;
  unit: string;
  value: number;
  minimum: number;
  maximum: number;
  /** Powers of 2 and integers only. */
  powers?: boolean;
  chosen(value: number): void;
}

function slider(options: SliderOptions): HTMLElement {
  const { minimum, maximum, powers } = options;
  const output = element('output', {});
  const input = element('input', {
    type: 'range',
    'aria-label': options.label,
    min: String(powers ? Math.log2(minimum) : minimum),
    max: String(powers ? Math.log2(maximum) : maximum),
    step: powers ? '0.5' : String((maximum - minimum) / 200),
    oninput: () => {
      const value = powers ? Math.round(2 ** Number(input.value)) : Number(input.value);
      show(value);
      options.chosen(value);
    },
  });
  const show = (value: number): void => {
    output.textContent = `${numberText(value, 3)} ${options.unit}`;
  };
  input.value = String(powers ? Math.log2(options.value) : options.value);
  show(options.value);
  return element('label', { class: 'knob' }, element('span', {}, options.label), input, output);
}

export class Knobs {
  readonly element: HTMLElement;
  private readonly certificate = element('p', { class: 'certificate', role: 'status' });
  private readonly cost = element('td', {});
  private readonly error = element('td', {});
  private readonly pull = element('td', {});
  private readonly compared: HTMLInputElement;

  constructor(host: KnobsHost, controls: readonly Control[], settings: Settings) {
    this.compared = element('input', { type: 'checkbox', onchange: () => host.compare(this.compared.checked) });
    const strength = Math.hypot(...settings.gravity);
    const gravity = settings.gravity;
    this.element = element(
      'div',
      { class: 'knobs' },
      element(
        'div',
        { class: 'row' },
        button('↶ 2 s', 'go back two seconds (B)', () => host.goBack(2)),
        button('↺ Again', 'from the start (0)', () => host.goBack(Infinity)),
        button('Link', 'copy a link to this scene with these settings', () => host.share()),
      ),
      this.certificate,
      element(
        'table',
        { class: 'trade' },
        element('tr', {}, element('th', {}, 'time per step'), this.cost),
        element(
          'tr',
          {},
          element('th', {}, element('label', {}, this.compared, ' error against a fine reference')),
          this.error,
        ),
        element('tr', {}, element('th', {}, 'pull of the pointer'), this.pull),
      ),
      ...controls.map((control) =>
        slider({
          ...control,
          label: control.name,
          chosen: (value) => host.set(control.name, value),
        }),
      ),
      choice('solver', ['direct', 'gauss-seidel'], settings.solver, (solver) => host.change({ solver })),
      choice('integrator', ['rattle', 'xpbd'], settings.integrator, (integrator) => host.change({ integrator })),
      slider({
        label: 'substeps', unit: '', value: settings.substeps, minimum: 1, maximum: 128, powers: true,
        chosen: (substeps) => host.change({ substeps }),
      }),
      slider({
        label: 'iterations', unit: '', value: settings.iterations, minimum: 1, maximum: 1024, powers: true,
        chosen: (iterations) => host.change({ iterations }),
      }),
      ...(strength > 0
        ? [
            slider({
              label: 'gravity', unit: 'm/s²', value: strength, minimum: 0, maximum: 2 * strength,
              chosen: (g) =>
                host.change({ gravity: [0, 1, 2].map((k) => (gravity[k] * g) / strength) as Settings['gravity'] }),
            }),
          ]
        : []),
    );
  }

  get comparing(): boolean {
    return this.compared.checked;
  }
  showCertificate(found: Certificate): void {
    const { clean, relative, sentence } = found;
    this.certificate.className = clean ? 'certificate clean' : 'certificate doubtful';
    this.certificate.textContent = clean
      ? `✓ certificate clean: its numbers agree to ${numberText(relative, 2)}`
      : `✗ doubtful: ${sentence}`;
  }
  /** `cost` [ms per step], `pull` [N], `error` relative (NaN: unknown). */
  showNumbers(cost: number, pull: number, error: number): void {
    this.cost.textContent = `${numberText(cost, 3)} ms`;
    this.pull.textContent = `${numberText(pull, 3)} N`;
    this.error.textContent = Number.isFinite(error) ? `${numberText(100 * error, 3)} % of its size` : '–';
  }
  stopComparing(): void {
    this.compared.checked = false;
  }
}
