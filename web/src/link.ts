// Links that contain a scene and its settings in the part of an address behind "#".

import type { Settings } from './engine';
import { fromBase64, inflate } from './recording';

export interface LinkContent {
  /** Path of a scene of the repository, without the file extension: "paper/pulley". */
  scene?: string;
  /** Text of a scene that is not in the repository. */
  text?: string;
  settings: Partial<Settings>;
}

async function deflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as Uint8Array<ArrayBuffer>])
    .stream()
    .pipeThrough(new CompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function writeLink(content: LinkContent): Promise<string> {
  const parts = new URLSearchParams();
  if (content.scene !== undefined) parts.set('scene', content.scene);
  if (content.text !== undefined) {
    const packed = await deflate(new TextEncoder().encode(content.text));
    let binary = '';
    for (const byte of packed) binary += String.fromCharCode(byte);
    parts.set('text', btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', ''));
  }
  for (const [key, value] of Object.entries(content.settings)) {
    parts.set(key, Array.isArray(value) ? value.join(',') : String(value));
  }
  return `#${parts.toString()}`;
}

/** Ignores parts that it does not understand, because people write links, too. */
export async function readLink(hash: string): Promise<LinkContent> {
  const parts = new URLSearchParams(hash.replace(/^#/, ''));
  const content: LinkContent = { settings: {} };
  const scene = parts.get('scene');
  if (scene && /^[\w-]+(\/[\w-]+)*$/.test(scene)) content.scene = scene;
  const text = parts.get('text');
  if (text) {
    const bytes = await inflate(fromBase64(text.replaceAll('-', '+').replaceAll('_', '/')));
    content.text = new TextDecoder().decode(bytes);
  }
  const solver = parts.get('solver');
  if (solver === 'direct' || solver === 'gauss-seidel') content.settings.solver = solver;
  const integrator = parts.get('integrator');
  if (integrator === 'xpbd' || integrator === 'rattle') content.settings.integrator = integrator;
  for (const key of ['substeps', 'iterations'] as const) {
    const value = Number(parts.get(key));
    if (Number.isInteger(value) && value >= 1) content.settings[key] = value;
  }
  const gravity = (parts.get('gravity') ?? '').split(',').map(Number);
  if (gravity.length === 3 && gravity.every(Number.isFinite)) {
    content.settings.gravity = [gravity[0], gravity[1], gravity[2]];
  }
  return content;
}
