// Three browser engines with the same two functions: go to an address, and evaluate an expression in the page.
// Chromium by Playwright; Firefox by WebDriver BiDi; WebKit by WebDriver.
import { spawn } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import WebSocket from 'ws';
import { launch } from './harness.mjs';

/** Milliseconds for the start of an engine. */
const PATIENCE = 60_000;

/** Starts a program and returns the match in its output; `stop` ends it with its children. */
async function started(command, args, pattern, env = {}) {
  const child = spawn(command, args, { detached: true, stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, ...env } });
  const stop = () => {
    try {
      process.kill(-child.pid);
    } catch {
      // It ended before.
    }
  };
  let said = '';
  const match = await new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`${command} does not start: ${said}`)), PATIENCE);
    const hear = (text) => {
      said += text;
      const found = pattern.exec(said);
      if (!found) return;
      clearTimeout(timer);
      resolve(found);
    };
    child.stdout.setEncoding('utf8').on('data', hear);
    child.stderr.setEncoding('utf8').on('data', hear);
    child.once('error', reject);
    child.once('exit', () => reject(new Error(`${command} ended: ${said}`)));
  }).catch((error) => {
    stop();
    throw error;
  });
  return { match, stop };
}

async function chromium() {
  const browser = await launch();
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  return {
    goto: async (url) => {
      await page.goto('about:blank');
      await page.goto(url);
    },
    evaluate: async (expression) => JSON.parse(await page.evaluate(`(async () => JSON.stringify((await (${expression})) ?? null))()`)),
    close: () => browser.close(),
  };
}

async function firefox() {
  const profile = await mkdtemp(join(tmpdir(), 'odkit-firefox-'));
  const args = ['--headless', '--no-remote', '--width', '1280', '--height', '800', '--profile', profile, '--remote-debugging-port', '0'];
  const { match, stop } = await started('firefox-esr', args, /WebDriver BiDi listening on (ws:\S+)/);
  const socket = new WebSocket(`${match[1]}/session`);
  await new Promise((resolve, reject) => socket.once('open', resolve).once('error', reject));
  const waiting = new Map();
  socket.on('message', (text) => {
    const { id, result, message } = JSON.parse(text);
    const [resolve, reject] = waiting.get(id) ?? [];
    waiting.delete(id);
    if (message) reject?.(new Error(message));
    else resolve?.(result);
  });
  let count = 0;
  const send = (method, params) => new Promise((resolve, reject) => {
    waiting.set(++count, [resolve, reject]);
    socket.send(JSON.stringify({ id: count, method, params }));
  });
  await send('session.new', { capabilities: {} });
  const { contexts: [{ context }] } = await send('browsingContext.getTree', {});
  const goto = (url) => send('browsingContext.navigate', { context, url, wait: 'complete' });
  return {
    goto: async (url) => {
      await goto('about:blank');
      await goto(url);
    },
    evaluate: async (expression) => {
      const said = await send('script.evaluate', { expression: `(async () => JSON.stringify((await (${expression})) ?? null))()`, target: { context }, awaitPromise: true });
      if (said.type === 'exception') throw new Error(said.exceptionDetails.text);
      return JSON.parse(said.result.value);
    },
    close: async () => {
      socket.close();
      stop();
      await rm(profile, { recursive: true, force: true, maxRetries: 5 });
    },
  };
}

async function webkit() {
  const port = 20_000 + Math.floor(Math.random() * 20_000);
  const home = await mkdtemp(join(tmpdir(), 'odkit-webkit-'));
  const { stop } = await started('xvfb-run', ['-a', 'sh', '-c', `echo begun; exec WebKitWebDriver --port=${port}`], /begun/, { HOME: home, WEBKIT_FORCE_SANDBOX: '0', WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: '1' });
  const call = async (method, path, body) => {
    const answer = await fetch(`http://127.0.0.1:${port}${path}`, { method, body: body && JSON.stringify(body) });
    const { value } = await answer.json();
    if (value?.error) throw new Error(`${value.error}: ${value.message}`);
    return value;
  };
  const until = Date.now() + PATIENCE;
  while (!(await call('GET', '/status').catch(() => null))) {
    if (Date.now() > until) throw new Error('WebKitWebDriver does not answer');
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  const { sessionId } = await call('POST', '/session', { capabilities: { alwaysMatch: { browserName: 'MiniBrowser', 'webkitgtk:browserOptions': { args: ['--automation'] } } } });
  const path = `/session/${sessionId}`;
  await call('POST', `${path}/window/rect`, { width: 1280, height: 900 }).catch(() => {});
  const goto = (url) => call('POST', `${path}/url`, { url });
  return {
    goto: async (url) => {
      await goto('about:blank');
      await goto(url);
    },
    evaluate: async (expression) =>
      JSON.parse(await call('POST', `${path}/execute/async`, { script: `const done = arguments[0]; (async () => JSON.stringify((await (${expression})) ?? null))().then(done, (error) => done(JSON.stringify({ thrown: String(error) })));`, args: [] })),
    close: async () => {
      await call('DELETE', path).catch(() => {});
      stop();
      await rm(home, { recursive: true, force: true, maxRetries: 5 });
    },
  };
}

export const ENGINES = { chromium, firefox, webkit };
