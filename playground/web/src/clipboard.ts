// Copies text. A page from a computer of the network (http://192.168…) has no `navigator.clipboard`.

/** Copies a text; false if the browser does not allow it. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyOld(text);
  }
}

/** Copies a selection, which needs no secure context. A field outside of an open dialog cannot be selected. */
function copyOld(text: string): boolean {
  const before = document.activeElement;
  const home = [...document.querySelectorAll('dialog[open]')].at(-1) ?? document.body;
  const field = home.appendChild(document.createElement('textarea'));
  field.value = text;
  field.className = 'sr';
  field.select();
  const isCopied = document.execCommand('copy');
  field.remove();
  if (before instanceof HTMLElement) before.focus();
  return isCopied;
}
