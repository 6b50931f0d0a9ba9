// node build_playground.mjs ENGINE: builds the playground, a static site in dist/playground, and the
// page of `sheave view --live` (dist/live.html). ENGINE is the folder with sheave_engine.cjs.

import {
  copyFileSync,
  existsSync,
  mkdirSync,
  readFileSync,
  readdirSync,
  rmSync,
  writeFileSync,
} from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateSync } from 'node:zlib';

import { page } from './build.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const source = join(here, 'src');
const target = join(here, 'dist');

/** The engine's code, compressed, as text. */
function packedEngine(engine) {
  const bytes = readFileSync(join(engine, 'sheave_engine.wasm'));
  return deflateSync(bytes, { level: 9 }).toString('base64');
}

/** Licences of the other parts of the engine's code: header libraries, and emscripten's runtime. */
function engineLicences() {
  const packages = ['libeigen3-dev', 'nlohmann-json3-dev', 'libfmt-dev', 'emscripten'];
  const texts = packages.map((name) => {
    const path = `/usr/share/doc/${name}/copyright`;
    if (!existsSync(path)) throw new Error(`${path}, the licence of ${name}, is missing`);
    return `${name}\n\n${readFileSync(path, 'utf8')}`;
  });
  return `<!--\nThe engine contains:\n\n${texts.join('\n----\n\n').replaceAll('--', '—')}\n-->\n`;
}

/** A text of a scene, read without a JSON parser because scenes have comments. */
function told(text, key) {
  const found = new RegExp(`^  "${key}": ("(?:[^"\\\\]|\\\\.)*")`, 'm').exec(text);
  return found ? JSON.parse(found[1]) : '';
}

const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');

async function buildPlayground(engine) {
  const site = join(target, 'playground');
  const repository = join(here, '..');
  rmSync(site, { recursive: true, force: true });
  mkdirSync(join(site, 'pictures'), { recursive: true });
  const empty = await page('play.html', 'play.ts', {
    // emscripten's code imports these modules in Node only, never in a browser.
    external: ['fs', 'path', 'crypto', 'url'],
    alias: { 'sheave-engine': join(engine, 'sheave_engine.cjs') },
  });
  const live = empty.replace('/*ENGINE*/', () => packedEngine(engine)) + engineLicences();
  writeFileSync(join(site, 'play.html'), live);
  writeFileSync(join(target, 'live.html'), live);
  let cards = '';
  for (const folder of ['paper', 'machines', 'analytic', 'stress']) {
    cards += `<h2>${folder}</h2><ul class="scenes">`;
    mkdirSync(join(site, 'scenes', folder), { recursive: true });
    for (const file of readdirSync(join(repository, 'scenes', folder)).sort()) {
      if (!file.endsWith('.json')) continue;
      const text = readFileSync(join(repository, 'scenes', folder, file), 'utf8');
      writeFileSync(join(site, 'scenes', folder, file), text);
      const name = file.replace(/\.json$/, '');
      const picture = `${folder}-${name.replaceAll('_', '-')}.webp`;
      const drawn = join(repository, 'scenes/pictures', picture);
      if (existsSync(drawn)) copyFileSync(drawn, join(site, 'pictures', picture));
      const image = existsSync(drawn) ? `<img loading="lazy" src="pictures/${picture}" alt="" />` : '';
      const title = escaped(told(text, 'name') || name);
      cards +=
        `<li><a href="play.html#scene=${folder}/${name}">${image}<strong>${title}</strong></a>` +
        `<p>${escaped(told(text, 'description'))}</p></li>`;
    }
    cards += '</ul>';
  }
  const html = readFileSync(join(source, 'start.html'), 'utf8')
    .replace('/*STYLE*/', () => readFileSync(join(source, 'start.css'), 'utf8'))
    .replace('<!--SCENES-->', () => cards);
  writeFileSync(join(site, 'index.html'), html);
}

await buildPlayground(resolve(process.argv[2]));
