// Starts the program `odkit`, for tests of the page with a bus of its own.
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

const PROGRAM = process.env.ODKIT ?? fileURLToPath(new URL('../../target/debug/odkit', import.meta.url));

/** Starts it; `found` is the match of the pattern in its output. Ends with `stop`. */
export async function odkit(args, pattern) {
  const child = spawn(PROGRAM, args, { stdio: ['pipe', 'pipe', 'pipe'] });
  let said = '';
  const ended = new Promise((resolve) => child.once('exit', resolve));
  const found = await new Promise((resolve, reject) => {
    const hear = (line) => {
      said += `${line}\n`;
      const match = pattern.exec(line);
      if (match) resolve(match[1]);
    };
    createInterface(child.stdout).on('line', hear);
    createInterface(child.stderr).on('line', hear);
    child.once('error', reject);
    void ended.then(() => reject(new Error(`odkit ${args.join(' ')} ended:\n${said}`)));
  });
  return {
    found,
    stop: async () => {
      child.kill('SIGKILL');
      await ended;
    },
  };
}

/** `odkit sim` with a WebSocket; `found` is the address. Port 0: any that is free. */
export const simulated = (devices, port = 0, more = '') =>
  odkit(['sim', ...devices, '--link', `ws:127.0.0.1:${port}${more}`], /pages on (ws:\S+)/);

/** `odkit sim` as an adapter that speaks slcan; `found` is its terminal. */
export const adapted = (devices) => odkit(['sim', ...devices, '--link', 'slcan:pty'], /slcan on (\/\S+)/);
