// The Content-Security-Policy of the page, for the header of `serve.mjs` and for the page itself:
// its own files, WebAssembly, and styles in attributes (meters, fading bytes). HTML and script
// addresses pass through Trusted Types.
import { createHash } from 'node:crypto';

/** The policies of lit and DOMPurify, and that of the page for its workers (`src/trusted.ts`). */
const TYPES = 'lit-html dompurify odkit';

/** A bus that odkit serves on this computer. A policy cannot name [::1]; localhost also reaches it. */
const BUS = 'ws://127.0.0.1:* ws://localhost:*';

/** `scripts`: hashes of the scripts inside an HTML file, from `inline`; `connect`: origins of lessons. */
export const policy = (scripts, connect = "'self'") =>
  `default-src 'none'; script-src 'self' 'wasm-unsafe-eval'${scripts}; style-src 'self'; style-src-attr 'unsafe-inline'; ` +
  `img-src 'self'; connect-src ${connect} ${BUS}; ` + "worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; " +
  `require-trusted-types-for 'script'; trusted-types ${TYPES}`;

/** The hashes of the scripts inside an HTML file, in the form of a policy. */
export const inline = (html) =>
  [...html.toString().matchAll(/<script>(.*?)<\/script>/gs)]
    .map(([, text]) => ` 'sha256-${createHash('sha256').update(text).digest('base64')}'`)
    .join('');
