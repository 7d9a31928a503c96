// Script addresses: Trusted Types accept only those that are listed here.

const NAMES: ReadonlySet<string> = new Set(['worker.js', 'editor.js', 'sw.js']);

/** The address of one of the page's own scripts. */
function own(name: string): string {
  if (!NAMES.has(name)) throw new TypeError(`${name} is not a script of this page`);
  return new URL(name, import.meta.url).href;
}

interface Policy {
  createScriptURL(name: string): string;
}

/** Older browsers have no Trusted Types. */
const { trustedTypes } = globalThis as { trustedTypes?: { createPolicy(name: string, rules: Policy): Policy } };
const policy = trustedTypes?.createPolicy('odkit', { createScriptURL: own });

/** The address of a worker, as browsers with Trusted Types require it. */
export const trusted = (name: 'worker.js' | 'editor.js' | 'sw.js'): string => (policy ? policy.createScriptURL(name) : own(name));
