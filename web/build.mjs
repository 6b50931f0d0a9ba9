// Builds the page of `sheave view` (dist/view.html), or the tests (--tests, into dist/tests), or the
// playground (--playground ENGINE: the folder with sheave_engine.cjs, into dist/playground) and the
// page of `sheave view --live` (dist/live.html).
//
// The page is one file: esbuild puts three.js, uPlot and our own code into it. The licences of what
// it contains stand at its end.

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

import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const source = join(here, 'src');
const target = join(here, 'dist');

/** The packages that end up in the page, with their licences. */
const contained = ['three', 'uplot'];

export function licences() {
  return contained
    .map((name) => {
      const folder = join(here, 'node_modules', name);
      const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
      return `${name} ${version}\n\n${readFileSync(join(folder, 'LICENSE'), 'utf8')}`;
    })
    .join('\n----\n\n');
}

export async function bundle(entry, engine) {
  const result = await build({
    entryPoints: [join(source, entry)],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none',
    write: false,
    // What emscripten's code asks Node for, and never in a browser.
    external: ['fs', 'path', 'crypto', 'url'],
    alias: engine ? { 'sheave-engine': join(engine, 'sheave_engine.cjs') } : {},
  });
  return result.outputFiles[0].text;
}

/** What stands in a script must not end it. */
export const inScript = (text) => text.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');

export async function style() {
  const ours = readFileSync(join(source, 'style.css'), 'utf8');
  const plots = readFileSync(join(here, 'node_modules/uplot/dist/uPlot.min.css'), 'utf8');
  const result = await build({
    stdin: { contents: plots + ours, loader: 'css' },
    minify: true,
    write: false,
  });
  return result.outputFiles[0].text;
}

/** Fills a template; as functions, because replacements have signs of their own. */
export async function page(template, entry, engine) {
  const script = inScript(await bundle(entry, engine));
  const css = await style();
  const html = readFileSync(join(source, template), 'utf8')
    .replace('/*STYLE*/', () => css)
    .replace('/*SCRIPT*/', () => script)
    .replace('/*ENGINE*/', () => packedEngine(engine));
  return `${html}<!--\nThis page contains:\n\n${licences().replaceAll('--', '—')}\n-->\n`;
}

async function buildView() {
  mkdirSync(target, { recursive: true });
  writeFileSync(join(target, 'view.html'), await page('view.html', 'view.ts'));
}

/** The engine's code, deflated, as text. */
function packedEngine(engine) {
  const bytes = readFileSync(join(engine, 'sheave_engine.wasm'));
  return deflateSync(bytes, { level: 9 }).toString('base64');
}

/** The first sentences of a scene, without loading it: a scene is JSON with comments. */
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
  const live = await page('play.html', 'play.ts', engine);
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

async function buildTests() {
  const tests = readdirSync(join(here, 'tests')).filter((name) => name.endsWith('.test.ts'));
  await build({
    entryPoints: tests.map((name) => join(here, 'tests', name)),
    bundle: true,
    platform: 'node',
    format: 'esm',
    outExtension: { '.js': '.mjs' },
    outdir: join(target, 'tests'),
    external: ['puppeteer-core', 'gltf-validator'],
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const engine = process.argv.indexOf('--playground');
  if (engine > 0) await buildPlayground(resolve(process.argv[engine + 1]));
  else await (process.argv.includes('--tests') ? buildTests() : buildView());
}
