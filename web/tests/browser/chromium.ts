// Pages in a real browser, without a network, with WebGL drawn in software.

import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import type { Browser, Page } from 'puppeteer-core';
import puppeteer from 'puppeteer-core';

const executablePath = process.env['CHROMIUM'] ?? '/usr/bin/chromium';

export const drawing = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
export const notDrawing = ['--disable-gpu', '--disable-3d-apis'];

export interface Chromium {
  browser: Browser;
  close(): Promise<void>;
}

export async function startChromium(options: string[] = drawing): Promise<Chromium> {
  const profile = mkdtempSync(join(tmpdir(), 'sheave-chromium-'));
  const browser = await puppeteer.launch({
    executablePath,
    userDataDir: profile,
    args: ['--no-sandbox', '--disable-dev-shm-usage', '--no-first-run', ...options],
    // What is measured must not wait for windows nobody sees.
    defaultViewport: { width: 1200, height: 750 },
  });
  return {
    browser,
    close: async () => {
      await browser.close();
      rmSync(profile, { recursive: true, force: true });
    },
  };
}

/** A page and all that went wrong on it. */
export interface OpenedPage {
  page: Page;
  faults: string[];
}

/** Opens a file; everything that is no file:, data: or blob: is a fault and is not loaded. */
export async function open({ browser }: Chromium, path: string): Promise<OpenedPage> {
  const page = await browser.newPage();
  const faults: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warn') {
      // What the software renderer says of its own speed is not the page's fault.
      if (!/GPU stall due to ReadPixels/.test(message.text())) faults.push(message.text());
    }
  });
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.setRequestInterception(true);
  page.on('request', (request) => {
    if (/^(file|data|blob):/.test(request.url())) {
      void request.continue();
    } else {
      faults.push(`asked for ${request.url()}`);
      void request.abort();
    }
  });
  await page.goto(`file://${path}`);
  await page.waitForFunction('window.sheave !== undefined', { timeout: 120_000, polling: 100 });
  return { page, faults };
}
