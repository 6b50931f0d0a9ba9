// Files that the user can save from the page.

import type { Annotations } from './annotations';
import { sample, slackColor, toCss } from './color_map';
import type { Frames } from './frames';
import { legendTexts } from './legend';
import { timeText } from './numbers';

/** Comma-separated values in the format of `sheave run --out`; all columns if `names` is empty. */
export function csv(frames: Frames, names: readonly string[]): string {
  const wanted =
    names.length > 0 ? [...names] : frames.channels.filter((c) => !c.hidden).map((c) => c.name);
  const columns = [
    frames.allTimes(),
    ...wanted.filter((name) => name !== 't').map((name) => frames.series(frames.channel(name))),
  ];
  const lines = [['t', ...wanted.filter((name) => name !== 't')].join(',')];
  for (let k = 0; k < frames.count; ++k) {
    // An unknown value is empty.
    lines.push(columns.map((c) => (Number.isNaN(c[k]) ? '' : String(c[k]))).join(','));
  }
  return lines.join('\n') + '\n';
}

/** The picture with the machine's name, the time and the colour scale. */
export async function annotated(
  picture: Blob,
  frames: Frames,
  time: number,
  dark: boolean,
  pixelRatio: number,
  annotations: Annotations,
): Promise<Blob> {
  const bitmap = await createImageBitmap(picture);
  const canvas = document.createElement('canvas');
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  const context = canvas.getContext('2d');
  if (!context) throw new Error('no picture');
  context.drawImage(bitmap, 0, 0);
  context.scale(pixelRatio, pixelRatio);
  const width = canvas.width / pixelRatio;
  const height = canvas.height / pixelRatio;
  const { machine } = frames;
  context.fillStyle = dark ? '#e8ecf1' : '#1b2430';
  context.font = '600 16px system-ui, sans-serif';
  context.fillText(annotations.heading || machine.name, 16, 28);
  context.font = '14px system-ui, sans-serif';
  context.fillText(`${timeText(time, machine.dt)} s`, 16, 50);
  annotations.draw(context, dark ? '#e8ecf1' : '#1b2430');
  if (machine.cables.length > 0) {
    const left = width - 196;
    const top = height - 44;
    context.font = '12px system-ui, sans-serif';
    const { heading, ticks } = legendTexts(machine.tension_max);
    context.fillText(heading, left, top - 6);
    for (let k = 0; k < 180; ++k) {
      context.fillStyle = toCss(sample(k / 179, dark));
      context.fillRect(left + k, top, 1.5, 10);
    }
    context.fillStyle = dark ? '#e8ecf1' : '#1b2430';
    ticks.forEach((text, k) => {
      const share = k / (ticks.length - 1);
      context.fillText(text, left + 180 * share - share * context.measureText(text).width, top + 24);
    });
    context.fillText('slack', left + 130, top - 6);
    context.fillStyle = toCss(slackColor);
    context.fillRect(left + 112, top - 15, 14, 10);
  }
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no picture'))), 'image/png');
  });
}
