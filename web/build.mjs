// Builds the page of `sheave view` (dist/view.html), or the tests of the given folders.
//
// The page is one file: esbuild bundles three.js, uPlot and this project's code. The licences of
// the contents are at the end of the file.

import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const source = join(here, 'src');
const target = join(here, 'dist');

/** The packages that the page contains, with their licences. */
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

/** `more`: further options for esbuild. */
export async function bundle(entry, more = {}) {
  const result = await build({
    entryPoints: [join(source, entry)],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none',
    write: false,
    ...more,
  });
  return result.outputFiles[0].text;
}

/** Text inside a script element must not end the element. */
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

/**
 * Fills a template. The replacements are functions, because "$" has a meaning in a replacement
 * text.
 */
export async function page(template, entry, more) {
  const script = inScript(await bundle(entry, more));
  const css = await style();
  const html = readFileSync(join(source, template), 'utf8')
    .replace('/*STYLE*/', () => css)
    .replace('/*SCRIPT*/', () => script);
  return `${html}<!--\nThis page contains:\n\n${licences().replaceAll('--', '—')}\n-->\n`;
}

async function buildView() {
  mkdirSync(target, { recursive: true });
  writeFileSync(join(target, 'view.html'), await page('view.html', 'view.ts'));
}

/** Builds the tests of one folder; each is bundled with its imports. */
async function buildTests(folder) {
  const tests = readdirSync(join(here, folder)).filter((name) => name.endsWith('.test.ts'));
  await build({
    entryPoints: tests.map((name) => join(here, folder, name)),
    bundle: true,
    platform: 'node',
    format: 'esm',
    outExtension: { '.js': '.mjs' },
    outdir: join(target, folder),
    external: ['puppeteer-core', 'gltf-validator'],
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const folders = process.argv.slice(2);
  if (folders.length === 0) await buildView();
  for (const folder of folders) await buildTests(folder);
}
